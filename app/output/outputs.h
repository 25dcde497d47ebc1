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

/// Throws UsageError if an output is also an input. check_outputs() checks this for the inputs that are known before
/// the work; a loaded scene has more inputs (files_of).
void check_overwrites(const std::vector<std::filesystem::path>& inputs,
                      const std::vector<std::filesystem::path>& outputs,
                      const std::optional<std::filesystem::path>& stats);

/// Checks the outputs before the work. Throws UsageError if a file occurs twice or an output is an input. Throws
/// RunError if a folder is missing or not writable. Changes no file, but removes temporary files that killed runs left
/// beside the outputs.
void check_outputs(const std::vector<std::filesystem::path>& inputs, const std::vector<std::filesystem::path>& outputs,
                   const std::optional<std::filesystem::path>& stats);

}  // namespace promin::app
