// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace promin {

/// What a file is, whatever its name says.
struct FileKind {
  /// "PLY", "a zip archive"; empty where nothing is known of it.
  std::string name = {};
  /// How to come to a scene that promin reads.
  std::string cure = {};
  /// The ending of such files where promin reads them.
  std::string ending = {};
};

/// How many of the first bytes find_file_kind() looks at, at most.
inline constexpr uint64_t kKindBytes = 4096;

/// The kind that the first bytes of a file show beyond doubt. `ending`, in lower case with its dot, is that of its
/// name: some endings show that an archive is a scene of another program. `size_bytes` is that of the whole file.
FileKind find_file_kind(std::string_view first_bytes, std::string_view ending, uint64_t size_bytes);
/// Reads what it needs. Nothing is known of a file that cannot be read.
FileKind find_file_kind(const std::filesystem::path& file);

/// Throws InputError where load_scene refuses a file by its name or for being a folder.
void check_scene_name(const std::filesystem::path& file);

}  // namespace promin
