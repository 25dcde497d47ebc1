// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace promin::app {

enum class Verbosity { kQuiet, kNormal, kVerbose };

/// Makes a console by the flags --quiet and --verbose. Throws UsageError where both are set.
Verbosity verbosity_of(bool is_quiet, bool is_verbose);

/// Prints what a command says beside its result: a line each on the standard error stream, and nothing when quiet.
class Console {
 public:
  explicit Console(Verbosity verbosity, std::string program = "promin")
      : verbosity_(verbosity), program_(std::move(program)) {}

  /// Says what was assumed where the scene or the user did not say.
  void note(const std::string& text) const { print("note: " + text, Verbosity::kNormal); }
  void warn(const std::string& text) const { print("warning: " + text, Verbosity::kNormal); }
  /// Says something only when verbose, after the seconds since the program started and those of all CPU cores.
  void detail(const std::string& text) const;

  /// Says the lines of a text only when verbose, each as a line of its own.
  void details(const std::string& lines) const;

  bool is_quiet() const { return verbosity_ == Verbosity::kQuiet; }
  bool is_verbose() const { return verbosity_ == Verbosity::kVerbose; }

 private:
  void print(const std::string& text, Verbosity least) const;

  Verbosity verbosity_;
  std::string program_;
};

}  // namespace promin::app
