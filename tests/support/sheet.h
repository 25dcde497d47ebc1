// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "promin/scene.h"

namespace promin {

/// Returns a sheet with bumps, of about `triangle_count` triangles.
inline Mesh make_sheet(size_t triangle_count) {
  const auto side = static_cast<uint32_t>(std::sqrt(triangle_count / 2));
  Mesh mesh;
  for (uint32_t i = 0; i < (side + 1) * (side + 1); ++i) {
    const vec2 place(i % (side + 1), i / (side + 1));
    mesh.positions.emplace_back(place, 3.0F * std::sin(0.1F * place.x) * std::cos(0.07F * place.y));
  }
  for (uint32_t i = 0; i < side * side; ++i) {
    const uint32_t corner = i / side * (side + 1) + i % side;
    mesh.triangles.emplace_back(corner, corner + 1, corner + side + 1);
    mesh.triangles.emplace_back(corner + 1, corner + side + 2, corner + side + 1);
  }
  return mesh;
}

}  // namespace promin
