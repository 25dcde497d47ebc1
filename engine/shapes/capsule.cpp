// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <bit>

#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {

std::optional<world::Capsule> place(const Capsule& capsule, const Placement& placement) {
  if (!placement.keeps_spheres()) return std::nullopt;
  const NamedSizes sizes = sizes_of(capsule, placement);
  const dvec3 axis = placement.direction(capsule.axis);
  return world::Capsule{vec3(center_of(capsule, placement)), vec3(axis / glm::length(axis)),
                        static_cast<float>(sizes[0].size), static_cast<float>(sizes[1].size),
                        static_cast<float>(sizes[2].size)};
}

NamedSizes sizes_of(const Capsule& capsule, const Placement& placement) {
  const double scale = placement.scale_along(capsule.axis);
  // A size may be 0 unless both radii are 0.
  return {{"half height", capsule.half_height * scale, true},
          {"radius", capsule.radius_bottom * scale, capsule.radius_top != 0.0},
          {"radius", capsule.radius_top * scale, capsule.radius_bottom != 0.0}};
}

dvec3 center_of(const Capsule& capsule, const Placement& placement) {
  return placement.point(capsule.center);
}

Bounds bounds_of(const world::Capsule& c) {
  const dvec3 center(c.center);
  const dvec3 up = double{c.half_height} * dvec3(c.axis);
  const double bottom = c.radius_bottom;
  const double top = c.radius_top;
  const dvec3 lo = glm::min(-up - bottom, up - top);
  const dvec3 hi = glm::max(-up + bottom, up + top);
  return round_outward(center + lo, center + hi, glm::abs(center) + glm::max(glm::abs(lo), glm::abs(hi)));
}

dvec3 farthest_of(const world::Capsule& c, const dvec3& direction) {
  const dvec3 outward = glm::normalize(direction);
  const dvec3 up = double{c.half_height} * dvec3(c.axis);
  const dvec3 bottom = double{c.radius_bottom} * outward - up;
  const dvec3 top = double{c.radius_top} * outward + up;
  return dvec3(c.center) + (glm::dot(top - bottom, direction) > 0.0 ? top : bottom);
}

// Packs a capsule: a = center, bottom radius; b = axis, half height; c.x = bits of the top radius.
layout::Primitive pack(const world::Capsule& c) {
  return {vec4(c.center, c.radius_bottom), vec4(c.axis, c.half_height),
          uvec4(std::bit_cast<uint32_t>(c.radius_top), 0, 0, 0)};
}

template <>
world::Capsule unpack(const layout::Primitive& p) {
  return {vec3(p.a), vec3(p.b), p.b.w, p.a.w, std::bit_cast<float>(p.c.x)};
}

}  // namespace promin
