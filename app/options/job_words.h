// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/pictures/messages.h"

namespace promin::app {

/// Plans a job of the kind "render" or "cast". The words are the arguments of that command, without --output, --job,
/// --piece and options that contradict --job. They are converted to a specification (work::plan_job). `rays` replace
/// the rays of the file that "cast" names. Throws UsageError, InputError.
std::unique_ptr<work::PlannedJob> plan_job_of_words(const std::string& kind, const std::vector<std::string>& arguments,
                                                    const std::filesystem::path& folder, const work::Messages& messages,
                                                    std::shared_ptr<work::RaySource> rays = nullptr);

}  // namespace promin::app
