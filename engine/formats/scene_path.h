// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/load_report.h"

namespace promin {

/// The file that a scene names relative to itself. A scene from a stranger must not read outside its own folder:
/// refuses schemes, absolute paths, "..", links that lead out of the folder, and folders; also missing files if
/// `must_exist`. On nullopt the report holds the reason, or the file is missing and was not to be refused.
std::optional<std::filesystem::path> find_beside_scene(const std::string& name, const std::string& place,
                                                       bool must_exist, LoadReport& report);

}  // namespace promin
