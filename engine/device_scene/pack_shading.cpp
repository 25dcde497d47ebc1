// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_shading.h"

#include <algorithm>
#include <cmath>

namespace promin {
namespace {

using namespace layout;

MaterialRecord pack(const Material& m) {
  return {vec4(m.ambient, 0.0F), vec4(m.diffuse, 0.0F), vec4(m.specular, m.shininess), vec4(m.reflection, 0.0F),
          vec4(m.emissive, 0.0F)};
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
