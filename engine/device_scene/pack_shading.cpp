// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_shading.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace promin {
namespace {

using namespace layout;

/// The numbers of a model, in the places that its shader file gives them.
struct ModelRecord {
  MaterialRecord operator()(const Phong& m) const {
    return {vec4(m.ambient, 0.0F), vec4(m.diffuse, 0.0F), vec4(m.specular, m.shininess), vec4(m.reflection, 0.0F), {}};
  }
  MaterialRecord operator()(const MetallicRoughness& m) const {
    // KHR_materials_ior: 0 stands for a dielectric that reflects all.
    const double slope = (static_cast<double>(m.ior) - 1.0) / (static_cast<double>(m.ior) + 1.0);
    const dvec3 at_normal = glm::min(slope * slope * dvec3(m.specular_color), dvec3(1.0)) * static_cast<double>(m.specular);
    return {vec4(m.base_color, m.metallic), vec4(vec3(at_normal), m.specular), vec4(m.roughness, 0.0F, 0.0F, 0.0F), {}, {}};
  }
  MaterialRecord operator()(const Unlit& m) const { return {vec4(m.color, 0.0F), {}, {}, {}, {}}; }
};

struct ModelNumber {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  uint operator()(const TYPE&) const {                                  \
    return MATERIAL_##KIND;                                             \
  }
#include "promin/kinds/materials.def"
};

MaterialRecord pack(const Material& m) {
  MaterialRecord record = std::visit(ModelRecord(), m.model);
  record.emissive = vec4(m.emissive, std::bit_cast<float>(std::visit(ModelNumber(), m.model)));
  return record;
}

/// The least difference of the cosines of a spot's angles for which fp32 still tells points between them apart.
constexpr double kLeastFalloffWidth = 1e-5;

LightRecord pack(const Light& light) {
  const double cos_outer = std::cos(static_cast<double>(light.outer_cone_angle));
  const double cos_inner = std::cos(static_cast<double>(light.inner_cone_angle));
  return {vec4(light.position, 1.0F / light.range), vec4(light.direction, static_cast<float>(cos_outer)),
          vec4(light.diffuse, static_cast<float>(1.0 / std::max(kLeastFalloffWidth, cos_inner - cos_outer))),
          vec4(light.specular, 0.0F),
          uvec4(light.kind, light.attenuation == Attenuation::kInverseSquare ? 1 : 0, 0, 0)};
}

}  // namespace

std::vector<MaterialRecord> pack_materials(std::span<const Material> materials) {
  std::vector<MaterialRecord> records;
  for (const Material& material : materials) records.push_back(pack(material));
  return records;
}

PackedLights pack_lights(std::span<const Light> lights) {
  PackedLights packed;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].is_on) continue;
    packed.records.push_back(pack(lights[i]));
    packed.numbers.push_back(i);
  }
  return packed;
}

}  // namespace promin
