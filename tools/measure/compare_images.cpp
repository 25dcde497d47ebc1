// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "measure/compare_images.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "core/rounding.h"
#include "promin/error.h"

namespace promin {
namespace {

std::string name_size(const Image& image) {
  return std::to_string(image.size.x) + "x" + std::to_string(image.size.y);
}

void require_same_size(const Image& a, const Image& b) {
  if (a.size != b.size) {
    throw InputError({"picture.pair.sizes", "the pictures have different sizes",
                      name_size(a) + " against " + name_size(b), "render both at the same size"});
  }
  if (a.pixels.empty())
    throw InputError({"picture.empty", "the pictures have no pixels", name_size(a), "render them again"});
}

/// Returns whether a pixel lies between the least and the largest value of a picture at and around it, to within
/// `slack`.
bool is_between_neighbours(const Image& picture, uint32_t x, uint32_t y, const vec3& pixel, float slack) {
  vec3 lo = picture.at(x, y);
  vec3 hi = lo;
  for (uint32_t j = y == 0 ? 0 : y - 1; j <= std::min(y + 1, picture.size.y - 1); ++j) {
    for (uint32_t i = x == 0 ? 0 : x - 1; i <= std::min(x + 1, picture.size.x - 1); ++i) {
      lo = glm::min(lo, picture.at(i, j));
      hi = glm::max(hi, picture.at(i, j));
    }
  }
  return glm::all(glm::greaterThanEqual(pixel, lo - slack)) && glm::all(glm::lessThanEqual(pixel, hi + slack));
}

OIIO::ImageBuf as_image_buf(Image& image) {
  const OIIO::ImageSpec spec(static_cast<int>(image.size.x), static_cast<int>(image.size.y), 3, OIIO::TypeDesc::FLOAT);
  return {spec, image.pixels.data()};
}

bool is_worse(const PixelDifference& a, const PixelDifference& b) {
  if (a.difference != b.difference) return a.difference > b.difference;
  return a.pixel.y != b.pixel.y ? a.pixel.y < b.pixel.y : a.pixel.x < b.pixel.x;
}

}  // namespace

double ImageDifference::percent_of(uint64_t count) const {
  return pixel_count == 0 ? 0.0 : 100.0 * static_cast<double>(count) / static_cast<double>(pixel_count);
}

std::string ImageDifference::summary() const {
  char line[256];
  std::snprintf(line, sizeof line,
                "%s: mean %.3g, largest %.3g, failed pixels %llu (%.4g %%), not finite %llu, on edges %llu",
                is_equal ? "equal" : "different", mean_absolute, static_cast<double>(largest),
                static_cast<unsigned long long>(failed_count), failed_percent(),
                static_cast<unsigned long long>(non_finite_count), static_cast<unsigned long long>(edge_count));
  std::string text = line;
  for (const PixelDifference& each : worst) {
    std::snprintf(line, sizeof line, "\n  pixel (%u, %u) differs by %.6g", each.pixel.x, each.pixel.y,
                  static_cast<double>(each.difference));
    text += line;
  }
  return text;
}

ImageDifference compare_images(const Image& a, const Image& b, const CompareOptions& options) {
  require_same_size(a, b);
  ImageDifference result;
  result.pixel_count = a.pixels.size();
  // OpenImageIO does not treat edges differently, and takes a NaN in both pictures as equal. Therefore this function
  // counts such pixels, and makes them black or equal for OpenImageIO.
  Image first = a;
  Image second = b;
  std::vector<PixelDifference> differing;
  for (uint32_t y = 0; y < a.size.y; ++y) {
    for (uint32_t x = 0; x < a.size.x; ++x) {
      float difference = max_abs_component(a.at(x, y) - b.at(x, y));
      if (!is_finite(a.at(x, y)) || !is_finite(b.at(x, y))) {
        ++result.non_finite_count;
        difference = std::numeric_limits<float>::infinity();
        first.at(x, y) = second.at(x, y) = vec3(0.0F);
      } else if (options.edge_percent > 0.0 && difference > options.fail &&
                 is_between_neighbours(b, x, y, a.at(x, y), options.fail)) {
        ++result.edge_count;
        difference = 0.0F;
        first.at(x, y) = b.at(x, y);
      }
      if (difference > 0.0F) differing.push_back({uvec2(x, y), difference});
    }
  }
  const auto found = OIIO::ImageBufAlgo::compare(as_image_buf(first), as_image_buf(second), options.fail, options.fail);
  result.failed_count = found.nfail + result.non_finite_count;
  result.largest =
      result.non_finite_count > 0 ? std::numeric_limits<float>::infinity() : static_cast<float>(found.maxerror);
  const uint64_t finite_count = result.pixel_count - result.non_finite_count;
  if (finite_count > 0) {
    result.mean_absolute =
        found.meanerror * (static_cast<double>(result.pixel_count) / static_cast<double>(finite_count));
  }

  const size_t listed = std::min(options.worst_count, differing.size());
  std::partial_sort(differing.begin(), differing.begin() + static_cast<std::ptrdiff_t>(listed), differing.end(),
                    is_worse);
  differing.resize(listed);
  result.worst = std::move(differing);
  result.is_equal = result.non_finite_count == 0 && result.largest <= options.hard_fail &&
                    result.failed_percent() <= options.fail_percent &&
                    result.percent_of(result.edge_count) <= options.edge_percent;
  return result;
}

void write_difference_image(const std::filesystem::path& file, const Image& a, const Image& b, float gain) {
  require_same_size(a, b);
  Image difference;
  difference.size = a.size;
  difference.pixels.reserve(a.pixels.size());
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const bool is_comparable = is_finite(a.pixels[i]) && is_finite(b.pixels[i]);
    difference.pixels.push_back(is_comparable ? glm::abs(a.pixels[i] - b.pixels[i]) * gain : vec3(1.0F, 0.0F, 1.0F));
  }
  write_image(file, difference);
}

}  // namespace promin
