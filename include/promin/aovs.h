// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// How much of a pixel something covers.
struct Coverage {
  /// What object and material are where there is nothing.
  static constexpr uint32_t kNoId = 0xFFFFFFFF;

  /// Index of an object (Scene::objects) or of a material; kNoId: nothing.
  uint32_t id = kNoId;
  /// Of the pixel's samples, 0...1.
  float share = 0.0F;

  /// Whether they are the same.
  bool operator==(const Coverage&) const = default;
};

/// The most that is told of what covers a pixel, the largest share first, at equal shares the lower index.
inline constexpr size_t kCoverageRanks = 6;
/// See kCoverageRanks.
using CoverageRanks = std::array<Coverage, kCoverageRanks>;

/// Where AOVs come from, which is what they cost: a surface is of the middle sample and costs little; parts of light
/// are summed over samples; steps take a pass of their own; what tells of sampling costs nothing; the share of unlit
/// surfaces is summed over samples too, and costs less than parts.
enum class AovSource : uint32_t { kSurface, kParts, kSteps, kSampling, kUnlit };

/// A choice of AOVs; each member is named as that of Aovs.
struct AovSet {
  /// @cond
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) bool FIELD = false;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// Whether Aovs::object_coverage and Aovs::material_coverage are told.
  bool cryptomatte = false;

  /// All that the camera's middle ray tells of a pixel, and of its sampling: AovSource::kSurface and kSampling.
  PROMIN_EXPORT static AovSet of_surfaces();
  /// Whether there is one of this source.
  PROMIN_EXPORT bool has_any(AovSource source) const;
  /// Whether there is one at all.
  PROMIN_EXPORT bool any() const;
  /// What is in one of them.
  PROMIN_EXPORT AovSet operator|(const AovSet& other) const;
};

/// Arbitrary output variables: what a picture tells of each pixel beside its colour. The values stand row by row as
/// those of the image. Of the pixel's middle sample, that of index samples / 2, which with an odd number of samples and
/// with an error target is the pixel's centre:
///   - depth: distance from the eye, or along the view (View::depth_kind); infinite on a miss
///   - position: of the hit, in the world less Scene::center; 0 on a miss
///   - normal: geometric normal as Hit::normal, never flipped to the ray; 0 on a miss
///   - shading_normal: the normal that light meets, interpolated and textured; faces the eye; 0 on a miss
///   - uv: texture coordinates of the first set, but for whole numbers; 0 where the surface shows no texture
///   - albedo: the base colour, linear RGB, with vertex colours and textures: of Phong materials the diffuse factor, of
///     unlit ones the colour; 0 on a miss
///   - object, primitive: as Hit::object and Hit::primitive; kNoId on a miss
///   - material: index into Scene::materials; kNoId on a miss
///   - steps: node steps and primitive tests that the ray took
/// Of all samples, linear light as the image has it; together they are the image's pixel but for rounding (a debug view
/// has none of them):
///   - emission: what the surface that the camera sees emits, or an unlit one its colour
///   - direct: what lights bring to that surface
///   - indirect: what comes from all around it: ambient light and environment, but for what mirror rays meet
///   - reflection: what mirror rays from it bring
///   - transmission: what rays through its glass bring
///   - background: what is seen beside and behind the scene
/// What blends with what is behind it counts with its share, and what is behind it with the rest.
///   - alpha: how much of the pixel shows the scene and not the background, 0...1. An image with it has no background:
///     its pixels are what is left of them without, premultiplied
///   - unlit: of the image's pixel what the camera sees of unlit surfaces and of a backdrop, without mirrors or glass
///     between, and how much of the pixel shows them, 0...1: what apply() (promin/display.h) shows as it is
///   - samples: how many the pixel has taken
///   - error: by how much each channel may be off: with an error target the claim (promin/view.h, ErrorTarget), else an
///     estimate by the samples of the pixel and of those around it, which knows of edges alone; a debug view has none
struct Aovs {
  /// What object, primitive and material are on a miss.
  static constexpr uint32_t kNoId = Coverage::kNoId;

  /// @cond
  // The members, of the table.
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) std::vector<TYPE> FIELD;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// What objects cover of each pixel, as its samples see them first; what is behind glass or blends is not told.
  std::vector<CoverageRanks> object_coverage;
  /// And what their materials do.
  std::vector<CoverageRanks> material_coverage;

  /// Gives each of the set `pixel_count` values, which say that nothing was hit; all others become empty.
  PROMIN_EXPORT void resize(size_t pixel_count, const AovSet& set);
};

/// Names of the AOVs, in the order of the members of Aovs, without Cryptomatte.
PROMIN_EXPORT std::span<const std::string_view> aov_names();

}  // namespace promin
