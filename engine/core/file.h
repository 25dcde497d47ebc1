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

/// The file's ending in lower case, with its dot; empty if it has none.
std::string lower_case_ending(const std::filesystem::path& file);

/// Throws RunError if a path is relative to the current folder and that folder was removed.
void refuse_lost_folder(const std::filesystem::path& file);

/// Returns the status of a file to read. Throws InputError if it is missing or cannot be accessed, and RunError if the
/// path is relative to the current folder and that folder was removed.
std::filesystem::file_status find_input(const std::filesystem::path& file);

/// Identifies a version of a file: it differs when the file is written or another takes its place.
struct FileStamp {
  int64_t written_ns = 0;
  uint64_t size_bytes = 0;
  uint64_t inode = 0;
  bool operator==(const FileStamp&) const = default;
};
/// nullopt where there is no such file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& file);

/// The whole of a regular file, or its first `most_bytes`. Throws InputError, with the place and the cure, if it is
/// missing, a folder, not readable, empty, or no more than a stand-in for the file (core/stand_in.h).
std::vector<std::byte> read_file(const std::filesystem::path& file,
                                 uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

/// The machine's name.
std::string host_name();

/// Where a file lies that is reached by symbolic links, whether it exists or not; the path itself where they lead in a
/// circle.
std::filesystem::path follow_links(const std::filesystem::path& file);

/// A file that appears whole or not at all: write to temporary(), then commit() renames it to the target. Without a
/// commit the destructor removes the temporary file and the target stays as it was. A program that may reach the file
/// size limit must ignore SIGXFSZ, because the signal would end it before the destructor runs.
class AtomicFile {
 public:
  /// Follows a symbolic link. A file that is there gives its mode to the new one. Throws RunError if the target's
  /// folder does not exist, the target is anything but a regular file, or the current folder, at which the path begins,
  /// was removed.
  explicit AtomicFile(std::filesystem::path target);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// The temporary file lies beside the target and has its ending, so that writers which pick the format by the ending
  /// see the right one: NAME.tmpPID-HOST.ENDING; NAME.2.tmp… where another thread of the process writes the same
  /// target. NAME and ENDING are shortened if the whole would be longer than the file system allows.
  const std::filesystem::path& temporary() const { return temporary_; }

  /// Flushes the temporary file to disk and renames it. Throws RunError.
  void commit();
  /// Commits all files or none: flushes all before it renames any, and restores the old files if one cannot be renamed.
  /// A process that is killed meanwhile leaves either only old files or only new files, perhaps without those later in
  /// the list, but never a mixture. Throws RunError.
  static void commit_together(std::span<AtomicFile* const> files);

 private:
  /// Creates the temporary file with the mode of the file that it replaces, so that it is never readable by more users.
  void begin_with_mode();
  void flush() const;
  void rename_to_target();
  [[noreturn]] void fail() const;

  std::filesystem::path target_;
  std::filesystem::path temporary_;
  /// The mode of the file that is replaced.
  std::optional<mode_t> mode_ = std::nullopt;
  bool committed_ = false;
};

/// Removes from a folder the temporary files of processes on this machine that ended without removing them. Files that
/// cannot be removed stay.
void clear_leftovers(const std::filesystem::path& folder);

/// Writes all bytes at a position of an open file. Returns 0, or errno after a failure.
int write_at(int descriptor, uint64_t place, std::span<const std::byte> bytes) noexcept;

/// Writes a whole file atomically, part after part. Throws RunError.
void write_file(const std::filesystem::path& file, std::initializer_list<std::span<const std::byte>> parts);
void write_text_file(const std::filesystem::path& file, std::string_view text);

}  // namespace promin
