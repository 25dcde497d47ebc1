// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "reporting/session.h"

namespace promin::report {

/// What a program writes to its standard output; none where it cannot be run or fails.
std::optional<std::string> read_output(const std::vector<std::string>& words);

/// The commit of the sources beside this program, with "-dirty" where they differ from it; "unknown" without git.
std::string describe_commit();

/// Runs a script of tools/reporting in Python and reads the JSON that it prints; null where it fails.
Json run_script(const std::string& name, const std::vector<std::string>& arguments);

/// Makes report.html from the report in the output folder. Without matplotlib one sentence says that there is none.
/// Throws RunError.
void make_page(const Session& session);

}  // namespace promin::report
