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

/// What a device says of each pixel's primary ray, row by row: distance from the eye, infinite on a miss; geometric
/// normal, never flipped; numbers, kNoObject on a miss.
struct DeviceAovs {
  std::span<const float> depth;
  std::span<const vec3> normal;
  std::span<const uint32_t> object;
  std::span<const uint32_t> primitive;
};
inline constexpr uint32_t kNoObject = 0xFFFFFFFF;

/// What passes.
struct PictureBounds {
  /// Of another object or primitive than the oracle's, in u S: B2, and what the camera's ray is off by itself. Of
  /// d = look + (x right - y up) each product, the difference and the sum are rounded; as |x right - y up| <= |d| that
  /// is (1 + 1 + sqrt(2)) u |d|, and so much of S at the hit.
  Real id_margin = kB2 + 3.4L;
  /// Of all pixels; as many may have the normal from across a crease, which is another answer likewise.
  double id_share = 0.0005;
  Real depth_error = kB1;
  /// Largest difference of a channel for which a pixel's colour counts as right, and the mean over all pixels; of both
  /// Pixel::explained_error and map_error are taken off before.
  Real color_error = 0.02L;
  Real color_mean = 1e-4L;
  /// Pixels of another colour. What mirrors show moves farther than they do.
  double color_share = 0.0005;
  double color_share_with_mirrors = 0.005;
  /// The mean difference, with what is explained, of the pixels that are sure. It holds what maps of skies may be off.
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
  /// Verdict::t_error, where it is beyond the bound.
  std::vector<PixelError> depth_errors;
  /// |dN| in units of what is allowed (allowed_normal_error), where it is more.
  std::vector<PixelError> normal_errors;
  /// Those where the ray passes a rim or apex within id_margin: either side's normal is right, in a few pixels.
  std::vector<PixelError> normals_at_creases;
  /// Largest difference of a channel beyond what the pixel explains, where it is beyond the bound.
  std::vector<PixelError> color_errors;

  /// Pixels that are unsure, and of all others the mean and the largest difference with what is explained.
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
