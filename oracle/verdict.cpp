// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/verdict.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>
#include <vector>

namespace promin::oracle {
namespace {

/// The range in which margins are searched, in units of u S. A smaller margin counts as none; a larger one cannot come
/// from rounding.
constexpr Real kLeastMargin = 0x1p-10L;
constexpr Real kMostMargin = 0x1p24L;

/// An interval of t. By default it lies at infinity, where no hit is reported.
struct Interval {
  Real lo = kInfinity;
  Real hi = kInfinity;
};

/// The kind of boundary where a line crosses the hull of a shape.
enum class Wall { kSurface, kNothing, kEither };

/// The intervals of t in which a ray's line may cross a primitive whose surface is displaced by up to an allowance.
struct Reach {
  /// Where the line may enter a solid, or cross a flat primitive.
  Interval entry;
  /// Where the line may leave a solid.
  Interval exit;
  /// For an open shape, the kind of boundary at the entry and at the exit: the side, or a missing disk.
  Wall entry_wall = Wall::kSurface;
  Wall exit_wall = Wall::kSurface;
  /// True if the line crosses the primitive for every displacement of the surface.
  bool is_certain = false;
};

/// A primitive and a ray's line. Along the line, the distance to a convex primitive is a convex function: it decreases
/// up to `deepest_` and then increases. The intersection with the primitive enlarged by x begins and ends where the
/// distance is x.
class Body {
 public:
  Body(const world::Shape& shape, int32_t primitive, const Ray& ray)
      : shape_(shape),
        primitive_(primitive),
        ray_(ray),
        speed_(glm::length(ray.direction)),
        scale_(scale_of(shape, primitive, ray)),
        plane_(std::get_if<world::Plane>(&shape)) {
    if (plane_ != nullptr) return;
    const BoundingSphere bound = bounding_sphere(shape, primitive);
    size_ = bound.radius;
    t_closest_ = glm::dot(bound.center - ray.origin, ray.direction) / (speed_ * speed_);
    closest_ = ray.origin + t_closest_ * ray.direction;
    find_deepest();
    depth_ = -distance_at(deepest_);
    if (const Mesh* mesh = std::get_if<Mesh>(&shape)) depth_ = depth_in_outline(*mesh);
  }

  /// Returns whether the line intersects the primitive, regardless of the ray's ends.
  bool is_met() const { return plane_ != nullptr || depth_ > 0; }

  bool is_entry(Real t) const { return is_flat() || t <= t_of(deepest_); }

  /// Returns the intervals for an allowance in units of u S.
  Reach reach(Real allowance) const {
    if (plane_ != nullptr) return reach_plane(allowance * kRoundoff);
    const Real offset = allowance * kRoundoff * scale_;
    Reach result;
    if (distance_at(deepest_) > offset) return result;
    result.is_certain = depth_ > offset;
    const Interval grown = interval_within(offset);
    if (is_flat()) {
      result.entry = grown;
      return result;
    }
    const Interval shrunk = result.is_certain ? interval_within(-offset) : Interval{t_of(deepest_), t_of(deepest_)};
    result.entry = {grown.lo, shrunk.lo};
    result.exit = {shrunk.hi, grown.hi};
    result.entry_wall = wall_at(result.entry, offset);
    result.exit_wall = wall_at(result.exit, offset);
    return result;
  }

 private:
  /// Returns the kind of boundary in an interval. Both functions of PlaceInFrustum are convex along the line, so they
  /// are largest at the interval's ends.
  Wall wall_at(const Interval& interval, Real offset) const {
    const auto place_at = [&](Real t) { return place_in_open(shape_, ray_.origin + t * ray_.direction); };
    const std::optional<PlaceInFrustum> lo = place_at(interval.lo);
    const std::optional<PlaceInFrustum> hi = place_at(interval.hi);
    if (!lo || !hi) return Wall::kSurface;
    if (std::max(lo->beyond_ends, hi->beyond_ends) < -offset) return Wall::kSurface;
    return std::max(lo->beyond_side, hi->beyond_side) < -offset ? Wall::kNothing : Wall::kEither;
  }

  bool is_flat() const { return plane_ != nullptr || std::holds_alternative<Mesh>(shape_); }

  // Returns t for `s`, the length along the line from the point that is closest to the centre. All crossings are near s
  // = 0.
  Real t_of(Real s) const { return t_closest_ + s / speed_; }
  Real distance_at(Real s) const { return signed_distance(shape_, primitive_, closest_ + s / speed_ * ray_.direction); }

  void find_deepest() {
    Real lo = -size_;
    Real hi = size_;
    for (int i = 0; i < 110; ++i) {  // (2/3)^110 is below the roundoff of Real.
      const Real third = (hi - lo) / 3;
      if (distance_at(lo + third) <= distance_at(hi - third)) {
        hi -= third;
      } else {
        lo += third;
      }
    }
    deepest_ = (lo + hi) / 2;
  }

  /// Returns the interval of t in which the distance is at most `offset`. It contains `deepest_` and ends within size_
  /// + offset.
  Interval interval_within(Real offset) const {
    const auto find_end = [&](Real outside) {
      Real inside = deepest_;
      for (int i = 0; i < 80; ++i) {
        const Real middle = (inside + outside) / 2;
        (distance_at(middle) <= offset ? inside : outside) = middle;
      }
      return t_of(inside);
    };
    const Real far = size_ + std::max(offset, Real(0));
    return {find_end(-far), find_end(far)};
  }

  /// Returns the distance of the line from a triangle's edges, seen along the line; positive inside, 0 outside.
  Real depth_in_outline(const Mesh& mesh) const {
    const glm::uvec3& corners = mesh.triangles[static_cast<size_t>(primitive_)];
    const Vector along = ray_.direction / speed_;
    std::array<Vector, 3> seen;
    for (int i = 0; i < 3; ++i) {
      const Vector from_line = Vector(mesh.positions[corners[i]]) - closest_;
      seen[static_cast<size_t>(i)] = from_line - glm::dot(from_line, along) * along;
    }
    Real depth = kInfinity;
    int turns = 0;
    for (size_t i = 0; i < 3; ++i) {
      const Vector& a = seen[i];
      const Vector& b = seen[(i + 1) % 3];
      turns += glm::dot(glm::cross(a, b), along) > 0 ? 1 : -1;
      depth = std::min(depth, distance_to_segment(Vector(0), a, b));
    }
    return std::abs(turns) == 3 ? depth : 0;
  }

  /// Returns the interval of t >= 0 with |n.(o - q) + t n.d| <= e (|o - q| + t |d|). The origin is on the positive
  /// side.
  Reach reach_plane(Real e) const {
    const Vector n = glm::normalize(Vector(plane_->normal));
    const Real signed_height = glm::dot(n, ray_.origin - Vector(plane_->point));
    const Real height = std::abs(signed_height);
    const Real fall = glm::dot(n, ray_.direction) * (signed_height < 0 ? 1 : -1);
    Reach result;
    const Real first_fall = fall + e * speed_;
    const Real last_fall = fall - e * speed_;
    if (height <= e * scale_) {
      result.entry.lo = 0;
    } else if (first_fall > 0) {
      result.entry.lo = (height - e * scale_) / first_fall;
    } else {
      return result;
    }
    result.is_certain = last_fall > 0;
    result.entry.hi = result.is_certain ? (height + e * scale_) / last_fall : kInfinity;
    return result;
  }

  const world::Shape& shape_;
  int32_t primitive_;
  const Ray& ray_;
  Real speed_;
  Real scale_;
  const world::Plane* plane_;
  Real size_ = 0;
  Real t_closest_ = 0;
  Vector closest_{0};
  Real deepest_ = 0;
  /// The displacement by which a solid would have to shrink, or a triangle's edges to move, for the line to miss it.
  Real depth_ = 0;
};

/// Returns the last t at which the ray may report the primitive; infinite if the ray need not report it.
Real latest_report(const Reach& reach, const Ray& ray) {
  if (!reach.is_certain) return kInfinity;
  const bool must_enter = reach.entry_wall == Wall::kSurface && reach.entry.lo > ray.tmin;
  const bool must_leave = reach.exit_wall == Wall::kSurface && reach.exit.lo > ray.tmin;
  const Real t = must_enter ? reach.entry.hi : must_leave ? reach.exit.hi : kInfinity;
  return t < ray.tmax ? t : kInfinity;
}

/// Returns the first t at which the ray may report this end of the primitive; infinite if it cannot report it.
Real earliest_report(const Reach& reach, bool is_entry, const Ray& ray) {
  const bool may_skip_entry = !reach.is_certain || reach.entry.lo <= ray.tmin || reach.entry_wall != Wall::kSurface;
  if (!is_entry && !may_skip_entry) return kInfinity;
  if ((is_entry ? reach.entry_wall : reach.exit_wall) == Wall::kNothing) return kInfinity;
  const Interval& end = is_entry ? reach.entry : reach.exit;
  const Real t = std::max(end.lo, ray.tmin);
  return end.hi > ray.tmin && t < ray.tmax ? t : kInfinity;
}

/// Returns the smallest allowance for which `answer` may be true. `is_hit` is true if the answer names a primitive that
/// can be hit.
Real find_margin(const world::Scene& scene, const Ray& ray, const Answer& answer, bool is_hit) {
  std::vector<Body> others;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const world::Shape& shape = scene.objects[i].shape;
    for (uint32_t j = 0; j < primitive_count(shape); ++j) {
      const Answer other{0, static_cast<int32_t>(i), static_cast<int32_t>(j)};
      if (is_hit && other.object == answer.object && other.primitive == answer.primitive) continue;
      if (!is_hittable(shape, other.primitive)) continue;
      const BoundingSphere bound = bounding_sphere(shape, other.primitive);
      const Real distance =
          glm::length(glm::cross(bound.center - ray.origin, ray.direction)) / glm::length(ray.direction);
      if (distance > bound.radius && !std::holds_alternative<world::Plane>(shape)) continue;
      if (const Body body(shape, other.primitive, ray); body.is_met()) others.push_back(body);
    }
  }
  const auto is_possible = [&](Real allowance) {
    Real reported = ray.tmax;
    if (is_hit) {
      const Body body(scene.objects[static_cast<size_t>(answer.object)].shape, answer.primitive, ray);
      reported = earliest_report(body.reach(allowance), body.is_entry(answer.t), ray);
      if (reported == kInfinity) return false;
    }
    return std::all_of(others.begin(), others.end(),
                       [&](const Body& other) { return latest_report(other.reach(allowance), ray) >= reported; });
  };
  Real no = kLeastMargin;
  Real yes = kMostMargin;
  if (is_possible(no)) return 0;
  if (!is_possible(yes)) return kInfinity;
  while (yes / no > 1 + 1e-9L) {
    const Real middle = std::sqrt(yes * no);
    (is_possible(middle) ? yes : no) = middle;
  }
  return yes;
}

/// Returns a length divided by u S. A length of 0 gives 0 even if S is 0.
Real in_units(Real length, Real scale) {
  return length == 0 ? 0 : length / (kRoundoff * scale);
}

/// Returns how far o + t d lies beyond a triangle's corners, along the ray. Rounding may give wrong weights of the
/// corners, more so for thin triangles, but the point is a weighted mean of the corners.
Real distance_beyond_corners(const Mesh& mesh, int32_t triangle, const Ray& ray, Real t) {
  Real lo = kInfinity;
  Real hi = -kInfinity;
  const Real speed = glm::length(ray.direction);
  const glm::uvec3& corners = mesh.triangles[static_cast<size_t>(triangle)];
  for (int i = 0; i < 3; ++i) {
    const Real s = glm::dot(Vector(mesh.positions[corners[i]]) - ray.origin, ray.direction) / speed;
    lo = std::min(lo, s);
    hi = std::max(hi, s);
  }
  return std::max({Real(0), lo - t * speed, t * speed - hi});
}

bool names_hittable(const world::Scene& scene, const Answer& answer) {
  return answer.object >= 0 && static_cast<size_t>(answer.object) < scene.objects.size() &&
         is_hittable(scene.objects[static_cast<size_t>(answer.object)].shape, answer.primitive);
}

}  // namespace

Verdict judge(const world::Scene& scene, const Ray& ray, const Answer& answer) {
  return judge(scene, ray, find_nearest_hit(scene, ray), answer);
}

Verdict judge(const world::Scene& scene, const Ray& given_ray, const Hit& exact, const Answer& answer) {
  Ray ray = given_ray;
  ray.tmin = std::max(Real(0), given_ray.tmin);
  Verdict verdict;
  verdict.exact = exact;
  if (answer.object == -1) {
    verdict.is_same = !exact.exists();
    if (!verdict.is_same) verdict.margin = find_margin(scene, ray, answer, false);
    return verdict;
  }
  if (!can_hit(given_ray) || !names_hittable(scene, answer) || !std::isfinite(answer.t)) {
    verdict.t_error = verdict.surface_error = verdict.margin = kInfinity;
    return verdict;
  }

  const world::Shape& shape = scene.objects[static_cast<size_t>(answer.object)].shape;
  const Real speed = glm::length(ray.direction);
  const Real scale = scale_of(shape, answer.primitive, ray);
  const bool is_plane = std::holds_alternative<world::Plane>(shape);
  const Mesh* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr) {
    const Real off = surface_distance(shape, answer.primitive, ray.origin + answer.t * ray.direction);
    verdict.surface_error = in_units(off, scale + (is_plane ? std::abs(answer.t) * speed : 0));
  }
  if (exact.object == answer.object && exact.primitive == answer.primitive) {
    const Real error = std::abs((answer.t - exact.t) * glm::dot(ray.direction, exact.normal));
    verdict.t_error = in_units(error, scale + (is_plane ? exact.t * speed : 0));
    verdict.is_same = verdict.t_error <= kB1;
    if (!verdict.is_same) {
      const Body body(shape, answer.primitive, ray);
      verdict.is_same = body.is_entry(answer.t) == body.is_entry(exact.t);
    }
    if (verdict.is_same) return verdict;
    verdict.t_error = 0;
  }

  verdict.margin = find_margin(scene, ray, answer, true);
  const Real off_primitive = mesh == nullptr
                                 ? verdict.surface_error
                                 : in_units(distance_beyond_corners(*mesh, answer.primitive, ray, answer.t), scale);
  if (off_primitive > kBK) verdict.margin = std::max(verdict.margin, off_primitive);
  return verdict;
}

}  // namespace promin::oracle
