// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "output/work_names.h"
#include "work/pictures/messages.h"

namespace promin::app {

enum class Verbosity { kQuiet, kNormal, kVerbose };

/// Returns the verbosity for the flags --quiet and --verbose. Throws UsageError if both are set.
Verbosity verbosity_of(bool is_quiet, bool is_verbose);

/// Prints a command's messages other than its result, one per line, on the standard error stream. It prints nothing
/// when quiet.
class Console : public Messages {
 public:
  explicit Console(Verbosity verbosity, std::string program = "promin")
      : verbosity_(verbosity), program_(std::move(program)) {}

  /// Prints a note about an assumption that neither the scene nor the user has made explicit.
  void note(const std::string& text) const override { print("note: " + text, Verbosity::kNormal); }
  void warn(const std::string& text) const override { print("warning: " + text, Verbosity::kNormal); }
  /// Prints a warning. It names the command line's options in place of the library's settings (message_of).
  void warn(const Problem& problem) const override;
  /// Prints a line only when verbose. The line begins with the seconds since the program's start and the CPU seconds of
  /// all cores.
  void detail(const std::string& text) const override;

  /// Prints the lines of a text only when verbose.
  void details(const std::string& lines) const;

  bool is_quiet() const { return verbosity_ == Verbosity::kQuiet; }
  bool is_verbose() const { return verbosity_ == Verbosity::kVerbose; }

 private:
  void print(const std::string& text, Verbosity least) const;

  Verbosity verbosity_;
  std::string program_;
};

}  // namespace promin::app
