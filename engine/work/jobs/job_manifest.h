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

// The parts of a specification that a job stores: its bits for the manifest, and its text for planning it again.
namespace promin::work {

/// Returns the first part of a manifest: the kind, the version of results (results_version.h), and the members of the
/// specification that affect bits (list_bits).
jobs::Manifest begin_manifest(std::string_view kind, const std::vector<std::pair<std::string, std::string>>& bits);
/// Adds the files that a scene was loaded from. Throws InputError if one has changed since.
void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources);

/// Returns the file in a job's folder that stores the specification of its pieces.
std::filesystem::path spec_file(const jobs::Job& job);
/// Writes its text. Throws RunError.
void write_job_spec(const jobs::Job& job, const std::string& text);
/// Returns its text; nothing for a job without it, such as one whose pieces a function makes.
std::optional<std::string> read_job_spec(const jobs::Job& job);

}  // namespace promin::work
