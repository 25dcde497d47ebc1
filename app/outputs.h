// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace promin::app {

/// For messages.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files);

/// Throws UsageError for a picture of an ending that write_image does not know.
void check_pictures(const std::vector<std::filesystem::path>& pictures);

/// Whether the file is a PNG or EXR that promin has written of a scene of this file name.
bool is_picture_of(const std::filesystem::path& file, std::string_view scene);

/// Throws UsageError where an output is also an input. check_outputs does so with the inputs that are known before the
/// work; a loaded scene tells of more (files_of).
void check_overwrites(const std::vector<std::filesystem::path>& inputs,
                      const std::vector<std::filesystem::path>& outputs,
                      const std::optional<std::filesystem::path>& stats);

/// Finds before the work what would make it useless: the same file twice, or an input as an output (UsageError), a
/// missing folder or one that cannot be written (RunError). No file is changed, but for what runs that were killed have
/// left beside the outputs, which is cleared.
void check_outputs(const std::vector<std::filesystem::path>& inputs, const std::vector<std::filesystem::path>& outputs,
                   const std::optional<std::filesystem::path>& stats);

}  // namespace promin::app
