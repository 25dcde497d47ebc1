// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {

std::optional<world::Plane> place(const Plane& plane, const Placement& placement) {
  const dvec3 normal = placement.normal(plane.normal);
  const double length = glm::length(normal);
  // A transform with a scale of 0 may leave no normal.
  if (!(length > 0.0) || !std::isfinite(length)) return std::nullopt;
  return world::Plane{vec3(center_of(plane, placement)), vec3(1.0 / length * normal)};
}

NamedSizes sizes_of(const Plane&, const Placement&) {
  return {};
}

dvec3 center_of(const Plane& plane, const Placement& placement) {
  return placement.point(plane.point);
}

// Packs a plane: a = point, b = normal.
layout::Primitive pack(const world::Plane& p) {
  return {vec4(p.point, 0.0F), vec4(p.normal, 0.0F), uvec4(0)};
}

template <>
world::Plane unpack(const layout::Primitive& p) {
  return {vec3(p.a), vec3(p.b)};
}

}  // namespace promin
