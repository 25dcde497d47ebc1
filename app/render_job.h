// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "console.h"
#include "picture_run.h"
#include "planned_job.h"

namespace promin::app {

/// Returns the job of prepared pictures for a parsed command.
std::unique_ptr<PlannedJob> plan_pictures(PictureRun run, const CLI::App& command, const Console& console);

}  // namespace promin::app
