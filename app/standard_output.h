// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <vector>

namespace promin::app {

/// A picture that goes to the standard output: it is written to a temporary file first, as any picture appears whole or
/// not at all.
class StandardOutput {
 public:
  /// What stands for it among pictures.
  static constexpr const char* kName = "-";

  /// Puts the temporary file, a PNG, in the place of its name, if that is there.
  explicit StandardOutput(std::vector<std::filesystem::path>& pictures);
  ~StandardOutput();
  StandardOutput(const StandardOutput&) = delete;
  StandardOutput& operator=(const StandardOutput&) = delete;

  /// Where messages for people go.
  std::FILE* messages() const { return file_.empty() ? stdout : stderr; }
  /// Copies the picture. Throws RunError.
  void write() const;

 private:
  std::filesystem::path file_;
};

}  // namespace promin::app
