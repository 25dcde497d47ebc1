// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reporting/session.h"

namespace promin::report {

struct ProgramResult {
  bool has_succeeded = false;
  /// Its standard output.
  std::string output;
  /// The last line on its standard error stream, or why it could not be run; empty where it said nothing.
  std::string last_line;
};

/// Runs a program to its end; what it writes to its standard error stream goes to ours too.
ProgramResult run_program(const std::vector<std::string>& words);

/// The commit of the sources beside this program, with "-dirty" where any but docs differ from it; "unknown" without
/// git.
std::string describe_commit();

struct ScriptResult {
  /// What it printed; null where it failed.
  Json json;
  /// Why it failed, in its own words; none where it did not.
  std::optional<std::string> failure;
};

/// Runs a script of tools/reporting in Python, which prints JSON.
ScriptResult run_script(const std::string& name, const std::vector<std::string>& arguments);

/// Makes report.html from the report in the output folder. Without matplotlib one sentence says that there is none.
/// Throws RunError.
void make_page(const Session& session);

}  // namespace promin::report
