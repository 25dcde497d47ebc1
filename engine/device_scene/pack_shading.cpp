// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_shading.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <utility>

#include "promin/error.h"
#include "scene/alpha.h"
#include "scene/glass.h"
#include "scene/layers.h"
#include "scene/light_kinds.h"
#include "scene/texture_slots.h"

namespace promin {
namespace {

using namespace layout;

uint flag(bool is_set, uint bit) {
  return is_set ? bit : 0;
}

uint flags_of(const TextureSlot& slot, const Texture& texture, const PlacedImage& image) {
  return slot.uv_set * TEXTURE_UV_SET | flag(image.has_colors[0], TEXTURE_IS_SRGB) |
         flag(image.has_colors[1], TEXTURE_SECOND_IS_SRGB) |
         static_cast<uint>(std::countr_zero(image.stride)) << TEXTURE_STRIDE_SHIFT |
         flag(texture.is_magnified_linearly, TEXTURE_MAGNIFIED_LINEARLY) |
         flag(texture.is_minified_linearly, TEXTURE_MINIFIED_LINEARLY) | flag(texture.has_levels, TEXTURE_HAS_LEVELS) |
         flag(texture.are_levels_linear, TEXTURE_LEVELS_LINEAR) |
         static_cast<uint>(texture.wrap_u) << TEXTURE_WRAP_U_SHIFT |
         static_cast<uint>(texture.wrap_v) << TEXTURE_WRAP_V_SHIFT;
}
static_assert(static_cast<uint>(TextureWrap::kRepeat) == WRAP_REPEAT &&
              static_cast<uint>(TextureWrap::kMirroredRepeat) == WRAP_MIRRORED &&
              static_cast<uint>(TextureWrap::kClampToEdge) == WRAP_CLAMP);

bool catches_shadows(const Material& material) {
  const auto* unlit = std::get_if<Unlit>(&material.model);
  return unlit != nullptr && unlit->catches_shadows;
}

constexpr float kLeastAlpha = std::numeric_limits<float>::min();

/// Packs a model's numbers into the members that the model's shader file reads.
class MaterialPacker {
 public:
  MaterialPacker(const TextureTables& tables, std::span<const Material> materials)
      : tables_(tables), is_of_phong_(has_phong_alone(materials)) {}

  void add(const Material& material) {
    first_slot_ = packed_.slots.size();
    MaterialRecord record = std::visit([&](const auto& model) { return pack(model); }, material.model);
    record.cover = pack_cover(material);
    record.emissive = vec4(material.emissive, std::bit_cast<float>(pack_flags(material)));
    packed_.records.push_back(record);
  }
  PackedMaterials take() { return std::move(packed_); }

 private:
  struct ModelNumber {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  uint operator()(const TYPE&) const {                                  \
    return MATERIAL_##KIND;                                             \
  }
#include "promin/kinds/materials.def"
  };

  uint pack_flags(const Material& material) {
    const uint glass =
        std::visit([&](const auto& model) { return add_glass(model, is_clear(material)); }, material.model);
    return glass << MATERIAL_GLASS_SHIFT | std::visit(ModelNumber(), material.model) |
           flag(has_holes(material), MATERIAL_HAS_HOLES) | flag(blends(material), MATERIAL_BLENDS) |
           flag(!shows_backs(material), MATERIAL_IS_ONE_SIDED) |
           flag(catches_shadows(material), MATERIAL_CATCHES_SHADOWS);
  }

  vec4 pack_cover(const Material& material) {
    // A material that blends with an alpha of 0 is invisible.
    const float least = material.alpha_mode == AlphaMode::kMask ? material.alpha_cutoff : kLeastAlpha;
    return {is_absent(material) ? 0.0F : material.alpha, least, add(base_slot(material)),
            add(material.emissive_texture)};
  }

  MaterialRecord pack(const Phong& m) {
    return {vec4(m.ambient, 0.0F),
            vec4(m.diffuse, add(m.normal_texture)),
            vec4(m.specular, m.shininess),
            vec4(m.reflection, add(m.specular_texture)),
            {},
            {}};
  }
  MaterialRecord pack(const MetallicRoughness& m) {
    const dvec3 at_normal = glm::min(reflectance_of(m), dvec3(1.0)) * static_cast<double>(m.specular);
    return {vec4(m.base_color, m.metallic),
            vec4(vec3(at_normal), m.specular),
            vec4(m.roughness, m.normal_scale, m.occlusion_strength, 0.0F),
            vec4(add_extension(m), add(m.metallic_roughness_texture), add(m.normal_texture), add(m.occlusion_texture)),
            {},
            {}};
  }
  MaterialRecord pack(const Unlit& m) {
    if (!m.catches_shadows) return {vec4(m.color, 0.0F), {}, {}, {}, {}, {}};
    // The factors of a light's power and of the environment's radiance, with and without 1 / pi.
    const dvec3 inverse = 1.0 / glm::max(dvec3(m.color), dvec3(std::numeric_limits<float>::min()));
    const dvec3 of_sky = inverse / std::numbers::pi;
    return {vec4(vec3(of_sky), 0.0F), vec4(vec3(is_of_phong_ ? inverse : of_sky), 0.0F), {}, {}, {}, {}};
  }

  /// Returns the reflectance of the dielectric at normal incidence, before it is multiplied by the strength of the
  /// reflection.
  static dvec3 reflectance_of(const MetallicRoughness& m) {
    // KHR_materials_ior: an index of 0 stands for a dielectric that reflects all light.
    const double slope = (static_cast<double>(m.ior) - 1.0) / (static_cast<double>(m.ior) + 1.0);
    return slope * slope * dvec3(m.specular_color);
  }

  /// Adds a record of rare properties. Returns the bits of its number; 0 if the material has no such properties.
  float add_extension(const MetallicRoughness& m) {
    if (!is_extended(m)) return 0.0F;
    const float thickness = m.iridescence_thickness_maximum;
    packed_.extensions.push_back(
        {.coat = vec4(m.clearcoat, m.clearcoat_roughness, m.clearcoat_normal_scale, 0.0F),
         .coat_slots = uvec4(number_of(m.clearcoat_texture), number_of(m.clearcoat_roughness_texture),
                             number_of(m.clearcoat_normal_texture), 0),
         .sheen = vec4(m.sheen_color, m.sheen_roughness),
         .reflectance = vec4(vec3(reflectance_of(m)), m.specular),
         .slots = uvec4(number_of(m.sheen_color_texture), number_of(m.sheen_roughness_texture),
                        number_of(m.specular_texture), number_of(m.specular_color_texture)),
         .scattering = vec4(m.diffuse_transmission_color, m.diffuse_transmission),
         .thin_film = vec4(m.iridescence, m.iridescence_ior, thickness, thickness - m.iridescence_thickness_minimum),
         .anisotropy = vec4(m.anisotropy, std::cos(m.anisotropy_rotation), std::sin(m.anisotropy_rotation), 0.0F),
         .rare_slots = uvec4(number_of(m.diffuse_transmission_texture), number_of(m.diffuse_transmission_color_texture),
                             number_of(m.iridescence_texture), number_of(m.iridescence_thickness_texture)),
         .anisotropy_slot = uvec4(number_of(m.anisotropy_texture), 0, 0, 0)});
    return std::bit_cast<float>(static_cast<uint>(packed_.extensions.size()));
  }

  /// Returns the number of a glass. Materials with the same glass share its number, and their solids count as one.
  uint number_of_glass(const GlassRecord& record) {
    const auto is_same = [&](const GlassRecord& other) { return std::memcmp(&other, &record, sizeof(record)) == 0; };
    const auto found = std::ranges::find_if(packed_.glasses, is_same);
    const auto number = static_cast<uint>(found - packed_.glasses.begin()) + 1;
    if (found != packed_.glasses.end()) return number;
    if (number > MOST_GLASSES) {
      throw RunError({"scene.glasses.many",
                      "the materials have more than " + std::to_string(MOST_GLASSES) + " kinds of glass", "",
                      "use fewer"});
    }
    packed_.glasses.push_back(record);
    return number;
  }
  /// Adds the glass of a material. Returns its number; 0 if the material is no glass.
  uint add_glass(const Phong& m, bool is_clear) {
    if (!is_clear && !hangs_on_angle(m)) return 0;
    return number_of_glass(
        {vec4(m.transmission, m.ior), vec4(0.0F), vec4(0.0F),
         uvec4(flag(is_clear, GLASS_IS_CLEAR) | flag(hangs_on_angle(m), GLASS_IS_FRESNEL), 0, 0, 0)});
  }
  uint add_glass(const MetallicRoughness& m, bool is_clear) {
    if (!is_clear) return 0;
    dvec3 absorption(0.0);
    for (int i = 0; i < 3; ++i) {
      // A medium that absorbs all light is stored as one that transmits a little over 2^-24 of the light.
      const double left = std::max(static_cast<double>(m.attenuation_color[i]), 0x1p-24);
      absorption[i] = std::max(0.0, -std::log2(left)) / static_cast<double>(m.attenuation_distance);
    }
    const vec3 reflectance = vec3(dvec3(m.specular_color) * static_cast<double>(m.specular));
    return number_of_glass(
        {vec4(vec3(m.transmission), m.ior), vec4(vec3(absorption), 0.0F), vec4(reflectance, index_spread(m)),
         uvec4(GLASS_IS_CLEAR | flag(m.thickness == 0.0F, GLASS_IS_THIN), number_of(m.transmission_texture), 0, 0)});
  }
  static uint add_glass(const Unlit& /*m*/, bool /*is_clear*/) {
    return 0;
  }

  float add(const TextureSlot& slot) {
    return std::bit_cast<float>(number_of(slot));
  }

  /// Returns the slot's number, from 1 on, with the image's place in its bundle above it; 0 if there is no texture or
  /// no image. Equal slots of a material share a number, so the shader reads the texture once; the slots of occlusion,
  /// roughness and metal are often equal. Slots of a bundle share a record.
  uint number_of(const TextureSlot& slot) {
    if (!slot.exists() || slot.texture >= tables_.textures.size()) return 0;
    const Texture& texture = tables_.textures[slot.texture];
    const PlacedImage& image = tables_.images[texture.image];
    if (image.levels == 0) return 0;
    const TextureSlotRecord record{vec4(slot.to_u, std::bit_cast<float>(flags_of(slot, texture, image))),
                                   vec4(slot.to_v, 0.0F), uvec4(image.first, image.size, image.levels)};
    const auto is_same = [&](const TextureSlotRecord& other) {
      return std::memcmp(&other, &record, sizeof(record)) == 0;
    };
    const auto found =
        std::find_if(packed_.slots.begin() + static_cast<ptrdiff_t>(first_slot_), packed_.slots.end(), is_same);
    const auto number = static_cast<uint>(found - packed_.slots.begin()) + 1;
    if (found == packed_.slots.end()) packed_.slots.push_back(record);
    return number | image.place << TEXTURE_PLACE_SHIFT;
  }

  const TextureTables& tables_;
  bool is_of_phong_;
  PackedMaterials packed_;
  size_t first_slot_ = 0;  // The first slot of the current material.
};

/// The smallest difference of the cosines of a spot light's angles at which fp32 can distinguish points between them.
constexpr double kLeastFalloffWidth = 1e-5;

/// Returns the size of a light for LightRecord::kind. The squared sine of a small angle is not 0.
float size_of(const Light& light) {
  if (!has_size(light)) return 0.0F;
  if (has_place(light.kind)) return light.radius;
  const double sine = std::sin(0.5 * static_cast<double>(light.angle));
  return std::max(static_cast<float>(sine * sine), std::numeric_limits<float>::min());
}

/// Returns the record of a flat light. Its free numbers hold the sides and the direction of the width.
LightRecord pack_flat(const Light& light) {
  const uint32_t of_right = std::bit_cast<uint32_t>(light.right.z);
  return {vec4(light.position, 0.5F * light.size.y), vec4(light.direction, 0.5F * light.size.x),
          vec4(light.diffuse, light.right.x), vec4(light.specular, light.right.y), uvec4(light.kind, 0, of_right, 0)};
}

LightRecord pack(const Light& light) {
  if (is_flat(light.kind)) return pack_flat(light);
  const double cos_outer = std::cos(static_cast<double>(light.outer_cone_angle));
  const double cos_inner = std::cos(static_cast<double>(light.inner_cone_angle));
  return {vec4(light.position, 1.0F / light.range), vec4(light.direction, static_cast<float>(cos_outer)),
          vec4(light.diffuse, static_cast<float>(1.0 / std::max(kLeastFalloffWidth, cos_inner - cos_outer))),
          vec4(light.specular, 0.0F),
          uvec4(light.kind, light.attenuation == Attenuation::kInverseSquare ? 1 : 0,
                std::bit_cast<uint32_t>(size_of(light)), 0)};
}

}  // namespace

bool has_phong_alone(std::span<const Material> materials) {
  const auto has = [&]<typename Model>(const Model& /*any*/) {
    return std::ranges::any_of(materials, [](const Material& m) { return std::holds_alternative<Model>(m.model); });
  };
  return has(Phong()) && !has(MetallicRoughness());
}

PackedMaterials pack_materials(std::span<const Material> materials, const TextureTables& tables) {
  MaterialPacker packer(tables, materials);
  for (const Material& material : materials) packer.add(material);
  return packer.take();
}

PackedLights pack_lights(std::span<const Light> lights) {
  PackedLights packed;
  for (uint32_t i = 0; i < lights.size(); ++i) {
    if (!lights[i].is_on) continue;
    packed.records.push_back(pack(lights[i]));
    packed.numbers.push_back(i);
  }
  packed.light_count = static_cast<uint32_t>(packed.records.size());
  return packed;
}

}  // namespace promin
