// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {

std::optional<world::Sphere> place(const Sphere& sphere, const Placement& placement) {
  if (!placement.keeps_spheres()) return std::nullopt;
  return world::Sphere{vec3(center_of(sphere, placement)),
                       static_cast<float>(sizes_of(sphere, placement).front().size)};
}

NamedSizes sizes_of(const Sphere& sphere, const Placement& placement) {
  return {{"radius", sphere.radius * placement.scale_across(dvec3(0, 1, 0))}};
}

dvec3 center_of(const Sphere& sphere, const Placement& placement) {
  return placement.point(sphere.center);
}

Bounds bounds_of(const world::Sphere& sphere) {
  const dvec3 center(sphere.center);
  const double radius = sphere.radius;
  return round_outward(center - radius, center + radius, glm::abs(center) + radius);
}

dvec3 farthest_of(const world::Sphere& sphere, const dvec3& direction) {
  return dvec3(sphere.center) + double{sphere.radius} * glm::normalize(direction);
}

// Packs a sphere: a = center, radius.
layout::Primitive pack(const world::Sphere& s) {
  return {vec4(s.center, s.radius), vec4(0.0F), uvec4(0)};
}

template <>
world::Sphere unpack(const layout::Primitive& p) {
  return {vec3(p.a), p.a.w};
}

}  // namespace promin
