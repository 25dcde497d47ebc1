// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/features.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "core/rounding.h"
#include "scene/alpha.h"
#include "scene/glass.h"
#include "scene/layers.h"
#include "scene/light_kinds.h"
#include "scene/texture_slots.h"
#include "shared/layout.h"

namespace promin {
namespace {

using namespace layout;

/// The name of the feature of each bit that a scene may use; empty for all other bits.
constexpr auto kSceneFeatures = [] {
  std::array<std::string_view, 32 * FEATURE_WORDS> names{};
#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) names[BIT] = NAME;
#include "promin/kinds/primitives.def"
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) names[BIT] = NAME;
#include "promin/kinds/lights.def"
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) names[BIT] = NAME;
#include "promin/kinds/materials.def"
#define PROMIN_FEATURE(FEATURE, BIT, NAME) names[BIT] = NAME;
#define PROMIN_REQUEST(FEATURE, BIT, NAME)
#include "shared/features.def"
  return names;
}();

/// Returns whether every row of the tables has its own bit. The bit of the debug view is an exception.
constexpr bool are_bits_distinct() {
  std::array<int, 32 * FEATURE_WORDS> uses{};
#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) ++uses[BIT];
#include "promin/kinds/primitives.def"
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) ++uses[BIT];
#include "promin/kinds/lights.def"
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) ++uses[BIT];
#include "promin/kinds/materials.def"
#define PROMIN_FEATURE(FEATURE, BIT, NAME) ++uses[BIT];
#define PROMIN_REQUEST(FEATURE, BIT, NAME) ++uses[BIT];
#include "shared/features.def"
  for (uint bit = 0; bit < 7; ++bit) uses[32 + DEBUG_VIEW_SHIFT + bit] += 1;
  return std::ranges::all_of(uses, [](int count) { return count <= 1; });
}
static_assert(are_bits_distinct(), "two rows of the tables, or a row and the debug view, have the same feature bit");

/// Returns whether the numbers of kinds increase in the table: leaves are sorted by kind and traversed in the order of
/// the table.
constexpr bool do_kinds_ascend() {
  uint next = 0;
  bool result = true;
#define PROMIN_TREE_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  result = result && (NUMBER) >= next;                                        \
  next = (NUMBER) + 1;
#include "promin/kinds/primitives.def"
  return result;
}
static_assert(do_kinds_ascend());

struct ShapeFeatures {
  FeatureMask operator()(const world::NotDrawn&) const { return {}; }
  FeatureMask operator()(const Mesh& mesh) const {
    FeatureMask features;
    if (mesh.triangles.empty()) return features;
    features |= FEATURE_TRIANGLES;
    if (!mesh.normals.empty()) features |= FEATURE_SMOOTH_NORMALS;
    if (!mesh.colors.empty()) features |= FEATURE_VERTEX_COLORS;
    return features;
  }
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  FeatureMask operator()(const world::TYPE& shape) const {           \
    return FeatureMask(FEATURE_##FEATURE) | open_features(shape);    \
  }
#include "promin/kinds/primitives.def"

  template <class Shape>
  static FeatureMask open_features(const Shape& shape) {
    if constexpr (requires { shape.is_open; }) {
      if (shape.is_open) return FEATURE_OPEN_SHAPES;
    }
    return {};
  }
};

/// Returns the features of a material, depending on its model and its values.
struct MaterialFeatures {
  FeatureMask operator()(const Phong& phong) const {
    FeatureMask features = FEATURE_PHONG;
    if (phong.shininess > 0.0F && max_component(phong.specular) > 0.0F) features |= FEATURE_SPECULAR;
    if (max_component(phong.reflection) > 0.0F) features |= FEATURE_MIRRORS;
    if (hangs_on_angle(phong)) features |= FEATURE_FRESNEL;
    return features;
  }
  FeatureMask operator()(const MetallicRoughness& material) const {
    FeatureMask features = FEATURE_METALLIC_ROUGHNESS;
    // A texture can only make the material smoother, so the factor decides whether a mirror is possible.
    if (material.roughness < ROUGHEST_MIRROR || material.metallic_roughness_texture.exists()) {
      features |= FEATURE_MIRRORS;
    }
    if (has_sheen(material)) features |= FEATURE_SHEENS;
    if (scatters_through(material)) features |= FEATURE_DIFFUSE_TRANSMISSION;
    if (is_iridescent(material)) features |= FEATURE_IRIDESCENCE;
    // The computation of tangents needs texture coordinates.
    if (is_anisotropic(material)) features |= FEATURE_ANISOTROPY | FEATURE_TEXTURES;
    if (has_specular_textures(material)) features |= FEATURE_SPECULAR_TEXTURES;
    if (!has_coat(material)) return features;
    features |= FEATURE_COATS;
    if (material.clearcoat_roughness < ROUGHEST_MIRROR || material.clearcoat_roughness_texture.exists()) {
      features |= FEATURE_MIRRORS;
    }
    return features;
  }
  FeatureMask operator()(const Unlit& unlit) const {
    FeatureMask features = FEATURE_UNLIT;
    if (unlit.catches_shadows) features |= FEATURE_SHADOW_CATCHERS;
    return features;
  }
};

FeatureMask feature_of(LightKind kind) {
  switch (kind) {
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  case LightKind::ENUMERATOR:                                              \
    return FEATURE_##FEATURE;
#include "promin/kinds/lights.def"
  }
  return {};
}

}  // namespace

FeatureMask geometry_features(const world::Scene& scene) {
  FeatureMask features;
  for (const world::Object& object : scene.objects) features |= std::visit(ShapeFeatures(), object.shape);
  for (const Mesh& mesh : scene.meshes) features |= ShapeFeatures()(mesh);
  if (!scene.instances.empty()) features |= FEATURE_INSTANCES;
  return features;
}

FeatureMask material_features(std::span<const Material> materials, const std::vector<bool>& is_shown) {
  FeatureMask features;
  for (size_t i = 0; i < materials.size(); ++i) {
    if (!is_shown[i]) continue;
    features |= std::visit(MaterialFeatures(), materials[i].model);
    for_each_slot(materials[i], [&](const TextureSlot& slot, const char* /*name*/, ImageUse /*use*/) {
      if (slot.exists()) features |= FEATURE_TEXTURES;
    });
    if (has_holes(materials[i])) features |= FEATURE_HOLES;
    if (blends(materials[i])) features |= FEATURE_BLENDING;
    // Glass reflects like a mirror on total reflection.
    if (is_clear(materials[i])) features |= FEATURE_GLASS | FEATURE_MIRRORS;
    if (parts_colors(materials[i])) features |= FEATURE_DISPERSION;
    if (!shows_backs(materials[i])) features |= FEATURE_ONE_SIDED;
  }
  return features;
}

FeatureMask light_features(std::span<const Light> lights) {
  FeatureMask features;
  for (const Light& light : lights) {
    if (!light.is_on) continue;
    features |= feature_of(light.kind);
    if (falls_off(light)) features |= FEATURE_FALLOFF;
    if (has_size(light)) features |= FEATURE_SAMPLED_LIGHT;
  }
  return features;
}

FeatureMask environment_features(const Environment& environment) {
  FeatureMask features;
  if (environment.shows_backdrop()) features |= FEATURE_BACKDROP;
  if (!environment.has_sky()) return features;
  features |= FEATURE_SKY;
  if (environment.shows_sky) features |= FEATURE_SHOWN_SKY;
  return features;
}

FeatureMask primitive_features() {
  FeatureMask features;
#define PROMIN_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) features |= FEATURE_##FEATURE;
#include "promin/kinds/primitives.def"
  return features | FEATURE_OPEN_SHAPES | FEATURE_INSTANCES;
}

std::vector<bool> find_shown_materials(const world::Scene& scene) {
  std::vector<bool> is_shown(scene.materials.size(), false);
  for (const world::Object& object : scene.objects) {
    if (world::primitive_count(object.shape) == 0) continue;
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr || mesh->triangle_materials.empty()) {
      is_shown[object.material] = true;
    } else {
      for (const uint32_t material : mesh->triangle_materials) is_shown[material] = true;
    }
  }
  for (const world::Instance& instance : scene.instances) {
    if (scene.meshes[instance.mesh].triangle_materials.empty())
      is_shown[scene.objects[instance.object].material] = true;
  }
  for (const Mesh& mesh : scene.meshes) {
    for (const uint32_t material : mesh.triangle_materials) is_shown[material] = true;
  }
  return is_shown;
}

bool casts_shadows(FeatureMask geometry, uint64_t primitive_count) {
  // A single flat primitive casts no shadow. A solid casts shadows on its own inside.
  FeatureMask solids;
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) solids |= FEATURE_##FEATURE;
#include "promin/kinds/primitives.def"
  return primitive_count > 1 || geometry.has_any(solids);
}

FeatureMask picture_features(FeatureMask geometry, FeatureMask materials, FeatureMask lights, FeatureMask environment,
                             uint64_t primitive_count) {
  FeatureMask features = geometry | materials | lights | environment;
  if (lights.is_empty()) return features.without(FEATURE_SPECULAR);
  if (casts_shadows(geometry, primitive_count)) features |= FEATURE_SHADOWS;
  return features;
}

FeatureMask features_of(const world::Scene& scene) {
  uint64_t primitives = 0;
  for (const world::Object& object : scene.objects) primitives += world::primitive_count(object.shape);
  for (const world::Instance& instance : scene.instances) primitives += scene.meshes[instance.mesh].triangles.size();
  return picture_features(geometry_features(scene), material_features(scene.materials, find_shown_materials(scene)),
                          light_features(scene.lights), environment_features(scene.environment), primitives);
}

FeatureMask features_of(DebugView view) {
  FeatureMask features = FeatureMask::of_debug_view(static_cast<uint32_t>(view));
  // The request NONE of debug_views.def.
  const FeatureMask FEATURE_NONE;
  switch (view) {
    case DebugView::kNone:
      break;
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) \
  case DebugView::ENUMERATOR:                                                    \
    features |= FEATURE_##REQUEST;                                               \
    break;
#include "promin/kinds/debug_views.def"
  }
  return features;
}

bool shows_unlit(FeatureMask features, DebugView view) {
  return view == DebugView::kNone && features.has_any(FEATURE_UNLIT | FEATURE_BACKDROP);
}

FeatureMask all_features() {
  FeatureMask features = primitive_features();
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) features |= FEATURE_##FEATURE;
#include "promin/kinds/lights.def"
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) features |= FEATURE_##FEATURE;
#include "promin/kinds/materials.def"
#define PROMIN_FEATURE(FEATURE, BIT, NAME) features |= FEATURE_##FEATURE;
#define PROMIN_REQUEST(FEATURE, BIT, NAME)
#include "shared/features.def"
  return features.without(FEATURE_INSTANCES);
}

std::vector<std::string> feature_names(FeatureMask features) {
  std::vector<std::string> names;
  for (uint bit = 0; bit < kSceneFeatures.size(); ++bit) {
    if (!kSceneFeatures[bit].empty() && features.has_any(Feature{bit})) names.emplace_back(kSceneFeatures[bit]);
  }
  return names;
}

}  // namespace promin
