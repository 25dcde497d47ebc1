// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace promin::app {

/// States whether arguments may name output files.
enum class OutputWords { kRefused, kAllowed };

/// Returns the specification that arguments of the command "render" or "cast" describe, as the text that --print-spec
/// prints. Options that each process chooses, such as --job and --device, are refused. Throws UsageError, and
/// InputError for a file of --spec.
std::string spec_of_words(const std::string& kind, const std::vector<std::string>& arguments, OutputWords outputs);

}  // namespace promin::app
