// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <variant>

#include "promin/scene.h"

namespace promin::work {

/// Names of the kinds of objects, in the plural: first objects that are not drawn, then the alternatives of Geometry in
/// their order.
inline constexpr auto kObjectNames = [] {
  std::array<std::string_view, 1 + std::variant_size_v<Geometry>> names{"not_drawn"};
  for (size_t i = 1; i < names.size(); ++i) names[i] = kGeometryNames[i - 1];
  return names;
}();

/// The contents of a scene, for `promin info` and `--stats`.
struct SceneCounts {
  /// The number of objects of each kind, in the order of kObjectNames.
  std::array<uint64_t, kObjectNames.size()> objects{};
  uint64_t primitives = 0;
  uint64_t triangles = 0;
  /// The number of triangles of all meshes that objects show, each mesh counted once.
  uint64_t stored_triangles = 0;
  /// The size in bytes of vertices, triangles and shapes in the host's memory.
  uint64_t geometry_bytes = 0;
};

SceneCounts count_scene(const Scene& scene);

/// The number of nodes with morph targets, and the number of their targets.
struct MorphCounts {
  size_t nodes = 0;
  size_t targets = 0;
};

MorphCounts count_morphs(const Motion& motion);

}  // namespace promin::work
