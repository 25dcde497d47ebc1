// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/load_report.h"

namespace promin {

/// Returns the file that a scene names relative to itself, with either slash and dot segments removed (RFC 3986,
/// 5.2.4). A scene from an untrusted source must not read outside its own folder. Refuses files that, after resolving
/// links, lie neither in this folder nor in the report's root; schemes; absolute paths without a root; folders; and, if
/// `must_exist`, missing files, with a suggestion of a similar name. Returns nullopt after reporting the reason, or if
/// the file is missing and need not exist.
std::optional<std::filesystem::path> find_beside_scene(const std::string& name, const std::string& place,
                                                       bool must_exist, LoadReport& report);

}  // namespace promin
