// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "formats/load_report.h"

namespace promin {

/// A name without the comment that follows it behind " #".
std::string without_comment(const std::string& name);

/// The file that a line of an OBJ or MTL names relative to `folder`, which is relative to the scene and empty or has a
/// slash at its end. Paths of the author's machine and comments behind names are common, so in this order these are
/// tried: the name, the name without a comment, and of both the last part alone. On nullopt the report has refused the
/// name for what was wrong with the first.
std::optional<std::filesystem::path> find_named_file(const std::string& folder, const std::string& name,
                                                     LoadReport& report);

}  // namespace promin
