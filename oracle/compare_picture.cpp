// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/compare_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <variant>

#include "core/rounding.h"
#include "oracle/normal_error.h"

namespace promin::oracle {
namespace {

/// Returns whether a material may have a mirror ray.
struct IsMirror {
  bool operator()(const Phong& phong) const { return max_component(phong.reflection) > 0.0F; }
  bool operator()(const MetallicRoughness& material) const { return material.roughness < 0.4F; }
  bool operator()(const Unlit&) const { return false; }
};

/// Returns the distance from the ray to the nearest crease around its hit. Near the hit the distance decreases and then
/// increases, so a search by thirds finds the minimum. If it did otherwise, the result would be too large and not too
/// small.
Real distance_from_crease(const world::Shape& shape, const Ray& ray, const Hit& hit) {
  const Real reach = 0.01L * bounding_sphere(shape, hit.primitive).radius / glm::length(ray.direction);
  Real lo = hit.t - reach;
  Real hi = hit.t + reach;
  const auto distance_at = [&](Real t) { return distance_to_crease(shape, ray.origin + t * ray.direction); };
  for (int i = 0; i < 100; ++i) {
    const Real third = (hi - lo) / 3;
    if (distance_at(lo + third) <= distance_at(hi - third)) {
      hi -= third;
    } else {
      lo += third;
    }
  }
  return distance_at((lo + hi) / 2);
}

class Comparison {
 public:
  Comparison(const world::Scene& scene, const Picture& expected, const Image& image, const DeviceAovs& aovs,
             const PictureBounds& bounds)
      : scene_(scene), expected_(expected), image_(image), aovs_(aovs) {
    report_.bounds = bounds;
    report_.pixel_count = expected.pixels.size();
    report_.has_mirrors = std::ranges::any_of(
        scene.materials, [](const Material& material) { return std::visit(IsMirror(), material.model); });
  }

  PictureReport run() {
    for (uint32_t y = 0; y < expected_.size.y; ++y) {
      for (uint32_t x = 0; x < expected_.size.x; ++x) {
        at_ = uvec2(x, y);
        index_ = static_cast<size_t>(y) * expected_.size.x + x;
        if (!is_finite_here()) {
          report_.non_finite.push_back(at_);
          continue;
        }
        compare_color();
        if (!aovs_.object.empty() && !expected_.pixels[index_].is_at_cutoff) compare_hit();
      }
    }
    if (color_count_ > 0) report_.color_mean = color_sum_ / (3 * static_cast<Real>(color_count_));
    const uint64_t sure_count = color_count_ - report_.unsure_count;
    if (sure_count > 0) report_.plain_mean = plain_sum_ / (3 * static_cast<Real>(sure_count));
    return std::move(report_);
  }

 private:
  bool is_finite_here() const {
    if (!is_finite(image_.pixels[index_])) return false;
    if (aovs_.object.empty()) return true;
    const bool is_miss = aovs_.object[index_] == kNoObject;
    const float depth = aovs_.depth[index_];
    return is_finite(aovs_.normal[index_]) && (is_miss ? depth == kInfinity : std::isfinite(depth));
  }

  void compare_color() {
    const Pixel& pixel = expected_.pixels[index_];
    const Vector difference = glm::abs(Vector(image_.pixels[index_]) - pixel.color);
    const Vector unexplained = glm::max(difference - pixel.explained_error - pixel.map_error, Vector(0));
    const Real error = largest(unexplained);
    if (error > report_.bounds.color_error) report_.color_errors.push_back({at_, error});
    color_sum_ += unexplained.x + unexplained.y + unexplained.z;
    ++color_count_;
    if (pixel.explained_error > report_.bounds.color_error) {
      ++report_.unsure_count;
      return;
    }
    plain_sum_ += difference.x + difference.y + difference.z;
    report_.plain_largest = std::max({report_.plain_largest, difference.x, difference.y, difference.z});
  }

  void compare_hit() {
    const Pixel& pixel = expected_.pixels[index_];
    const Real t = aovs_.depth[index_] / glm::length(pixel.ray.direction);
    // The conversion changes kNoObject to -1.
    const Answer answer{t, static_cast<int32_t>(aovs_.object[index_]), static_cast<int32_t>(aovs_.primitive[index_])};
    const Verdict verdict = judge(scene_, pixel.ray, pixel.hit, answer);
    if (!verdict.is_same) {
      report_.id_mismatches.push_back({at_, pixel.hit, answer, verdict.margin});
      return;
    }
    report_.largest_depth_error = std::max(report_.largest_depth_error, verdict.t_error);
    if (verdict.t_error > report_.bounds.depth_error) report_.depth_errors.push_back({at_, verdict.t_error});
    if (pixel.hit.exists()) compare_normal(pixel);
  }

  void compare_normal(const Pixel& pixel) {
    const world::Shape& shape = scene_.objects[static_cast<size_t>(pixel.hit.object)].shape;
    const Real error = glm::distance(Vector(aovs_.normal[index_]), pixel.hit.normal) /
                       allowed_normal_error(shape, pixel.ray, pixel.hit);
    if (error > 1) {
      const Real crease = distance_from_crease(shape, pixel.ray, pixel.hit);
      const Real unit = kRoundoff * scale_of(shape, pixel.hit.primitive, pixel.ray);
      if (crease <= report_.bounds.id_margin * unit) {
        report_.normals_at_creases.push_back({at_, error});
        return;
      }
      report_.normal_errors.push_back({at_, error});
    }
    report_.largest_normal_error = std::max(report_.largest_normal_error, error);
  }

  const world::Scene& scene_;
  const Picture& expected_;
  const Image& image_;
  const DeviceAovs& aovs_;
  PictureReport report_;
  uvec2 at_{0};
  size_t index_ = 0;
  Real color_sum_ = 0;
  Real plain_sum_ = 0;
  uint64_t color_count_ = 0;
};

template <typename... Values>
std::string format(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

std::string name_hit(const world::Scene& scene, int32_t object, int32_t primitive) {
  if (object < 0) return "a miss";
  const bool exists = static_cast<size_t>(object) < scene.objects.size();
  const std::string name = exists ? scene.objects[static_cast<size_t>(object)].name : "none such";
  return "object " + std::to_string(object) + " '" + name + "' primitive " + std::to_string(primitive);
}

std::string name_pixel(const uvec2& pixel) {
  return format("\n  pixel (%u, %u)", pixel.x, pixel.y);
}

/// Returns the title of a list and its first lines.
template <typename Item, typename Describe>
std::string list(const std::string& title, const std::vector<Item>& items, size_t most_lines, Describe describe) {
  if (items.empty()) return "";
  std::string text = format("\n%zu ", items.size()) + title + ":";
  for (size_t i = 0; i < std::min(items.size(), most_lines); ++i) text += describe(items[i]);
  if (items.size() > most_lines) text += "\n  ...";
  return text;
}

}  // namespace

bool PictureReport::passes() const {
  const auto count = static_cast<double>(pixel_count);
  const double color_share = has_mirrors ? bounds.color_share_with_mirrors : bounds.color_share;
  const bool are_ids_explained = std::all_of(id_mismatches.begin(), id_mismatches.end(),
                                             [&](const IdMismatch& each) { return each.margin <= bounds.id_margin; });
  return non_finite.empty() && are_ids_explained &&
         static_cast<double>(id_mismatches.size()) <= bounds.id_share * count && depth_errors.empty() &&
         normal_errors.empty() && static_cast<double>(normals_at_creases.size()) <= bounds.id_share * count &&
         static_cast<double>(color_errors.size()) <= color_share * count && color_mean <= bounds.color_mean &&
         plain_mean <= bounds.plain_mean && static_cast<double>(unsure_count) <= bounds.unsure_share * count;
}

std::string PictureReport::summary(const world::Scene& scene, size_t most_lines) const {
  std::string text = passes() ? "passes" : "fails";
  text += format(
      ": %llu pixels, largest error of depth %.3Lg u S, of normals %.3Lg of what is allowed; mean of colour "
      "%.3Lg; of sure pixels with what is explained mean %.3Lg, largest %.3Lg; %llu unsure",
      static_cast<unsigned long long>(pixel_count), largest_depth_error, largest_normal_error, color_mean, plain_mean,
      plain_largest, static_cast<unsigned long long>(unsure_count));
  const auto name_error = [](const PixelError& each) { return name_pixel(each.pixel) + format(": %.4Lg", each.error); };
  text += list("pixels not finite", non_finite, most_lines, name_pixel);
  text += list("pixels of another primitive", id_mismatches, most_lines, [&](const IdMismatch& each) {
    return name_pixel(each.pixel) + ": " + name_hit(scene, each.got.object, each.got.primitive) + ", not " +
           name_hit(scene, each.expected.object, each.expected.primitive) + format("; margin %.4Lg u S", each.margin);
  });
  text += list("depths beyond the bound, in u S", depth_errors, most_lines, name_error);
  text += list("normals beyond the bound, in units of it", normal_errors, most_lines, name_error);
  text += list("normals from across a crease", normals_at_creases, most_lines, name_error);
  text += list("pixels of another colour", color_errors, most_lines, name_error);
  return text;
}

PictureReport compare_picture(const world::Scene& scene, const Picture& expected, const Image& image,
                              const DeviceAovs& aovs, const PictureBounds& bounds) {
  const size_t count = expected.pixels.size();
  const bool has_aovs = !aovs.object.empty();
  const bool is_complete = aovs.depth.size() == count && aovs.normal.size() == count && aovs.object.size() == count &&
                           aovs.primitive.size() == count;
  if (image.size != expected.size || image.pixels.size() != count || (has_aovs && !is_complete)) {
    throw std::invalid_argument("the pictures have different sizes");
  }
  return Comparison(scene, expected, image, aovs, bounds).run();
}

}  // namespace promin::oracle
