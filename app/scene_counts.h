// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

#include "promin/scene.h"

namespace promin::app {

/// Names of the alternatives of Shape, in its order, in the plural.
inline constexpr std::array<std::string_view, 6> kShapeNames = {"not_drawn", "meshes",    "spheres",
                                                                "planes",    "cylinders", "cones"};
static_assert(kShapeNames.size() == std::variant_size_v<Shape>);

/// What a scene holds, for `promin info` and `--stats`.
struct SceneCounts {
  /// Objects of each kind, as kShapeNames.
  std::array<uint64_t, kShapeNames.size()> objects{};
  uint64_t primitives = 0;
  uint64_t triangles = 0;
  uint64_t degenerate_triangles = 0;
  /// Of the vertices, triangles and shapes in the host's memory.
  uint64_t geometry_bytes = 0;
};

SceneCounts count_scene(const Scene& scene);

}  // namespace promin::app
