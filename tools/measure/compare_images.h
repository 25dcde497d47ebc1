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

/// Decides when two pictures count as equal. OpenImageIO compares them, with the thresholds of the golden images;
/// pixels that are not finite are compared more strictly. A pixel's difference is the largest absolute difference of
/// its channels, in linear light.
struct CompareOptions {
  /// A pixel whose difference is larger has failed; a small fraction of failed pixels is allowed.
  float fail = 0.004F;
  /// The allowed fraction of failed pixels, in percent.
  double fail_percent = 0.02;
  /// A single pixel whose difference is larger fails the comparison.
  float hard_fail = 0.012F;
  /// The allowed fraction of edge pixels, in percent; with 0 no pixel counts as an edge. On an edge, a driver's
  /// rounding may select the neighbour's surface. A pixel over `fail` is on an edge if its value lies between the
  /// values of the second picture at and around it. Such a pixel counts neither as failed nor in the other figures. If
  /// there were no limit, a shifted picture would pass.
  double edge_percent = 0.0;
  /// The greatest length of the list ImageDifference::worst.
  size_t worst_count = 10;
};

struct PixelDifference {
  uvec2 pixel{0};
  /// The pixel's difference; infinite where either picture has a NaN or an infinity.
  float difference = 0.0F;
};

struct ImageDifference {
  bool is_equal = false;
  /// The mean difference over all channels of all finite pixels; pixels on edges count as equal.
  double mean_absolute = 0.0;
  uint64_t pixel_count = 0;
  /// The number of pixels over CompareOptions::fail, including pixels that are not finite.
  uint64_t failed_count = 0;
  /// The number of pixels with a NaN or an infinity in either picture. Any such pixel fails the comparison, equal or
  /// not.
  uint64_t non_finite_count = 0;
  uint64_t edge_count = 0;
  /// The largest difference of all pixels.
  float largest = 0.0F;
  /// The worst pixels first, and of equal ones the upper left first. Pixels without a difference are left out.
  std::vector<PixelDifference> worst;

  /// Returns a number of pixels as a percentage of all pixels.
  double percent_of(uint64_t count) const;
  double failed_percent() const { return percent_of(failed_count); }
  /// Returns a line with the numbers and then one line for each of the worst pixels.
  std::string summary() const;
};

/// Compares two pictures. Throws InputError if they differ in size or have no pixels.
ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options = {});

/// Writes |a - b| * gain in the format of the file's extension; pixels where either picture is not finite are magenta.
/// Throws like compare_images and write_image.
void write_difference_image(const std::filesystem::path& file, const Image& a, const Image& b, float gain = 1.0F);

}  // namespace promin
