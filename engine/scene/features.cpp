// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/features.h"

#include <array>
#include <string_view>

#include "layout.h"

namespace promin {
namespace {

using namespace layout;

struct NamedFeature {
  FeatureMask bit;
  std::string_view name;
};

constexpr std::array kFeatures{
    NamedFeature{FEATURE_TRIANGLES, "triangles"},
    NamedFeature{FEATURE_SPHERES, "spheres"},
    NamedFeature{FEATURE_CYLINDERS, "cylinders"},
    NamedFeature{FEATURE_CONES, "cones"},
    NamedFeature{FEATURE_PLANES, "planes"},
    NamedFeature{FEATURE_POINT_LIGHTS, "point lights"},
    NamedFeature{FEATURE_DIRECTIONAL_LIGHTS, "directional lights"},
    NamedFeature{FEATURE_SPOT_LIGHTS, "spot lights"},
    NamedFeature{FEATURE_FALLOFF, "distance falloff"},
    NamedFeature{FEATURE_SHADOWS, "shadows"},
    NamedFeature{FEATURE_SPECULAR, "specular highlights"},
    NamedFeature{FEATURE_MIRRORS, "mirrors"},
    NamedFeature{FEATURE_SMOOTH_NORMALS, "smooth normals"},
    NamedFeature{FEATURE_VERTEX_COLORS, "vertex colours"},
    NamedFeature{FEATURE_HEADLIGHT, "headlight"},
};
static_assert(kFeatures.size() == FEATURE_COUNT);

struct ShapeFeatures {
  FeatureMask operator()(const NotDrawn&) const { return 0; }
  FeatureMask operator()(const Mesh& mesh) const {
    if (mesh.triangles.empty()) return 0;
    return FEATURE_TRIANGLES | (mesh.normals.empty() ? 0 : FEATURE_SMOOTH_NORMALS) |
           (mesh.colors.empty() ? 0 : FEATURE_VERTEX_COLORS);
  }
  FeatureMask operator()(const Sphere&) const { return FEATURE_SPHERES; }
  FeatureMask operator()(const Plane&) const { return FEATURE_PLANES; }
  FeatureMask operator()(const Cylinder&) const { return FEATURE_CYLINDERS; }
  FeatureMask operator()(const Cone&) const { return FEATURE_CONES; }
};

FeatureMask features_of(const Material& material) {
  const bool has_highlight = material.shininess > 0.0F && max_component(material.specular) > 0.0F;
  return (has_highlight ? FEATURE_SPECULAR : 0) | (max_component(material.reflection) > 0.0F ? FEATURE_MIRRORS : 0);
}

FeatureMask features_of(const Light& light) {
  const FeatureMask falloff = light.attenuation == Attenuation::kInverseSquare ? FEATURE_FALLOFF : 0;
  switch (light.kind) {
    case LightKind::kDirectional:
      return FEATURE_DIRECTIONAL_LIGHTS;
    case LightKind::kSpot:
      return FEATURE_SPOT_LIGHTS | falloff;
    case LightKind::kPoint:
      return FEATURE_POINT_LIGHTS | falloff;
    case LightKind::kHeadlight:
      return FEATURE_HEADLIGHT;
  }
  return 0;
}

}  // namespace

FeatureMask features_of(const Scene& scene) {
  FeatureMask features = 0;
  uint64_t primitives = 0;
  std::vector<bool> is_used(scene.materials.size(), false);
  for (const Object& object : scene.objects) {
    features |= std::visit(ShapeFeatures(), object.shape);
    const uint32_t count = primitive_count(object.shape);
    primitives += count;
    if (count == 0) continue;
    const Mesh* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr || mesh->triangle_materials.empty()) {
      is_used[object.material] = true;
    } else {
      for (const uint32_t material : mesh->triangle_materials) is_used[material] = true;
    }
  }
  for (size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i]) features |= features_of(scene.materials[i]);
  }
  for (const Light& light : scene.lights) features |= features_of(light);
  if (scene.lights.empty()) features &= ~FEATURE_SPECULAR;
  // A flat primitive alone shadows nothing; a solid shadows its own inside.
  const bool is_flat = (features & (FEATURE_SPHERES | FEATURE_CYLINDERS | FEATURE_CONES)) == 0;
  if (!(primitives <= 1 && is_flat) && !scene.lights.empty()) features |= FEATURE_SHADOWS;
  return features;
}

FeatureMask all_features() {
  return (1U << FEATURE_COUNT) - 1U;
}

std::vector<std::string> feature_names(FeatureMask features) {
  std::vector<std::string> names;
  for (const NamedFeature& feature : kFeatures) {
    if ((features & feature.bit) != 0) names.emplace_back(feature.name);
  }
  return names;
}

}  // namespace promin
