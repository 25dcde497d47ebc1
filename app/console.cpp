// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>

#include <cstdio>
#include <sstream>

#include "core/utf8.h"
#include "promin/error.h"

namespace promin::app {

Verbosity verbosity_of(bool is_quiet, bool is_verbose) {
  if (is_quiet && is_verbose) {
    throw UsageError({"--quiet and --verbose contradict each other", "on the command line", "leave one out"});
  }
  if (is_quiet) return Verbosity::kQuiet;
  return is_verbose ? Verbosity::kVerbose : Verbosity::kNormal;
}

void Console::details(const std::string& lines) const {
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) detail(line);
}

void Console::print(const std::string& text, Verbosity least) const {
  // fmt::print would throw where the stream is closed, and that is no reason to fail.
  if (verbosity_ >= least) std::fputs(fmt::format("{}: {}\n", program_, to_one_line(text)).c_str(), stderr);
}

}  // namespace promin::app
