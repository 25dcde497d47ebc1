// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/source_file.h"
#include "jobs/job.h"

namespace CLI {
class App;
}

// What a job keeps of its command: of its options and inputs what the manifest says, and what plans it again.
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

/// The file of a job's folder that keeps them.
std::filesystem::path arguments_file(const jobs::Job& job);
/// Keeps them there. Throws RunError.
void write_arguments(const jobs::Job& job, const std::vector<std::string>& arguments);
/// What write_arguments has kept; nothing where it has not, or the file is damaged or another kind's.
std::optional<std::vector<std::string>> read_arguments(const jobs::Job& job);

/// Throws UsageError for words of a job's arguments that ask for help or the version.
void check_asks_for_work(const std::vector<std::string>& words);
/// Throws UsageError for options that are none of a job's arguments, as they are chosen elsewhere, which it says.
void check_is_kept(const GivenOptions& given);

}  // namespace promin::app
