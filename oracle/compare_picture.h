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

/// Compares a device's picture with the oracle's.
namespace promin::oracle {

/// A device's results for the primary ray of each pixel, row by row: the distance from the eye, infinite on a miss; the
/// geometric normal, never flipped; and object and primitive, kNoObject on a miss.
struct DeviceAovs {
  std::span<const float> depth;
  std::span<const vec3> normal;
  std::span<const uint32_t> object;
  std::span<const uint32_t> primitive;
};
inline constexpr uint32_t kNoObject = 0xFFFFFFFF;

/// The largest errors that a picture may have.
struct PictureBounds {
  /// The largest margin of a pixel with another object or primitive than the oracle's, in units of u S: B2 plus the
  /// error of the camera's ray. In d = look + (x right - y up) each product, the difference and the sum are rounded.
  /// Because |x right - y up| <= |d|, the error is (1 + 1 + sqrt(2)) u |d|, and the same fraction of S at the hit.
  Real id_margin = kB2 + 3.4L;
  /// The largest fraction of pixels with another object or primitive. The same fraction may have the normal of the
  /// other side of a crease, which is also a different answer.
  double id_share = 0.0005;
  Real depth_error = kB1;
  /// Largest difference of a channel for which a pixel's colour counts as right. It also limits the mean over all
  /// pixels. Pixel::explained_error and map_error are subtracted from differences first.
  Real color_error = 0.02L;
  Real color_mean = 1e-4L;
  /// The largest fraction of pixels with another colour. Reflections move farther than the mirrors that show them.
  double color_share = 0.0005;
  double color_share_with_mirrors = 0.005;
  /// The largest mean difference of the sure pixels. Explained differences count. The bound includes the permitted
  /// error of sky maps.
  Real plain_mean = kInfinity;
  /// The largest fraction of unsure pixels. In an unsure pixel, explained_error exceeds color_error, so the comparison
  /// says little about the device.
  double unsure_share = 0.005;
};

struct IdMismatch {
  uvec2 pixel{0};
  Hit expected;
  Answer got;
  /// The answer's Verdict::margin.
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

  /// Pixels with a NaN or an infinity in the colour or the normal, or with a depth that is not finite on a hit or not
  /// +inf on a miss.
  std::vector<uvec2> non_finite;
  /// All pixels with another object or primitive, whether their margins explain the difference or not.
  std::vector<IdMismatch> id_mismatches;
  /// Pixels whose Verdict::t_error exceeds the bound.
  std::vector<PixelError> depth_errors;
  /// Pixels whose normal error |dN| exceeds the permitted error (allowed_normal_error). The value is the ratio of the
  /// two.
  std::vector<PixelError> normal_errors;
  /// Pixels whose ray passes a rim or apex within id_margin and whose normal differs. In these few pixels the normal of
  /// either side is correct.
  std::vector<PixelError> normals_at_creases;
  /// Pixels in which the largest difference of a channel, after subtracting explained errors, exceeds the bound.
  std::vector<PixelError> color_errors;

  /// The number of unsure pixels, and the mean and the largest difference of all other pixels. Explained differences
  /// count.
  uint64_t unsure_count = 0;
  Real plain_mean = 0;
  Real plain_largest = 0;

  /// The largest errors over all pixels with the same primitive, except normals at creases.
  Real largest_depth_error = 0;
  Real largest_normal_error = 0;
  /// The mean difference over all channels of the pixels that are finite.
  Real color_mean = 0;

  bool passes() const;
  /// Returns a line with the verdict and the numbers, and a line for each listed pixel, at most `most_lines` per list.
  std::string summary(const world::Scene& scene, size_t most_lines = 20) const;
};

/// Compares two pictures. Throws std::invalid_argument if their sizes differ. Without AOVs (empty spans) only colours
/// are compared.
PictureReport compare_picture(const world::Scene& scene, const Picture& expected, const Image& image,
                              const DeviceAovs& aovs, const PictureBounds& bounds = {});

}  // namespace promin::oracle
