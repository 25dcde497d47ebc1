// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// Returns a name from a line of OBJ or MTL without the comment that may follow the name after a space, as in "red #
/// bright".
std::string_view without_comment(std::string_view name);

/// Returns the file that a line names relative to `folder`. The whole name is tried first, then the name without a
/// comment. `folder` is relative to the scene, empty or with a slash at its end. The result is a name for
/// find_beside_scene; nullopt if there is no file or find_beside_scene refuses it. Reports nothing.
std::optional<std::string> find_named_file(const std::string& name, const std::string& folder, LoadReport& report);

/// Returns the file in `folder` or beside the scene with the last part of the name, which may be a path on the author's
/// machine ("C:\textures\wood.png"). The report warns once that such files are read.
std::optional<std::string> find_by_last_part(const std::string& name, const std::string& folder, LoadReport& report);

}  // namespace promin
