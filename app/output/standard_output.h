// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <vector>

namespace promin::app {

/// A picture for the standard output. It is written to a temporary file first, because a picture must appear completely
/// or not at all.
class StandardOutput {
 public:
  /// The name that stands for the standard output among pictures.
  static constexpr const char* kName = "-";

  /// If `pictures` contain this name, replaces it by the temporary file, a PNG.
  explicit StandardOutput(std::vector<std::filesystem::path>& pictures);
  ~StandardOutput();
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Returns the stream for messages to people.
  std::FILE* messages() const { return file_.empty() ? stdout : stderr; }
  /// Copies the picture to the standard output. Throws RunError.
  void write() const;

 private:
  std::filesystem::path file_;
};

}  // namespace promin::app
