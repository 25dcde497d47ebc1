// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

namespace promin::app {

/// Finds before the work what would make it useless: pictures of an unknown ending, the same file twice, the scene as
/// an output (UsageError), a missing folder or one that cannot be written (RunError). No file is changed.
void check_outputs(const std::filesystem::path& scene, const std::vector<std::filesystem::path>& pictures,
                   const std::optional<std::filesystem::path>& stats);

}  // namespace promin::app
