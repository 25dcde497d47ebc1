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

// Functions for the parts of a specification that a job stores: the members that affect bits, for the manifest, and the
// text, for planning the job again.
namespace promin::work {

/// Returns the first part of a manifest: the kind, the version of results (results_version.h), and the members of the
/// specification that affect bits (list_bits).
jobs::Manifest begin_manifest(std::string_view kind, const std::vector<std::pair<std::string, std::string>>& bits);
/// Adds the files from which a scene was loaded. Throws InputError if one of them has changed since then.
void add_scene_files(jobs::Manifest& manifest, const std::vector<SourceFile>& sources);

/// Returns the file in a job's folder that stores the specification of its pieces.
std::filesystem::path spec_file(const jobs::Job& job);
/// Writes the text of the specification. Throws RunError.
void write_job_spec(const jobs::Job& job, const std::string& text);
/// Returns the text of the specification; nullopt if the job has none, for example because a function makes its pieces.
std::optional<std::string> read_job_spec(const jobs::Job& job);

}  // namespace promin::work
