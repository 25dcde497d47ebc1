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

/// The part of a pixel that one object or material covers.
struct Coverage {
  /// The id of an object or material where there is none.
  static constexpr uint32_t kNoId = 0xFFFFFFFF;

  /// Index into Scene::objects or Scene::materials; kNoId for nothing.
  uint32_t id = kNoId;
  /// Part of the pixel's samples, 0...1.
  float share = 0.0F;

  /// Returns whether both are equal.
  bool operator==(const Coverage&) const = default;
};

/// The largest number of ids that are kept for a pixel. They are sorted by share, the largest first; of equal shares
/// the lower index comes first.
inline constexpr size_t kCoverageRanks = 6;
/// See kCoverageRanks.
using CoverageRanks = std::array<Coverage, kCoverageRanks>;

/// How an AOV is computed, which determines its cost. kSurface reads the surface at the middle sample and costs little.
/// kParts sums parts of the light over all samples. kSteps needs a pass of its own. kSampling describes the sampling
/// and costs nothing. kUnlit sums the share of unlit surfaces over all samples and costs less than kParts.
enum class AovSource : uint32_t { kSurface, kParts, kSteps, kSampling, kUnlit };

/// A selection of AOVs. Each member has the name of the member of Aovs that it selects.
struct AovSet {
  /// @cond
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) bool FIELD = false;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// Whether Aovs::object_coverage and Aovs::material_coverage are computed.
  bool cryptomatte = false;

  /// Returns all AOVs of the sources kSurface and kSampling: those of the pixel's middle ray and of its sampling.
  PROMIN_EXPORT static AovSet of_surfaces();
  /// Returns whether an AOV of this source is selected.
  PROMIN_EXPORT bool has_any(AovSource source) const;
  /// Returns whether any AOV is selected.
  PROMIN_EXPORT bool any() const;
  /// Returns the AOVs that are in either set.
  PROMIN_EXPORT AovSet operator|(const AovSet& other) const;
};

/// Arbitrary output variables: properties of each pixel beside its colour. Values are stored in row order like those of
/// the image. These describe the pixel's middle sample, which has the index samples / 2; with an odd number of samples
/// and with an error target it is the pixel's centre:
///   - depth: distance from the eye, or along the direction of view (View::depth_kind); infinite on a miss
///   - position: the hit point in the world minus Scene::center; 0 on a miss
///   - normal: geometric normal as Hit::normal, never flipped towards the ray; 0 on a miss
///   - shading_normal: interpolated and textured normal that faces the eye; 0 on a miss
///   - uv: texture coordinates of the first set up to whole numbers; 0 if the surface shows no texture
///   - albedo: base colour in linear RGB with vertex colours and textures; the diffuse factor of Phong materials, the
///     colour of unlit ones; 0 on a miss
///   - object, primitive: as Hit::object and Hit::primitive; kNoId on a miss
///   - material: index into Scene::materials; kNoId on a miss
///   - steps: number of node steps and primitive tests of the ray
/// These are sums over all samples, linear light like the image. Together they are the image's pixel up to rounding;
/// debug views have none of them:
///   - emission: light that the surface seen by the camera emits, or the colour of an unlit one
///   - direct: light from lights that the surface reflects
///   - indirect: ambient light and light from the environment, except light that mirror rays return
///   - reflection: light that its mirror rays return
///   - transmission: light that rays through its glass return
///   - background: the background beside and behind the scene
/// A surface that blends counts with its opacity, and the surfaces behind it with the remainder. Further AOVs:
///   - alpha: the part of the pixel that shows the scene and not the background, 0...1. An image with this AOV has no
///     background: its pixels are premultiplied
///   - unlit: the colour of unlit surfaces and of a backdrop that the camera sees without mirrors or glass in between,
///     and the part of the pixel that they cover, 0...1; apply() (promin/display.h) displays them unchanged
///   - samples: number of samples that the pixel has taken
///   - error: by how much each channel may be off. With an error target it is the claim (promin/view.h, ErrorTarget);
///     else it is an estimate from the samples of the pixel and its neighbours, which recognises only edges; a debug
///     view has none
struct Aovs {
  /// The value of object, primitive and material on a miss.
  static constexpr uint32_t kNoId = Coverage::kNoId;

  /// @cond
  // One member for each row of the table.
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) std::vector<TYPE> FIELD;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// Coverage of each pixel by objects: for each sample the first object that its ray hits. Objects behind glass or
  /// behind surfaces that blend are not counted.
  std::vector<CoverageRanks> object_coverage;
  /// The same for materials.
  std::vector<CoverageRanks> material_coverage;

  /// Resizes each selected member to `pixel_count` values that stand for a miss, and empties all others.
  PROMIN_EXPORT void resize(size_t pixel_count, const AovSet& set);
};

/// Returns the names of the AOVs in the order of the members of Aovs, without Cryptomatte.
PROMIN_EXPORT std::span<const std::string_view> aov_names();

}  // namespace promin
