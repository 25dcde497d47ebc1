// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/scene_constants.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/divide_up.h"
#include "device_scene/scrambled_points.h"

namespace promin {
namespace {

uvec4 counts_of(const SceneConstants& scene, uint32_t sources) {
  return {scene.first_unbounded, scene.unbounded_count, sources, layout::LOOP_CHECK_TURNS};
}

/// Returns the media around the eye, in the form in which shaders/shade/glass.glsl stores the media that contain a ray.
uvec2 media_around(const SceneConstants& scene, const vec3& eye) {
  uint64_t media = 0;
  if (scene.glass_solids == nullptr) return uvec2(0);
  for (const uint32_t material : scene.glass_solids->materials_around(eye)) {
    if (scene.media[material] != 0) media = media << 16 | scene.media[material];
  }
  return {static_cast<uint32_t>(media), static_cast<uint32_t>(media >> 32)};
}

float what_is_shown(const SceneConstants& scene) {
  if (scene.backdrop) return layout::SHOWS_BACKDROP;
  return scene.shows_sky ? layout::SHOWS_SKY : layout::SHOWS_BACKGROUND;
}

}  // namespace

layout::ViewConstants make_view_constants(const SceneConstants& scene, const View& view) {
  const Camera& camera = view.camera;
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half_height =
      is_orthographic ? static_cast<double>(camera.ymag) : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half_height / view.size.y;
  const dvec3 right = glm::cross(dvec3(camera.look), dvec3(camera.up)) * pixel;
  const dvec3 up = dvec3(camera.up) * pixel;
  // Side length of a sample's share of a pixel (shaders/shade/textures.glsl).
  const uint32_t samples = view.error_target ? view.error_target->max_samples : view.samples_per_pixel;
  const auto cone = static_cast<float>(pixel / std::sqrt(static_cast<double>(samples)));
  // A ray's interval is open, but a surface exactly at the near plane must be drawn.
  const float before_near = camera.near > 0.0F ? std::nextafter(camera.near, 0.0F) : 0.0F;
  const Backdrop backdrop = scene.backdrop.value_or(Backdrop());
  layout::ViewConstants constants{
      .eye = vec4(camera.eye, before_near),
      .look = vec4(camera.look, is_orthographic ? cone : 0.0F),
      .right = vec4(vec3(right), is_orthographic ? 0.0F : cone),
      // w is the largest distance at which surfaces occlude others.
      .up = vec4(vec3(up),
                 view.occlusion_distance > 0.0F ? view.occlusion_distance : std::numeric_limits<float>::infinity()),
      .ambient = vec4(scene.ambient, 0.0F),
      .background = vec4(scene.background, what_is_shown(scene)),
      .backdrop_top = vec4(backdrop.top, backdrop.radiance),
      .backdrop_bottom = vec4(backdrop.bottom, static_cast<float>(view.size.y)),
      .backdrop_rise = vec4(vec3(dvec3(camera.up) / (2.0 * half_height)), is_orthographic ? 1.0F : 0.0F),
      .tree_bounds = scene.tree_bounds,
      .film_center = vec4(0.5F * static_cast<float>(view.size.x), 0.5F * static_cast<float>(view.size.y),
                          static_cast<float>(static_cast<double>(camera.aperture_radius) / pixel),
                          camera.aperture_radius > 0.0F ? 1.0F / camera.focus_distance : 0.0F),
      .first_index = scene.first_index,
      .first_lookup = scene.first_lookup,
      .first_texture = scene.first_texture,
      .first_glass = uvec4(scene.first_glass.x, media_around(scene, camera.eye), key_of_points(view.seed, 2)),
      .irradiance = {}};
  if (view.mode.integrator != Integrator::kWhitted) constants.first_index.y += scene.first_direct;
  std::ranges::copy(scene.irradiance, constants.irradiance);
  return constants;
}

layout::ViewConstants make_cast_constants(const SceneConstants& scene) {
  layout::ViewConstants constants{};
  constants.tree_bounds = scene.tree_bounds;
  return constants;
}

layout::Dispatch make_tile_dispatch(const SceneConstants& scene, const View& view, const PixelWindow& window,
                                    const TileRange& range) {
  const uvec2 size = window.hi - window.lo;
  const bool is_direct = view.mode.integrator != Integrator::kWhitted;
  const uint32_t is_orthographic = view.camera.projection == Projection::kOrthographic ? 1 : 0;
  return {.range = uvec4(range.first_block, range.end_block, range.sample, view.max_depth),
          .window = uvec4(window.lo, size),
          .sampling = uvec4(view.samples_per_pixel, std::bit_cast<uint32_t>(range.sample_point.x),
                            divide_up(size.x, layout::BLOCK_SIZE), is_orthographic),
          .counts = counts_of(scene, scene.source_count(is_direct)),
          // Kernels with glass may also trace scenes without glass, which have no limits.
          .outcome = uvec4(0, scene.has_glass ? layout::MOST_TREE_RAYS : ~0U,
                           std::bit_cast<uint32_t>(scene.has_glass ? layout::LEAST_TREE_WEIGHT : 0.0F),
                           std::bit_cast<uint32_t>(range.sample_point.y))};
}

layout::Dispatch make_cast_dispatch(const SceneConstants& scene, uint32_t first_ray, uint32_t end_ray) {
  return {.range = uvec4(first_ray, end_ray, 0, 0),
          .window = uvec4(0),
          .sampling = uvec4(0),
          .counts = counts_of(scene, 0),
          .outcome = uvec4(0)};
}

}  // namespace promin
