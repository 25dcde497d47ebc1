// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/file.h"
#include "jobs/job.h"

namespace promin::jobs {

/// A cache of the hashes of a job's large inputs, in `hashes.json` in its folder. It is indexed by the files' paths and
/// stamps. Without it every process that works on the job would read gigabytes before its first piece.
class KnownHashes {
 public:
  /// Reads the cache if it exists. Damaged entries are ignored.
  explicit KnownHashes(const std::filesystem::path& folder);

  /// Returns the same as describe_input(). Reads the file only if its stamp is unknown. Throws InputError, also if the
  /// file changes while it is read.
  InputFile describe(const std::filesystem::path& file);
  /// Writes the cache for later processes; ignores failures.
  void save();

 private:
  struct Known {
    FileStamp stamp;
    std::string sha256;
  };

  std::filesystem::path file_;
  std::map<std::string, Known> known_;
  bool has_more_ = false;
};

}  // namespace promin::jobs
