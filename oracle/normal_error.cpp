// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/normal_error.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "oracle/distance.h"

namespace promin::oracle {
namespace {

struct Curvature {
  const Vector& point;
  const Vector& normal;

  template <typename Flat>
  Real operator()(const Flat&) const {
    return kInfinity;
  }
  Real operator()(const world::Sphere& s) const { return s.radius; }
  Real operator()(const world::Cylinder& c) const { return around(Vector(c.center), Vector(c.axis)); }
  Real operator()(const world::Cone& c) const { return around(Vector(c.center), Vector(c.axis)); }

  Real operator()(const world::Capsule& c) const {
    return std::min({Real(std::max(c.radius_bottom, c.radius_top)), around(Vector(c.center), Vector(c.axis))});
  }

  Real around(const Vector& center, const Vector& axis) const {
    const Vector v = glm::normalize(axis);
    const bool is_disk = std::abs(glm::dot(normal, v)) > 1 - 1e-15L;
    return is_disk ? kInfinity : glm::length(glm::cross(point - center, v));
  }
};

}  // namespace

Real radius_of_curvature(const world::Shape& shape, const Ray& ray, const Hit& hit) {
  const Vector point = ray.origin + hit.t * ray.direction;
  return std::visit(Curvature{point, hit.normal}, shape);
}

Real allowed_normal_error(const world::Shape& shape, const Ray& ray, const Hit& hit) {
  if (std::holds_alternative<Mesh>(shape)) return 1e-4L;
  const Real cosine = std::abs(glm::dot(hit.normal, glm::normalize(ray.direction)));
  const Real radius = radius_of_curvature(shape, ray, hit);
  return 1e-6L + 16 * kRoundoff * scale_of(shape, hit.primitive, ray) / (radius * cosine);
}

}  // namespace promin::oracle
