// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "work/messages.h"
#include "work/picture_run.h"
#include "work/planned_job.h"

namespace promin::work {

/// Returns the job of pictures that are prepared by this specification.
std::unique_ptr<PlannedJob> plan_pictures(const RenderSpec& spec, PictureRun run, const Messages& console);

}  // namespace promin::work
