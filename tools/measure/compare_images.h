// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "promin/image.h"

namespace promin {

/// When two pictures count as equal: as OpenImageIO compares them, with the golden images' thresholds, and stricter
/// with pixels that are not finite. A pixel's difference is the largest absolute one of its channels, in linear light.
struct CompareOptions {
  /// A pixel that differs by more has failed; a share of them is allowed.
  float fail = 0.004F;
  /// Share of failed pixels that is allowed, in percent.
  double fail_percent = 0.02;
  /// One pixel that differs by more fails the comparison.
  float hard_fail = 0.012F;
  /// Share of edge pixels that is allowed, in percent; 0 knows no edges. On an edge a driver's rounding may decide for
  /// the neighbour: a pixel over `fail` is on one if it shows something between the values of the second picture there
  /// and around it. It counts neither as failed nor for the other figures, but if many did, a shifted picture would
  /// pass.
  double edge_percent = 0.0;
  /// Length of the list ImageDifference::worst, at most.
  size_t worst_count = 10;
};

struct PixelDifference {
  uvec2 pixel{0};
  /// Infinite where either picture has a NaN or an infinity.
  float difference = 0.0F;
};

struct ImageDifference {
  bool is_equal = false;
  /// The mean over all channels of all finite pixels; pixels on edges count as equal.
  double mean_absolute = 0.0;
  uint64_t pixel_count = 0;
  /// Pixels over CompareOptions::fail; those that are not finite are among them.
  uint64_t failed_count = 0;
  /// Pixels with a NaN or an infinity in either picture: any of them fails the comparison, equal or not.
  uint64_t non_finite_count = 0;
  uint64_t edge_count = 0;
  /// Of all pixels.
  float largest = 0.0F;
  /// The worst pixels first, of equal ones the upper left; pixels without a difference are left out.
  std::vector<PixelDifference> worst;

  /// Of all pixels.
  double percent_of(uint64_t count) const;
  double failed_percent() const { return percent_of(failed_count); }
  /// The numbers on a line and each of the worst pixels on a line of its own.
  std::string summary() const;
};

/// Throws InputError if the pictures differ in size or have no pixels.
ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// Writes |a - b| * gain by the file's ending, magenta where either picture is not finite. Throws like compare_images
/// and write_image.
void write_difference_image(const std::filesystem::path& file, const Image& a, const Image& b, float gain = 1.0F);

}  // namespace promin
