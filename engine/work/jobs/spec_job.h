// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "jobs/job.h"
#include "promin/device.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/pictures/messages.h"
#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"

// Functions for jobs of specifications, for the programs and Python. They plan a job, and store and read its
// specification.
namespace promin::work {

/// Plans the job of a specification, which need not be checked. Its outputs are ignored. `folder` is the job's folder,
/// which need not exist yet. `messages` must outlive the plan. Throws UsageError, InputError.
std::unique_ptr<PlannedJob> plan_job(RenderSpec spec, const std::filesystem::path& folder, const Messages& messages);
/// `rays` replace the rays of the file that the specification names. Only the file's name is still used.
std::unique_ptr<PlannedJob> plan_job(CastSpec spec, const std::filesystem::path& folder, const Messages& messages,
                                     std::shared_ptr<RaySource> rays = nullptr);

/// Throws UsageError for a kind of jobs that has no specification.
[[noreturn]] void refuse_kind(const std::string& kind);

/// Plans the job of the kind "render" or "cast" from the text of its specification. Messages name `file`, and relative
/// file names in the text are relative to its folder. Throws UsageError also for another kind, and if rays are given
/// for a job of pictures.
std::unique_ptr<PlannedJob> plan_job_of_text(const std::string& kind, const std::string& text,
                                             const std::filesystem::path& file, const std::filesystem::path& folder,
                                             const Messages& messages, std::shared_ptr<RaySource> rays = nullptr);

/// Creates the job's folder, or continues the job in it, and stores the job's specification there. Throws the same
/// errors as jobs::Job::create().
jobs::Job create_job(PlannedJob& planned, const std::filesystem::path& folder);

/// Plans the job of a folder again, from the specification that create_job() has stored. Throws InputError if there is
/// no specification or an input is missing. Throws UsageError if an input has changed, because it would be another job.
std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Messages& messages,
                                       std::shared_ptr<RaySource> rays = nullptr);

}  // namespace promin::work
