// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/file.h"
#include "jobs/job.h"

namespace promin::jobs {

/// The hashes of a job's large inputs, which its folder keeps in `hashes.json` by the files' paths and stamps: each of
/// many who work on it would read gigabytes otherwise before its first piece.
class KnownHashes {
 public:
  /// Reads what the folder has, if it is there; what is damaged counts as nothing.
  explicit KnownHashes(const std::filesystem::path& folder);

  /// What describe_input tells. The file is read where its stamp is not known. Throws InputError, also where the file
  /// changes meanwhile.
  InputFile describe(const std::filesystem::path& file);
  /// Has the folder keep what was read, for those who come later, if it can.
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
