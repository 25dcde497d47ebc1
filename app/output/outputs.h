// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace promin::app {

/// Returns the names of the files, for messages.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files);

/// Returns whether the file is a PNG or EXR that promin has written from a scene with this file name.
bool is_picture_of(const std::filesystem::path& file, std::string_view scene);

/// Throws UsageError if an output is also an input. check_outputs does so for the inputs that are known before the
/// work; a loaded scene has more (files_of).
void check_overwrites(const std::vector<std::filesystem::path>& inputs,
                      const std::vector<std::filesystem::path>& outputs,
                      const std::optional<std::filesystem::path>& stats);

/// Checks the outputs before the work. Throws UsageError for the same file twice or an input as an output, and RunError
/// for a folder that is missing or not writable. Changes no file, except that temporary files of killed runs beside the
/// outputs are removed.
void check_outputs(const std::vector<std::filesystem::path>& inputs, const std::vector<std::filesystem::path>& outputs,
                   const std::optional<std::filesystem::path>& stats);

}  // namespace promin::app
