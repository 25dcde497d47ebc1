// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>

#include "shapes/shapes.h"
#include "shared/layout.h"

namespace promin {
namespace {

/// The box's axes in the world as columns, and its half sizes.
struct Orientation {
  dmat3 axes{1.0};
  dvec3 half_size{0.0};
};

/// Returns the trace. The cosine of the rotation's angle increases with it.
double trace(const dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}

/// Returns the same box with its axes renamed and reversed so that they are as near as possible to the coordinate axes.
Orientation nearest_to_space(const Orientation& given) {
  Orientation nearest;
  double most = -4.0;
  int order[3] = {0, 1, 2};
  do {
    // In a right-handed basis, two of the three signs are free.
    for (int signs = 0; signs < 4; ++signs) {
      dmat3 axes;
      dvec3 half_size;
      for (int i = 0; i < 3; ++i) {
        axes[i] = (i < 2 && ((signs >> i) & 1) != 0 ? -1.0 : 1.0) * given.axes[order[i]];
        half_size[i] = given.half_size[order[i]];
      }
      if (glm::determinant(axes) < 0.0) axes[2] = -axes[2];
      if (trace(axes) <= most) continue;
      most = trace(axes);
      nearest = {axes, half_size};
    }
  } while (std::next_permutation(std::begin(order), std::end(order)));
  return nearest;
}

/// Returns the vector part of the quaternion, with the first case of Shepperd, "Quaternion from Rotation Matrix", 1978,
/// because the trace is positive.
dvec3 turn_of(const dmat3& m) {
  const double four_w = 2.0 * std::sqrt(1.0 + trace(m));
  return dvec3(m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]) / four_w;
}

dmat3 axes_of(const vec3& turn) {
  const dvec3 v(turn);
  const double w = std::sqrt(1.0 - glm::dot(v, v));
  dmat3 axes;
  for (int i = 0; i < 3; ++i) {
    dvec3 e(0.0);
    e[i] = 1.0;
    axes[i] = e + 2.0 * glm::cross(v, glm::cross(v, e) + w * e);
  }
  return axes;
}

}  // namespace

std::optional<world::Box> place(const Box& box, const Placement& placement) {
  if (!placement.keeps_boxes()) return std::nullopt;
  const NamedSizes sizes = sizes_of(box, placement);
  Orientation given;
  for (int i = 0; i < 3; ++i) {
    given.axes[i] = dvec3(0.0);
    given.axes[i][i] = 1.0;
    const dvec3 axis = placement.direction(given.axes[i]);
    given.axes[i] = axis / glm::length(axis);
    given.half_size[i] = sizes[static_cast<size_t>(i)].size;
  }
  const Orientation nearest = nearest_to_space(given);
  return world::Box{vec3(center_of(box, placement)), vec3(nearest.half_size), vec3(turn_of(nearest.axes))};
}

NamedSizes sizes_of(const Box& box, const Placement& placement) {
  return {{"half width", box.half_size.x * placement.scale_along(dvec3(1, 0, 0))},
          {"half height", box.half_size.y * placement.scale_along(dvec3(0, 1, 0))},
          {"half depth", box.half_size.z * placement.scale_along(dvec3(0, 0, 1))}};
}

dvec3 center_of(const Box& box, const Placement& placement) {
  return placement.point(box.center);
}

Bounds bounds_of(const world::Box& box) {
  const dvec3 center(box.center);
  const dmat3 axes = axes_of(box.turn);
  dvec3 reach(0.0);
  for (int i = 0; i < 3; ++i) reach += glm::abs(axes[i]) * double{box.half_size[i]};
  return round_outward(center - reach, center + reach, glm::abs(center) + reach);
}

dvec3 farthest_of(const world::Box& box, const dvec3& direction) {
  const dmat3 axes = axes_of(box.turn);
  dvec3 point(box.center);
  for (int i = 0; i < 3; ++i) {
    point += std::copysign(double{box.half_size[i]}, glm::dot(axes[i], direction)) * axes[i];
  }
  return point;
}

// Packs a box: a = center, half size along x; b = half sizes along y and z, x and y of `turn`; c.x = bits of z of
// `turn`.
layout::Primitive pack(const world::Box& b) {
  return {vec4(b.center, b.half_size.x), vec4(b.half_size.y, b.half_size.z, b.turn.x, b.turn.y),
          uvec4(std::bit_cast<uint32_t>(b.turn.z), 0, 0, 0)};
}

template <>
world::Box unpack(const layout::Primitive& p) {
  return {vec3(p.a), vec3(p.a.w, p.b.x, p.b.y), vec3(p.b.z, p.b.w, std::bit_cast<float>(p.c.x))};
}

}  // namespace promin
