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

/// The fraction of a pixel that one object or material covers.
struct Coverage {
  /// The value of `id` if no object or material covers the pixel.
  static constexpr uint32_t kNoId = 0xFFFFFFFF;

  /// Index into Scene::objects or Scene::materials, or kNoId.
  uint32_t id = kNoId;
  /// Fraction of the pixel's samples that hit the object or material, 0...1.
  float share = 0.0F;

  /// Returns whether both are equal.
  bool operator==(const Coverage&) const = default;
};

/// The largest number of ids that a pixel stores. The ids are sorted by descending share. Equal shares are sorted by
/// ascending index.
inline constexpr size_t kCoverageRanks = 6;
/// The ids and shares of one pixel, sorted as kCoverageRanks describes.
using CoverageRanks = std::array<Coverage, kCoverageRanks>;

/// The source of an AOV, which determines its cost. kSurface reads the surface at the middle sample and costs little.
/// kParts sums one component of the light (e.g. direct light) over all samples. kSteps needs a pass of its own.
/// kSampling describes the sampling and costs nothing. kUnlit sums the share of unlit surfaces over all samples and
/// costs less than kParts. kOcclusion needs a pass of its own with the samples of the picture, or with 64 samples if
/// the picture has an error target. kMotion is computed from AOVs of kSurface and the scene of the next frame.
enum class AovSource : uint32_t { kSurface, kParts, kSteps, kSampling, kUnlit, kOcclusion, kMotion };

/// A selection of AOVs. Each member has the name of the member of Aovs that it selects.
struct AovSet {
  /// @cond
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) bool FIELD = false;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// If true, Aovs::object_coverage and Aovs::material_coverage are computed.
  bool cryptomatte = false;

  /// Returns all AOVs of the sources kSurface and kSampling: the AOVs of the pixel's middle sample and of its sampling.
  PROMIN_EXPORT static AovSet of_surfaces();
  /// Returns whether an AOV of this source is selected.
  PROMIN_EXPORT bool has_any(AovSource source) const;
  /// Returns whether any AOV is selected.
  PROMIN_EXPORT bool any() const;
  /// Returns the union of the two sets.
  PROMIN_EXPORT AovSet operator|(const AovSet& other) const;
};

/// Arbitrary output variables: properties of each pixel in addition to its colour. The values are stored in row order,
/// as the pixels of an image are. The following AOVs describe the pixel's middle sample, which has the index
/// samples / 2. This sample lies at the pixel's centre if the number of samples is odd or the view has an error target:
///   - depth: distance from the eye, or along the direction of view (View::depth_kind); infinite on a miss
///   - position: the hit point in the world minus Scene::center; 0 on a miss
///   - normal: geometric normal as Hit::normal, never flipped towards the ray; 0 on a miss
///   - shading_normal: interpolated and textured normal that faces the eye; 0 on a miss
///   - uv: texture coordinates of set 0, correct up to an added integer; 0 if the surface has no texture
///   - albedo: base colour in linear RGB with vertex colours and textures; for Phong materials the diffuse factor, for
///     unlit materials the colour; 0 on a miss
///   - object, primitive: the same as Hit::object and Hit::primitive; kNoId on a miss
///   - material: index into Scene::materials; kNoId on a miss
///   - steps: number of node steps and primitive tests of the ray
///   - motion: the movement of the surface until the next frame in pixels, to the right and upwards. add_motion()
///     (promin/motion_vectors.h) computes it after a Renderer, which returns (0, 0) here. If it is selected, the
///     Renderer also returns position, object and primitive, from which it is computed
/// The following AOVs are averages over all samples in linear light. Their sum is the image's pixel up to rounding.
/// Debug views have none of these AOVs:
///   - emission: light that the visible surface emits, or the colour of an unlit surface
///   - direct: light of light sources that the surface reflects
///   - indirect: ambient light and light from the environment, except light that mirror rays return
///   - reflection: light that the surface's mirror rays return
///   - transmission: light that rays through the surface's glass return
///   - background: the background where no surface covers it
/// A surface that blends counts with its opacity, and the surfaces behind it with the remainder. Further AOVs:
///   - alpha: the fraction of the pixel that shows the scene and not the background, 0...1. An image with this AOV has
///     no background, and its pixels are premultiplied by alpha
///   - unlit: the colour of unlit surfaces and of a backdrop that the camera sees without mirrors or glass in between,
///     and the fraction of the pixel that they cover, 0...1; apply() (promin/display.h) does not change these colours
///   - samples: number of samples that the pixel has taken
///   - error: the estimated error of each channel. With an error target it is the claim (promin/view.h, ErrorTarget).
///     Otherwise it is an estimate from the samples of the pixel and its neighbours, which detects only edges. A debug
///     view has no estimate
struct Aovs {
  /// The value of object, primitive and material on a miss.
  static constexpr uint32_t kNoId = Coverage::kNoId;

  /// @cond
  /// One member for each row of the table.
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) std::vector<TYPE> FIELD;
#include "promin/kinds/aovs.def"
  /// @endcond
  /// Coverage of each pixel by objects. A sample counts for the first object that its ray hits. Objects behind glass or
  /// behind surfaces that blend are not counted.
  std::vector<CoverageRanks> object_coverage;
  /// Coverage of each pixel by materials, computed in the same way.
  std::vector<CoverageRanks> material_coverage;

  /// Resizes each selected member to `pixel_count` values that represent a miss, and empties all other members.
  PROMIN_EXPORT void resize(size_t pixel_count, const AovSet& set);
};

/// Returns the names of the AOVs in the order of the members of Aovs, without Cryptomatte.
PROMIN_EXPORT std::span<const std::string_view> aov_names();

}  // namespace promin
