// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// A name as a line of OBJ or MTL has it, without the comment that may follow it behind a space: "red # bright".
std::string_view without_comment(std::string_view name);

/// The file that a line names, relative to `folder`: that of the whole name, else that of the name without a
/// comment. `folder` is relative to the scene: empty or with a slash at its end. Gives the name for
/// find_beside_scene; nullopt where there is no file or find_beside_scene refuses it. Nothing is reported.
std::optional<std::string> find_named_file(const std::string& name, const std::string& folder, LoadReport& report);

/// The file in `folder` or beside the scene that has the last part of the name, which may be a path of the author's
/// machine ("C:\textures\wood.png"). The report warns once that such files are read.
std::optional<std::string> find_by_last_part(const std::string& name, const std::string& folder, LoadReport& report);

}  // namespace promin
