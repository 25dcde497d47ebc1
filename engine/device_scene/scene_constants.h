// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "promin/scene.h"
#include "promin/view.h"
#include "scene/glass_solids.h"
#include "shared/layout.h"

// The blocks of constants that shaders read. Each function computes a complete block from its arguments. This code does
// not use Vulkan.
namespace promin {

/// The constants that depend only on the scene.
struct SceneConstants {
  /// Center and max-norm radius of the tree's primitives.
  vec4 tree_bounds{0.0F};
  /// Index of the first record of materials, lights, normals and colours, each in its view of the buffer of shading
  /// data.
  uvec4 first_index{0};
  uvec4 first_lookup{0};
  uvec4 first_texture{0};
  /// x is the index of the first GlassRecord.
  uvec4 first_glass{0};
  /// The solids in which the camera may be. For each material, the number of its glass; 0 if the material bounds no
  /// volume.
  std::shared_ptr<const GlassSolids> glass_solids;
  std::vector<uint32_t> media;
  /// True if any material transmits light.
  bool has_glass = false;
  /// Index of the first unbounded primitive; the unbounded primitives follow those of the tree.
  uint32_t first_unbounded = 0;
  uint32_t unbounded_count = 0;
  uint32_t light_count = 0;
  /// The sources of Integrator::kDirect and kPath: the first one, counted from the first light, and their number.
  /// Besides the lights they are surfaces that emit light and the environment if it gives light.
  uint32_t first_direct = 0;
  uint32_t direct_count = 0;

  /// Returns the number of sources of an integrator.
  uint32_t source_count(bool is_direct) const { return is_direct ? direct_count : light_count; }
  vec3 ambient{0.0F};
  vec3 background{0.0F};
  /// True if the sky is visible in place of the background.
  bool shows_sky = false;
  /// The backdrop; it replaces sky and background.
  std::optional<Backdrop> backdrop;
  std::array<vec4, 9> irradiance{};
};

/// Returns the constants of a view, which describe its camera and picture. They are computed in double.
layout::ViewConstants make_view_constants(const SceneConstants& scene, const View& view);

/// Returns the constants of casts, which have no camera.
layout::ViewConstants make_cast_constants(const SceneConstants& scene);

/// A piece of work: one sample of each pixel of a range of blocks.
struct TileRange {
  uint32_t first_block = 0;
  uint32_t end_block = 0;
  uint32_t sample = 0;
  /// Position of the sample in the pixel (device_scene/sampling.h).
  vec2 sample_point{0.5F};
};
layout::Dispatch make_tile_dispatch(const SceneConstants& scene, const View& view, const PixelWindow& window,
                                    const TileRange& range);

/// Returns the constants of a dispatch that casts rays [first, end).
layout::Dispatch make_cast_dispatch(const SceneConstants& scene, uint32_t first_ray, uint32_t end_ray);

}  // namespace promin
