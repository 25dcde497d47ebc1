// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {

std::optional<world::Cylinder> place(const Cylinder& cylinder, const Placement& placement) {
  if (!placement.keeps_cylinders(cylinder.axis)) return std::nullopt;
  const NamedSizes sizes = sizes_of(cylinder, placement);
  const dvec3 axis = placement.direction(cylinder.axis);
  return world::Cylinder{vec3(center_of(cylinder, placement)), vec3(axis / glm::length(axis)),
                         static_cast<float>(sizes[0].size), static_cast<float>(sizes[1].size), cylinder.is_open};
}

NamedSizes sizes_of(const Cylinder& cylinder, const Placement& placement) {
  return {{"half height", cylinder.half_height * placement.scale_along(cylinder.axis)},
          {"radius", cylinder.radius * placement.scale_across(cylinder.axis)}};
}

dvec3 center_of(const Cylinder& cylinder, const Placement& placement) {
  return placement.point(cylinder.center);
}

Bounds bounds_of(const world::Cylinder& c) {
  return bounds_of_disks(c.center, c.axis, c.half_height, c.radius, c.radius);
}

dvec3 farthest_of(const world::Cylinder& c, const dvec3& direction) {
  return farthest_of_disks(c.center, c.axis, c.half_height, c.radius, c.radius, direction);
}

// Packs a cylinder: a = center, radius; b = axis, half height; c.x = SHAPE_IS_OPEN or 0.
layout::Primitive pack(const world::Cylinder& c) {
  return {vec4(c.center, c.radius), vec4(c.axis, c.half_height), uvec4(c.is_open ? layout::SHAPE_IS_OPEN : 0, 0, 0, 0)};
}

template <>
world::Cylinder unpack(const layout::Primitive& p) {
  return {vec3(p.a), vec3(p.b), p.b.w, p.a.w, p.c.x != 0};
}

}  // namespace promin
