// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {

std::optional<world::Cone> place(const Cone& cone, const Placement& placement) {
  if (!placement.keeps_cylinders(cone.axis)) return std::nullopt;
  const NamedSizes sizes = sizes_of(cone, placement);
  const dvec3 axis = placement.direction(cone.axis);
  return world::Cone{vec3(center_of(cone, placement)),  vec3(axis / glm::length(axis)),
                     static_cast<float>(sizes[0].size), static_cast<float>(sizes[1].size),
                     static_cast<float>(sizes[2].size), cone.is_open};
}

NamedSizes sizes_of(const Cone& cone, const Placement& placement) {
  const double scale = placement.scale_across(cone.axis);
  // A radius may be 0 unless both radii are 0.
  return {{"half height", cone.half_height * placement.scale_along(cone.axis)},
          {"radius", cone.radius_bottom * scale, cone.radius_top != 0.0},
          {"radius", cone.radius_top * scale, cone.radius_bottom != 0.0}};
}

dvec3 center_of(const Cone& cone, const Placement& placement) {
  return placement.point(cone.center);
}

Bounds bounds_of(const world::Cone& c) {
  return bounds_of_disks(c.center, c.axis, c.half_height, c.radius_bottom, c.radius_top);
}

dvec3 farthest_of(const world::Cone& c, const dvec3& direction) {
  return farthest_of_disks(c.center, c.axis, c.half_height, c.radius_bottom, c.radius_top, direction);
}

// Packs a cone: a = center, bottom radius; b = axis, half height; c.x = bits of the top radius, with SHAPE_IS_OPEN in
// place of the sign.
layout::Primitive pack(const world::Cone& c) {
  return {vec4(c.center, c.radius_bottom), vec4(c.axis, c.half_height),
          uvec4(std::bit_cast<uint32_t>(c.radius_top) | (c.is_open ? layout::SHAPE_IS_OPEN : 0), 0, 0, 0)};
}

template <>
world::Cone unpack(const layout::Primitive& p) {
  return {vec3(p.a),
          vec3(p.b),
          p.b.w,
          p.a.w,
          std::bit_cast<float>(p.c.x & ~layout::SHAPE_IS_OPEN),
          (p.c.x & layout::SHAPE_IS_OPEN) != 0};
}

}  // namespace promin
