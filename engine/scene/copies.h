// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// The size of the triangles of all objects that are not instances. flatten() copies them to the world.
struct Copies {
  uint64_t triangles = 0;
  /// The memory of the copies, and of the records that are made of them, in bytes.
  uint64_t bytes = 0;
};
Copies count_copies(const Scene& scene, const std::vector<bool>& is_instance);

/// Throws RunError if there are too many copies for the layout, or if they take more memory than is available.
void check_copies(const Copies& copies, std::optional<uint64_t> available_bytes, const std::filesystem::path& file);

}  // namespace promin
