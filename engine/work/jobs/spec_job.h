// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "jobs/job.h"
#include "promin/device.h"
#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/pictures/messages.h"
#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"

// Jobs of specifications, for the programs and Python: planning a job, and storing and reading its specification.
namespace promin::work {

/// Plans the job of a specification, which need not be checked. Its outputs are ignored. `folder` is its present or
/// future folder, `messages` must outlive the plan. Throws UsageError, InputError.
std::unique_ptr<PlannedJob> plan_job(RenderSpec spec, const std::filesystem::path& folder, const Messages& messages);
/// `rays` replace those of the file that the specification names; only its name is still used.
std::unique_ptr<PlannedJob> plan_job(CastSpec spec, const std::filesystem::path& folder, const Messages& messages,
                                     std::shared_ptr<RaySource> rays = nullptr);

/// Plans a job of the kind "render" or "cast", whose specification one of the functions reads. Throws UsageError for
/// another kind and for rays of a job of pictures.
std::unique_ptr<PlannedJob> plan_job_of_kind(const std::string& kind, const std::function<RenderSpec()>& read_pictures,
                                             const std::function<CastSpec()>& read_hits,
                                             const std::filesystem::path& folder, const Messages& messages,
                                             std::shared_ptr<RaySource> rays);

/// Plans the job of the kind "render" or "cast" from the text of its specification; `file` is named in messages, and
/// relative files of the text are relative to its folder.
std::unique_ptr<PlannedJob> plan_job_of_text(const std::string& kind, const std::string& text,
                                             const std::filesystem::path& file, const std::filesystem::path& folder,
                                             const Messages& messages, std::shared_ptr<RaySource> rays = nullptr);

/// Creates the job's folder, or continues the job in it, and stores the job's specification there. Throws what
/// jobs::Job::create does.
jobs::Job create_job(PlannedJob& planned, const std::filesystem::path& folder);

/// Plans the job of a folder again from the specification that create_job has stored. Throws InputError if there is
/// none or if an input is missing, and UsageError if an input has changed, so that it would be another job.
std::unique_ptr<PlannedJob> plan_again(const jobs::Job& job, const Messages& messages,
                                       std::shared_ptr<RaySource> rays = nullptr);

/// Returns the driver_of of the job's finished pieces; empty if no piece is finished.
std::string find_driver(const jobs::Job& job);

}  // namespace promin::work
