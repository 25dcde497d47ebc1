// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace promin::report {

/// A name of each file that no other has, as short as may be: without folder and ending, or with its ending, or with as
/// many folders as tell it from the others. The files differ.
std::vector<std::string> name_scenes(const std::vector<std::filesystem::path>& files);

/// Whether both lead to the same file.
bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace promin::report
