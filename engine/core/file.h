// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace promin {

/// Returns the extension of a file name in lower case, with its dot; empty if it has none.
std::string lower_case_ending(const std::filesystem::path& file);

/// Throws RunError if a path is relative to the current folder and that folder was removed.
void refuse_lost_folder(const std::filesystem::path& file);

/// Returns the status of a file to read. Throws InputError if it is missing or cannot be accessed, and RunError if the
/// path is relative to the current folder and that folder was removed.
std::filesystem::file_status find_input(const std::filesystem::path& file);

/// Identifies a version of a file. The stamp changes if the file is written or replaced.
struct FileStamp {
  int64_t written_ns = 0;
  uint64_t size_bytes = 0;
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;
};
/// Returns the stamp of a file; nullopt if there is no such file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// Returns the content of a regular file, or its first `most_bytes`. Throws InputError, with the place and with advice,
/// if the file is missing, a folder, not readable, empty, or only a stand-in for another file (core/stand_in.h).
std::vector<std::byte> read_file(const std::filesystem::path& file,
                                 uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

/// Returns the machine's name.
std::string host_name();

/// Returns the target of a path that consists of symbolic links, whether the target exists or not. Returns the path
/// itself if the links form a cycle.
std::filesystem::path follow_links(const std::filesystem::path& file);

/// A file that appears completely or not at all. The caller writes to temporary(), then commit() renames this file to
/// the target. Without a commit the destructor removes the temporary file and the target stays as it was. A program
/// that may reach the file size limit must ignore SIGXFSZ, because the signal would end it before the destructor runs.
class AtomicFile {
 public:
  /// Follows a symbolic link to the target. If the target exists, the new file gets its mode. Throws RunError if the
  /// target's folder does not exist, the target is anything but a regular file, or the path is relative to a current
  /// folder that was removed.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Returns the path of the temporary file. It is beside the target and has the target's extension, so that writers
  /// which choose the format by the extension choose the right one. Its name is NAME.tmpPID-HOST.EXTENSION, or
  /// NAME.2.tmp… if another thread of the process writes the same target. NAME and EXTENSION are shortened if the name
  /// would be longer than the file system allows.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Flushes the temporary file to disk and renames it. Throws RunError.
  void commit();
  /// Commits all files or none. It flushes all files before it renames the first, and restores the old files if one
  /// cannot be renamed. If the process is killed meanwhile, there are either only old files or only new files. Some new
  /// files may be missing, but old and new files are never mixed. Throws RunError.
  static void commit_together(std::span<AtomicFile* const> files);

 private:
  /// Creates the temporary file with the mode of the file that it replaces, so that it never has more readers.
  void begin_with_mode();
  void flush() const;
  void rename_to_target();
  [[noreturn]] void fail() const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  /// The mode of the file that will be replaced.
  std::optional<mode_t> mode_ = std::nullopt;
  bool committed_ = false;
};

/// Removes from a folder the temporary files of processes on this machine that ended without removing them. Files that
/// cannot be removed are ignored.
void clear_leftovers(const std::filesystem::path& folder);

/// Writes all bytes at a position of an open file. Returns 0, or errno after a failure.
int write_at(int descriptor, uint64_t place, std::span<const std::byte> bytes) noexcept;

/// Writes a whole file atomically from parts, one after the other. Throws RunError.
void write_file(const std::filesystem::path& file, const std::vector<std::span<const std::byte>>& parts);
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace promin
