// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/compare.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/file.h"
#include "core/parallel.h"
#include "core/rounding.h"
#include "core/srgb.h"
#include "image/difference_of.h"
#include "image/flip.h"
#include "image/name_size.h"
#include "promin/error.h"

namespace promin {
namespace {

void check_sizes(const Image& reference, const Image& test) {
  if (reference.size != test.size) {
    throw InputError(
        {"picture.pair.sizes",
         "the pictures have different sizes, " + name_size(reference.size) + " and " + name_size(test.size), "",
         "render both at the same size"});
  }
  if (reference.pixels.empty()) {
    throw InputError({"picture.empty", "the pictures have no pixels (" + name_size(reference.size) + ")", "",
                      "give pictures with pixels"});
  }
}

/// The sums of one row. The total is computed from the rows in order, so it does not depend on the number of threads.
struct RowDifference {
  double sum = 0.0;
  double squares = 0.0;
  uint64_t finite = 0;
  double largest = 0.0;
  uint32_t largest_x = 0;
  uint64_t different = 0;
};

RowDifference compare_rows(const Image& reference, const Image& test, uint32_t y, double fail) {
  RowDifference row;
  for (uint32_t x = 0; x < reference.size.x; ++x) {
    const vec3& a = reference.at(x, y);
    const vec3& b = test.at(x, y);
    double largest = 0.0;
    for (int i = 0; i < 3; ++i) {
      largest = std::max(largest, difference_of(static_cast<double>(a[i]), static_cast<double>(b[i])));
    }
    if (largest > row.largest) {
      row.largest = largest;
      row.largest_x = x;
    }
    row.different += largest > fail ? 1 : 0;
    if (!is_finite(a) || !is_finite(b)) continue;
    ++row.finite;
    for (int i = 0; i < 3; ++i) {
      const double difference = difference_of(static_cast<double>(a[i]), static_cast<double>(b[i]));
      row.sum += difference;
      row.squares += difference * difference;
    }
  }
  return row;
}

Image to_linear(const Image& picture) {
  Image linear = picture;
  for_each_chunk(linear.pixels.size(), size_t{1} << 16, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      for (int c = 0; c < 3; ++c) {
        linear.pixels[i][c] = static_cast<float>(srgb_to_linear(static_cast<double>(linear.pixels[i][c])));
      }
    }
  });
  return linear;
}

}  // namespace

PictureEncoding encoding_of(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  constexpr std::array kLinearEndings = {".exr", ".hdr", ".pfm"};
  const bool is_linear = std::ranges::find(kLinearEndings, ending) != kLinearEndings.end();
  return is_linear ? PictureEncoding::kLinear : PictureEncoding::kSrgb;
}

PictureDifference compare_pictures(const Image& reference, const Image& test, const CompareChoice& choice) {
  check_sizes(reference, test);
  std::vector<RowDifference> rows(reference.size.y);
  for_each_index(rows.size(), 0,
                 [&](size_t y) { rows[y] = compare_rows(reference, test, static_cast<uint32_t>(y), choice.fail); });
  PictureDifference result;
  result.pixel_count = reference.pixels.size();
  result.non_finite_count = result.pixel_count;
  double squares = 0.0;
  for (size_t y = 0; y < rows.size(); ++y) {
    const RowDifference& row = rows[y];
    result.mean += row.sum;
    squares += row.squares;
    result.non_finite_count -= row.finite;
    result.different_count += row.different;
    if (row.largest > result.largest) {
      result.largest = row.largest;
      result.largest_at = uvec2(row.largest_x, y);
    }
  }
  const double numbers = 3.0 * static_cast<double>(result.pixel_count - result.non_finite_count);
  if (numbers > 0.0) {
    result.mean /= numbers;
    result.rmse = std::sqrt(squares / numbers);
  }
  result.psnr_db = result.rmse > 0.0 ? -20.0 * std::log10(result.rmse) : std::numeric_limits<double>::infinity();
  const bool is_linear = choice.encoding == PictureEncoding::kLinear;
  result.flip_map = is_linear ? flip_map(reference, test, choice.pixels_per_degree)
                              : flip_map(to_linear(reference), to_linear(test), choice.pixels_per_degree);
  for (const float error : result.flip_map) result.flip += static_cast<double>(error);
  result.flip /= static_cast<double>(result.pixel_count);
  return result;
}

}  // namespace promin
