// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "promin/export.h"
#include "promin/image.h"

namespace promin {

/// The encoding of a picture's values.
enum class PictureEncoding {
  /// Linear light of any range, as in EXR and Radiance files.
  kLinear,
  /// sRGB values in 0...1, as in PNG files.
  kSrgb,
};

/// Returns the encoding that a file name's extension implies: linear for .exr, .hdr and .pfm, sRGB for all others.
PROMIN_EXPORT PictureEncoding encoding_of(const std::filesystem::path& file);

/// Default number of pixels per degree of the observer's field of view. The FLIP paper uses this value: a screen that
/// is 3840 pixels and 0.7 m wide, seen from 0.7 m away.
inline constexpr double kPixelsPerDegree = 67.02064327658226;

/// Options of compare_pictures().
struct CompareChoice {
  /// Encoding of both pictures. Only FLIP depends on it.
  PictureEncoding encoding = PictureEncoding::kLinear;
  /// Threshold for `different_count`: a pixel counts if one of its channels differs by more than this. Not negative.
  double fail = 0.0;
  /// Pixels per degree of the observer's field of view, for FLIP; positive.
  double pixels_per_degree = kPixelsPerDegree;
};

/// The difference of two pictures, in the units of their values.
struct PictureDifference {
  /// Number of pixels of each picture.
  uint64_t pixel_count = 0;
  /// Mean absolute difference over all channels of all pixels that are finite in both pictures.
  double mean = 0.0;
  /// Root mean square difference over the same channels.
  double rmse = 0.0;
  /// Peak signal-to-noise ratio in decibels for a peak of 1: -20 log10(rmse). Infinite if the pictures are equal.
  double psnr_db = 0.0;
  /// The largest absolute difference of a channel. Infinite if a value is finite in only one of the pictures, or if two
  /// values that are not finite differ.
  double largest = 0.0;
  /// The pixel with the largest difference. If several pixels have this difference, it is the first in row order.
  uvec2 largest_at{0};
  /// Number of pixels with a channel that differs by more than CompareChoice::fail.
  uint64_t different_count = 0;
  /// Number of pixels with a NaN or an infinity in either picture. Two equal values of this kind count as no
  /// difference.
  uint64_t non_finite_count = 0;
  /// The mean of `flip_map`, 0...1. FLIP estimates the difference that a viewer sees who alternates between the
  /// pictures: LDR-FLIP of Andersson et al., "FLIP: A Difference Evaluator for Alternating Images" (HPG 2020). Linear
  /// light is first clamped to [0, 1] and encoded as sRGB.
  double flip = 0.0;
  /// FLIP of each pixel, 0...1, in row order.
  std::vector<float> flip_map;
};

/// Compares two pictures. FLIP uses the first as the reference, but is symmetric up to rounding. Any thread may call
/// this function. It uses all cores, and the result has the same bits for every number of cores. Throws InputError if
/// the sizes differ or there are no pixels.
PROMIN_EXPORT PictureDifference compare_pictures(const Image& reference, const Image& test,
                                                 const CompareChoice& choice = {});

}  // namespace promin
