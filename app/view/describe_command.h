// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "render/view.h"

namespace promin::app {

/// The `promin render` command that gives the picture of a view, to the bit, for a shell. `camera_index` is that of
/// the scene's camera whose half height an orthographic view has.
std::string describe_command(const std::filesystem::path& scene, const View& view,
                             std::optional<size_t> camera_index = std::nullopt);

}  // namespace promin::app
