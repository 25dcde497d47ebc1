// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "promin/export.h"
#include "promin/image.h"

namespace promin {

/// What the numbers of a picture are.
enum class PictureEncoding {
  /// Linear light of any range, as EXR and Radiance files have it.
  kLinear,
  /// Codes of sRGB in 0...1, as PNG files have them.
  kSrgb,
};

/// What a file's numbers are, by its ending: linear for .exr, .hdr and .pfm, else sRGB.
PROMIN_EXPORT PictureEncoding encoding_of(const std::filesystem::path& file);

/// Pixels for each degree of the observer's view: of FLIP's paper, a screen of 3840 pixels, 0.7 m wide and 0.7 m away.
inline constexpr double kPixelsPerDegree = 67.02064327658226;

/// How two pictures are compared.
struct CompareChoice {
  /// What the numbers of both pictures are; only FLIP needs to know.
  PictureEncoding encoding = PictureEncoding::kLinear;
  /// A pixel of which a channel differs by more counts among `different_count`. Not negative.
  double fail = 0.0;
  /// See kPixelsPerDegree; positive.
  double pixels_per_degree = kPixelsPerDegree;
};

/// How far apart two pictures are, in the units of their numbers.
struct PictureDifference {
  /// Of each of the two.
  uint64_t pixel_count = 0;
  /// Of the absolute differences of all channels of all pixels that are finite in both pictures.
  double mean = 0.0;
  /// Root of the mean of their squares.
  double rmse = 0.0;
  /// Peak signal-to-noise ratio in decibels, of a peak of 1: -20 log10(rmse); infinite where the pictures are equal.
  double psnr_db = 0.0;
  /// The largest absolute difference of a channel; infinite where one picture has a number and the other has not, or
  /// numbers that are not finite differ.
  double largest = 0.0;
  /// Where that is, the first in the order of rows.
  uvec2 largest_at{0};
  /// Pixels of which a channel differs by more than CompareChoice::fail.
  uint64_t different_count = 0;
  /// Pixels with a NaN or an infinity in either picture. Where both have the same there they do not differ.
  uint64_t non_finite_count = 0;
  /// The mean of FLIP, 0...1, what a viewer sees who flips between the two: LDR-FLIP of Andersson et al., "FLIP: A
  /// Difference Evaluator for Alternating Images" (HPG 2020). Linear light is clamped to [0, 1] and encoded first.
  double flip = 0.0;
  /// FLIP of each pixel, 0...1, row by row.
  std::vector<float> flip_map;
};

/// Compares two pictures. FLIP takes the first as the reference, to which it is symmetric but for rounding. Any thread
/// may call it; it takes all cores, and gives the same bits whatever their number. Throws InputError where the sizes
/// differ or there are no pixels.
PROMIN_EXPORT PictureDifference compare_pictures(const Image& reference, const Image& test,
                                                 const CompareChoice& choice = {});

}  // namespace promin
