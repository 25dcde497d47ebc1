// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/jobs/compare_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <variant>

#include "core/rounding.h"
#include "promin/error.h"
#include "shapes/shapes.h"

namespace promin::work {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns the difference of two numbers, relative for numbers beyond 1. It is infinite if the numbers are not finite
/// and not equal.
double difference_of(float a, float b) {
  if (std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (std::isnan(a) && std::isnan(b))) return 0.0;
  const double difference = std::abs(double{a} - double{b}) / std::max(1.0, std::abs(double{a}));
  return std::isfinite(difference) ? difference : kInfinity;
}

double difference_of(const vec3& a, const vec3& b) {
  return std::max({difference_of(a.x, b.x), difference_of(a.y, b.y), difference_of(a.z, b.z)});
}

double difference_of(const Channel& a, const Channel& b, size_t i) {
  if (a.is_integer) return a.values[i] == b.values[i] ? 0.0 : kInfinity;
  return difference_of(std::bit_cast<float>(a.values[i]), std::bit_cast<float>(b.values[i]));
}

void count(PieceDifference& difference, double value, double most) {
  ++difference.count;
  if (value <= most) {
    difference.largest = std::max(difference.largest, value);
  } else {
    ++difference.mismatches;
  }
}

/// Returns the box of a primitive that was hit.
Bounds bounds_of_part(const world::Scene& scene, uint32_t object, uint32_t primitive) {
  const auto instance = std::ranges::lower_bound(scene.instances, object, {}, &world::Instance::object);
  if (instance != scene.instances.end() && instance->object == object) {
    const Mesh& mesh = scene.meshes[instance->mesh];
    if (primitive >= mesh.triangles.size()) return {};
    const Bounds box = world::bounds_of_triangle(mesh, primitive);
    return world::bounds_of(instance->map, {&box, 1});
  }
  const auto find = [&](const auto& some) -> Bounds {
    using Some = std::decay_t<decltype(some)>;
    if constexpr (std::is_same_v<Some, world::Mesh>) {
      return primitive < some.triangles.size() ? world::bounds_of_triangle(some, primitive) : Bounds();
    } else if constexpr (std::is_same_v<Some, world::NotDrawn> || std::is_same_v<Some, world::Plane>) {
      return {};
    } else {
      return promin::bounds_of(some);
    }
  };
  return std::visit(find, scene.objects[object].shape);
}

}  // namespace

PieceDifference compare_parts(const PicturePart& there, const PicturePart& anew, const std::filesystem::path& file) {
  const auto is_same_channel = [](const Channel& a, const Channel& b) {
    return a.name == b.name && a.is_integer == b.is_integer;
  };
  if (there.image.size != anew.image.size || !std::ranges::equal(there.channels, anew.channels, is_same_channel)) {
    throw InputError({"job.piece.other", "the piece is not the expected part of the picture", file.string(),
                      "remove it and run the job again"});
  }
  PieceDifference difference;
  for (size_t i = 0; i < there.image.pixels.size(); ++i) {
    double of_pixel = difference_of(there.image.pixels[i], anew.image.pixels[i]);
    for (size_t k = 0; k < there.channels.size(); ++k) {
      of_pixel = std::max(of_pixel, difference_of(there.channels[k], anew.channels[k], i));
    }
    count(difference, of_pixel, kMostPixelDifference);
  }
  return difference;
}

HitComparison::HitComparison(const Scene& scene)
    : scene_(world::flatten(scene, world::Purpose::kHits, Instancing::kAuto)) {}

void HitComparison::compare(std::span<const Ray> rays, std::span<const Hit> there, std::span<const Hit> anew) {
  for (size_t i = 0; i < rays.size(); ++i) take(difference_of(rays[i], there[i], anew[i]));
}

void HitComparison::compare_lists(const Ray& ray, std::span<const Hit> there, std::span<const Hit> anew) {
  double largest = there.size() == anew.size() ? 0.0 : kInfinity;
  for (size_t i = 0; i < std::min(there.size(), anew.size()); ++i) {
    largest = std::max(largest, difference_of(ray, there[i], anew[i]));
  }
  take(largest);
}

void HitComparison::compare(std::span<const int32_t> there, std::span<const int32_t> anew) {
  for (size_t i = 0; i < there.size(); ++i) take(there[i] == anew[i] ? 0.0 : kInfinity);
}

double HitComparison::difference_of(const Ray& ray, const Hit& there, const Hit& anew) const {
  if (there.object != anew.object || there.primitive != anew.primitive) return kInfinity;
  if (there.t == anew.t) return 0.0;
  const double scale = scale_of(ray, there);
  // The product |d| cos is the component of the direction along the normal.
  const double along = std::abs(glm::dot(dvec3(ray.direction), dvec3(there.normal)));
  const double k = std::abs(double{there.t} - double{anew.t}) * along / (kUnitRoundoff * scale);
  return std::isfinite(k) ? k : kInfinity;
}

double HitComparison::scale_of(const Ray& ray, const Hit& hit) const {
  if (static_cast<uint32_t>(hit.object) >= scene_.objects.size()) return 0.0;
  const dvec3 origin(ray.origin);
  const world::Shape& shape = scene_.objects[static_cast<uint32_t>(hit.object)].shape;
  if (const auto* plane = std::get_if<world::Plane>(&shape)) {
    return glm::distance(origin, dvec3(plane->point)) + std::abs(double{hit.t}) * glm::length(dvec3(ray.direction));
  }
  const Bounds box = bounds_of_part(scene_, static_cast<uint32_t>(hit.object), static_cast<uint32_t>(hit.primitive));
  if (box.is_empty()) return 0.0;
  return glm::distance(origin, dvec3(box.center())) + 0.5 * glm::distance(dvec3(box.lo), dvec3(box.hi));
}

void HitComparison::take(double difference) {
  count(difference_, difference, kMostK);
}

}  // namespace promin::work
