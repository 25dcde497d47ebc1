// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "work/jobs/planned_job.h"
#include "work/pictures/messages.h"
#include "work/pictures/picture_run.h"

namespace promin::work {

/// Returns the job of the pictures of `run`, which were prepared from this specification.
std::unique_ptr<PlannedJob> plan_pictures(const RenderSpec& spec, PictureRun run, const Messages& console);

}  // namespace promin::work
