// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "promin/camera.h"
#include "promin/display.h"
#include "promin/environment.h"
#include "promin/image.h"
#include "promin/lights.h"
#include "promin/materials.h"
#include "promin/scene.h"
#include "promin/shapes.h"
#include "promin/textures.h"
#include "promin/view.h"

// Lists the members of the library's structs, with their names outside C++: in Python and in the JSON of `promin info`.
namespace promin {

using Names = std::span<const std::string_view>;

inline constexpr std::string_view kLightKindNames[] = {
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) #PREFIX,
#include "promin/kinds/lights.def"
};
inline constexpr std::string_view kAttenuationNames[] = {"none", "inverse_square"};
inline constexpr std::string_view kAlphaModeNames[] = {"opaque", "mask", "blend"};
inline constexpr std::string_view kProjectionNames[] = {"perspective", "orthographic"};
inline constexpr std::string_view kImageUseNames[] = {"color", "data", "normal"};
inline constexpr std::string_view kTextureWrapNames[] = {"repeat", "mirrored_repeat", "clamp_to_edge"};

// Names of enumerators, by their values.
// clang-format off
inline Names names_of(LightKind /*any*/) { return kLightKindNames; }
inline Names names_of(Attenuation /*any*/) { return kAttenuationNames; }
inline Names names_of(AlphaMode /*any*/) { return kAlphaModeNames; }
inline Names names_of(Projection /*any*/) { return kProjectionNames; }
inline Names names_of(ImageUse /*any*/) { return kImageUseNames; }
inline Names names_of(TextureWrap /*any*/) { return kTextureWrapNames; }
inline Names names_of(DepthKind /*any*/) { return depth_kind_names(); }
inline Names names_of(ToneMapping /*any*/) { return tone_mapping_names(); }
inline Names names_of(PixelFilter /*any*/) { return pixel_filter_names(); }
inline Names names_of(DebugView /*any*/) { return debug_view_names(); }
inline Names names_of(Integrator /*any*/) { return integrator_names(); }
inline Names names_of(ExrCompression /*any*/) { return exr_compression_names(); }
// clang-format on

using MaterialModel = decltype(Material::model);
using SkyModel = decltype(Environment::sky);

// Names of the alternatives of MaterialModel, SkyModel and Geometry, each in the order of the variant.
inline constexpr std::string_view kModelNames[] = {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) #PREFIX,
#include "promin/kinds/materials.def"
};
inline constexpr std::string_view kSkyNames[] = {"none", "studio", "gradient", "panorama"};
inline constexpr std::string_view kShapeNames[] = {
    "mesh",
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) #PREFIX,
#include "promin/kinds/primitives.def"
};
static_assert(std::size(kModelNames) == std::variant_size_v<MaterialModel>);
static_assert(std::size(kSkyNames) == std::variant_size_v<SkyModel>);
static_assert(std::size(kShapeNames) == std::variant_size_v<Geometry>);

/// Calls the visitor with each member and its name. The names are given in one text, separated by ", ".
template <typename Visitor, typename... Members>
void visit_named_members(Visitor& visitor, std::string_view names, Members&... members) {
  const auto next = [&] {
    const std::string name(names.substr(0, names.find(',')));
    names.remove_prefix(std::min(names.size(), name.size() + 2));
    return name;
  };
  (visitor.field(next(), members), ...);
}

// PROMIN_MEMBERS(STRUCT, members...): defines the function that calls a visitor with the members of a struct. All
// members must be listed in order; a missing member is a compile error.
#define PROMIN_MEMBERS(STRUCT, ...)                          \
  template <typename Visitor>                                \
  void visit_members(Visitor& visitor, STRUCT& record) {     \
    auto& [__VA_ARGS__] = record;                            \
    visit_named_members(visitor, #__VA_ARGS__, __VA_ARGS__); \
  }

// clang-format off
PROMIN_MEMBERS(Light, name, kind, position, direction, diffuse, specular, attenuation, range, inner_cone_angle,
               outer_cone_angle, radius, angle, size, right, is_on)
PROMIN_MEMBERS(TextureSlot, texture, uv_set, to_u, to_v)
PROMIN_MEMBERS(Texture, image, wrap_u, wrap_v, is_magnified_linearly, is_minified_linearly, has_levels,
               are_levels_linear)
PROMIN_MEMBERS(FileExtension, name, is_used, is_required)
PROMIN_MEMBERS(Phong, ambient, diffuse, specular, shininess, reflection, transmission, ior, fresnel, diffuse_texture,
               specular_texture, normal_texture)
PROMIN_MEMBERS(MetallicRoughness, base_color, metallic, roughness, ior, specular, specular_color, specular_texture,
               specular_color_texture, transmission, transmission_texture, diffuse_transmission,
               diffuse_transmission_color, diffuse_transmission_texture, diffuse_transmission_color_texture, thickness,
               attenuation_color, attenuation_distance, dispersion, base_color_texture, metallic_roughness_texture,
               normal_texture, normal_scale, occlusion_texture, occlusion_strength, clearcoat, clearcoat_roughness,
               clearcoat_texture, clearcoat_roughness_texture, clearcoat_normal_texture, clearcoat_normal_scale,
               sheen_color, sheen_roughness, sheen_color_texture, sheen_roughness_texture, iridescence, iridescence_ior,
               iridescence_thickness_minimum, iridescence_thickness_maximum, iridescence_texture,
               iridescence_thickness_texture, anisotropy, anisotropy_rotation, anisotropy_texture)
PROMIN_MEMBERS(Unlit, color, color_texture, catches_shadows)
PROMIN_MEMBERS(Material, name, model, emissive, emissive_texture, alpha_mode, alpha, alpha_cutoff, is_double_sided)
PROMIN_MEMBERS(Camera, name, projection, eye, look, up, yfov, ymag, aspect_ratio, resolution, near,
               aperture_radius, focus_distance)
PROMIN_MEMBERS(Studio, front)
PROMIN_MEMBERS(GradientSky, top, horizon, bottom, top_curve, bottom_curve)
PROMIN_MEMBERS(Panorama, image)
PROMIN_MEMBERS(Backdrop, top, bottom, radiance)
PROMIN_MEMBERS(Environment, ambient, background, sky, shows_sky, up, rotation, intensity, backdrop)
PROMIN_MEMBERS(DisplayTransform, exposure_ev, tone_mapping, dithers)
PROMIN_MEMBERS(ExrOptions, is_half, compression)
PROMIN_MEMBERS(ErrorTarget, error, min_samples, white, display, max_samples)
PROMIN_MEMBERS(PixelWindow, lo, hi)
PROMIN_MEMBERS(RenderMode, debug_view, has_shadows, integrator)
PROMIN_MEMBERS(View, camera, size, crop, samples_per_pixel, error_target, depth_kind, filter, filter_width, max_depth,
               seed, occlusion_distance, mode)
PROMIN_MEMBERS(Sphere, center, radius)
PROMIN_MEMBERS(Plane, point, normal)
PROMIN_MEMBERS(Cylinder, center, axis, half_height, radius, is_open)
PROMIN_MEMBERS(Cone, center, axis, half_height, radius_bottom, radius_top, is_open)
PROMIN_MEMBERS(Box, center, half_size)
PROMIN_MEMBERS(Capsule, center, axis, half_height, radius_bottom, radius_top)
// clang-format on
#undef PROMIN_MEMBERS

template <typename Visitor>
void visit_members(Visitor& /*visitor*/, std::monostate& /*nothing*/) {}

}  // namespace promin
