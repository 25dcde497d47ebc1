// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/source_file.h"
#include "jobs/job.h"

// How a job takes the options of a command: what its manifest says of them, what is kept to plan it again.
namespace CLI {
class App;
}

namespace promin::app {

/// The words that a command was given, by given_options().
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// The beginning of a command's manifest: kind, version, the hash of the program's sources, and the given options that
/// decide about bits.
jobs::Manifest begin_manifest(std::string_view kind, const GivenOptions& given);
/// Adds the files that a scene was loaded from. Throws InputError where one has changed since.
void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources);

/// What PlannedJob::arguments() is of a parsed command.
std::vector<std::string> keep_arguments(const CLI::App& command);

/// Throws UsageError for words that ask for something else than work, and for options that have no place among a job's
/// arguments, as whoever works on it chooses them; it says where.
void check_job_words(const std::vector<std::string>& words);
void check_job_words(const GivenOptions& given);

}  // namespace promin::app
