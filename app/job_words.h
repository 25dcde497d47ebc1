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

// The parts of a command that a job stores: options and inputs for the manifest, and arguments for planning it again.
namespace promin::app {

/// The options of a command with their words, from given_options().
using GivenOptions = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// Returns the first part of a command's manifest: kind, version, the hash of the program's sources, and the given
/// options that affect bits.
jobs::Manifest begin_manifest(std::string_view kind, const GivenOptions& given);
/// Adds the files that a scene was loaded from. Throws InputError if one has changed since.
void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources);

/// Returns PlannedJob::arguments() for a parsed command.
std::vector<std::string> keep_arguments(const CLI::App& command);

/// Returns the file in a job's folder that stores the arguments.
std::filesystem::path arguments_file(const jobs::Job& job);
/// Writes the arguments. Throws RunError.
void write_arguments(const jobs::Job& job, const std::vector<std::string>& arguments);
/// Returns the arguments that write_arguments has stored; nothing if there are none, or if the file is damaged or of
/// another kind.
std::optional<std::vector<std::string>> read_arguments(const jobs::Job& job);

/// Throws UsageError for arguments of a job that request help or the version.
void check_asks_for_work(const std::vector<std::string>& words);
/// Throws UsageError for options that are not arguments of a job, with the place where they are chosen instead.
void check_is_kept(const GivenOptions& given);

}  // namespace promin::app
