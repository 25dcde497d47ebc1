// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace promin {

/// The kind of a file, independent of its name.
struct FileKind {
  /// Name of the kind, such as "PLY" or "a zip archive"; empty if unknown.
  std::string name = {};
  /// Instructions for converting the file to a scene that promin reads.
  std::string cure = {};
  /// The extension of such files if promin reads them.
  std::string ending = {};
};

/// The largest number of first bytes that find_file_kind() reads.
inline constexpr uint64_t kKindBytes = 4096;

/// Returns the kind that the first bytes of a file show with certainty. `ending` is the extension of the file's name,
/// in lower case with its dot; some extensions show that an archive is a scene of another program. `size_bytes` is the
/// size of the whole file.
FileKind find_file_kind(std::string_view first_bytes, std::string_view ending, uint64_t size_bytes);
/// Returns the kind of a file from its first bytes. A file that cannot be read has an unknown kind.
FileKind find_file_kind(const std::filesystem::path& file);

/// Throws InputError if load_scene would refuse the file because of its name or because it is a folder.
void check_scene_name(const std::filesystem::path& file);

}  // namespace promin
