// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/console.h"

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <sstream>

#include "core/stopwatch.h"
#include "core/utf8.h"
#include "output/message_of.h"
#include "promin/error.h"

namespace promin::app {
namespace {

const Stopwatch since_start;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

Verbosity verbosity_of(bool is_quiet, bool is_verbose) {
  if (is_quiet && is_verbose) {
    throw UsageError(
        {"usage.options.contradict", "--quiet and --verbose contradict each other", "", "remove one of them"});
  }
  if (is_quiet) return Verbosity::kQuiet;
  return is_verbose ? Verbosity::kVerbose : Verbosity::kNormal;
}

void Console::warn(const Problem& problem) const {
  warn(message_of(problem));
}

void Console::detail(const std::string& text) const {
  if (verbosity_ < Verbosity::kVerbose) return;
  print(fmt::format("[{:.2f} s, CPU {:.2f} s] {}", 1e-3 * since_start.ms(), cpu_seconds(), text), Verbosity::kVerbose);
}

void Console::details(const std::string& lines) const {
  std::istringstream text(lines);
  for (std::string line; std::getline(text, line);) print(line, Verbosity::kVerbose);
}

void Console::print(const std::string& text, Verbosity least) const {
  // std::fputs is used, because fmt::print would throw if the stream is closed, which must not cause a failure.
  if (verbosity_ >= least) std::fputs(fmt::format("{}: {}\n", program_, to_one_line(text)).c_str(), stderr);
}

}  // namespace promin::app
