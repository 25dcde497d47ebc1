// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "console.h"
#include "picture_run.h"
#include "planned_job.h"

namespace promin::app {

/// The job of pictures that are about to be traced, whose command was parsed to its options.
std::unique_ptr<PlannedJob> plan_pictures(PictureRun run, const CLI::App& command, const Console& console);

}  // namespace promin::app
