// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "work/jobs/planned_job.h"
#include "work/jobs/ray_source.h"
#include "work/pictures/messages.h"
#include "work/spec/cast_spec.h"

namespace promin::work {

/// Returns the job of the rays of a checked specification. If `rays` is null, the rays are read from the file that the
/// specification names. Throws InputError, and UsageError if there are more pieces than rays.
std::unique_ptr<PlannedJob> plan_rays(const CastSpec& options, const Messages& console,
                                      std::shared_ptr<RaySource> rays = nullptr);

}  // namespace promin::work
