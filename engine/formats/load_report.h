// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/source_file.h"
#include "promin/error.h"

namespace promin {

/// A word of the file as messages show it: in double quotes, and no longer than a line.
std::string quote(std::string_view word);

/// What a loader has to say about a file: problems, which end the load, and warnings. Each is kept once, however often
/// it is met.
class LoadReport {
 public:
  explicit LoadReport(std::filesystem::path file) : file_(std::move(file)) {}

  const std::filesystem::path& file() const { return file_; }

  /// `place` is inside the file: a JSON path or a line; empty for the file as a whole. Control characters that come
  /// from the file are made visible as '?', so that each message stays on its line.
  void refuse(const std::string& what, const std::string& place, const std::string& cure);
  void warn(const std::string& sentence);

  /// Is called for each file before it is read, or found missing.
  void add_source(const std::filesystem::path& file);
  const std::vector<SourceFile>& sources() const { return sources_; }

  /// Throws InputError with all problems so far, if there are any.
  void throw_if_refused() const;

  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  std::filesystem::path file_;
  std::vector<Problem> problems_;
  size_t problem_count_ = 0;
  std::vector<std::string> warnings_;
  std::vector<SourceFile> sources_;
  std::set<std::string> said_;
};

}  // namespace promin
