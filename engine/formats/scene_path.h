// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/load_report.h"

namespace promin {

/// Returns the file that a scene names relative to itself. Both slashes separate parts of the name, and dot segments
/// are removed (RFC 3986, 5.2.4). A scene from an untrusted source must not read outside its own folder. The function
/// refuses files that are neither in this folder nor in the report's root after links are resolved. It also refuses
/// schemes, absolute paths without a root, and folders. If `must_exist`, it refuses missing files and suggests a
/// similar name. It returns nullopt if it refuses the file, after adding the reason to the report, and if the file is
/// missing and need not exist.
std::optional<std::filesystem::path> find_beside_scene(const std::string& name, const std::string& place,
                                                       bool must_exist, LoadReport& report);

}  // namespace promin
