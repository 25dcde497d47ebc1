// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/load_report.h"

namespace promin {

/// The file that a scene names relative to itself, by either slash, dot segments removed (RFC 3986, 5.2.4). A scene
/// from a stranger must not read outside its own folder: refuses what lies, links resolved, neither in this folder nor
/// in the report's root; schemes; absolute paths, where there is no root; folders; also missing files if `must_exist`,
/// with the name of one that is near. On nullopt the report holds the reason, or the file is missing and was not to be
/// refused.
std::optional<std::filesystem::path> find_beside_scene(const std::string& name, const std::string& place,
                                                       bool must_exist, LoadReport& report);

}  // namespace promin
