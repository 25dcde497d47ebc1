// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "oracle/picture.h"
#include "oracle/verdict.h"
#include "promin/image.h"

/// A device's picture against the oracle's.
namespace promin::oracle {

/// A device's results for each pixel's primary ray, row by row: distance from the eye, infinite on a miss; geometric
/// normal, never flipped; object and primitive, kNoObject on a miss.
struct DeviceAovs {
  std::span<const float> depth;
  std::span<const vec3> normal;
  std::span<const uint32_t> object;
  std::span<const uint32_t> primitive;
};
inline constexpr uint32_t kNoObject = 0xFFFFFFFF;

/// The largest errors with which a picture passes.
struct PictureBounds {
  /// For another object or primitive than the oracle's, in u S: B2 plus the error of the camera's ray itself. In d =
  /// look + (x right - y up) each product, the difference and the sum are rounded. Because |x right - y up| <= |d|, the
  /// error is (1 + 1 + sqrt(2)) u |d|, and the same part of S at the hit.
  Real id_margin = kB2 + 3.4L;
  /// The share of all pixels. As many pixels may have the normal from across a crease, which also is a different
  /// answer.
  double id_share = 0.0005;
  Real depth_error = kB1;
  /// Largest difference of a channel for which a pixel's colour counts as right, and the mean over all pixels; of both
  /// Pixel::explained_error and map_error are taken off before.
  Real color_error = 0.02L;
  Real color_mean = 1e-4L;
  /// The share of pixels of another colour. Reflections move farther than the mirrors that show them.
  double color_share = 0.0005;
  double color_share_with_mirrors = 0.005;
  /// The mean difference of the sure pixels, including explained differences. It includes the permitted error of sky
  /// maps.
  Real plain_mean = kInfinity;
  /// Pixels that are unsure: explained_error is more than color_error, so they hold a device to little.
  double unsure_share = 0.005;
};

struct IdMismatch {
  uvec2 pixel{0};
  Hit expected;
  Answer got;
  /// Verdict::margin
  Real margin = 0;
};

struct PixelError {
  uvec2 pixel{0};
  Real error = 0;
};

struct PictureReport {
  PictureBounds bounds;
  uint64_t pixel_count = 0;
  bool has_mirrors = false;

  /// A NaN or an infinity in the colour or the normal, a depth that is not finite on a hit, or is not +inf on a miss.
  std::vector<uvec2> non_finite;
  /// All, whether their margins explain them or not.
  std::vector<IdMismatch> id_mismatches;
  /// Verdict::t_error, if it exceeds the bound.
  std::vector<PixelError> depth_errors;
  /// |dN| as a multiple of the permitted error (allowed_normal_error), if it exceeds that.
  std::vector<PixelError> normal_errors;
  /// Pixels whose ray passes a rim or apex within id_margin: the normal of either side is correct, in a few pixels.
  std::vector<PixelError> normals_at_creases;
  /// The largest difference of a channel beyond what the pixel explains, if it exceeds the bound.
  std::vector<PixelError> color_errors;

  /// The number of unsure pixels, and the mean and largest difference of all others, including explained differences.
  uint64_t unsure_count = 0;
  Real plain_mean = 0;
  Real plain_largest = 0;

  /// Over all pixels with the same primitive; normals at creases apart.
  Real largest_depth_error = 0;
  Real largest_normal_error = 0;
  /// Over all channels of the pixels that are finite.
  Real color_mean = 0;

  bool passes() const;
  /// Verdict and numbers on a line, and each listed pixel on a line of its own, at most `most_lines` a list.
  std::string summary(const world::Scene& scene, size_t most_lines = 20) const;
};

/// Throws std::invalid_argument if the sizes differ. Without AOVs (empty spans) colours alone are compared.
PictureReport compare_picture(const world::Scene& scene, const Picture& expected, const Image& image,
                              const DeviceAovs& aovs, const PictureBounds& bounds = {});

}  // namespace promin::oracle
