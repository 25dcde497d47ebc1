// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <random>

#include "promin/scene.h"

namespace promin::test {

/// Returns long, thin, tilted triangles, whose boxes are mostly empty. They are `count` closed pipes of eight sides and
/// 28 triangles at random places in the unit cube, 0.2...0.8 long and a fiftieth as thick. The mesh depends only on the
/// count, on every platform.
inline Mesh make_pipes(uint32_t count) {
  constexpr uint32_t kSides = 8;
  std::mt19937 generator(1);
  const auto uniform = [&] { return static_cast<double>(generator()) * 0x1p-32; };
  const auto random_point = [&] {
    const double x = uniform();
    const double y = uniform();
    return dvec3(x, y, uniform());
  };
  Mesh mesh;
  for (uint32_t pipe = 0; pipe < count; ++pipe) {
    const dvec3 center = random_point();
    const double length = 0.2 + 0.6 * uniform();
    const dvec3 axis = glm::normalize(random_point() - 0.5);
    const dvec3 across = glm::normalize(glm::cross(axis, random_point() - 0.5));
    const dvec3 up = glm::cross(axis, across);
    const uint32_t first = 2 * kSides * pipe;
    for (uint32_t i = 0; i < kSides; ++i) {
      const double angle = 6.283185307179586 * i / kSides;
      const dvec3 rim = 0.01 * length * (std::cos(angle) * across + std::sin(angle) * up);
      mesh.positions.emplace_back(center - 0.5 * length * axis + rim);
      mesh.positions.emplace_back(center + 0.5 * length * axis + rim);
      const uvec2 here = first + 2 * i + uvec2(0, 1);
      const uvec2 next = first + 2 * ((i + 1) % kSides) + uvec2(0, 1);
      mesh.triangles.emplace_back(here.x, next.x, next.y);
      mesh.triangles.emplace_back(here.x, next.y, here.y);
      if (i < 2) continue;
      const uvec2 last = first + 2 * (i - 1) + uvec2(0, 1);
      mesh.triangles.emplace_back(first, here.x, last.x);
      mesh.triangles.emplace_back(first + 1, last.y, here.y);
    }
  }
  return mesh;
}

}  // namespace promin::test
