// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "jobs/job.h"

namespace promin::work {

/// Throws RunError if some of these pieces are missing or bad. The message names a few of them with their faults.
void check_done(const jobs::Job& job, const std::vector<size_t>& pieces);
/// Throws RunError in the same way if any piece of the job is missing or bad.
void check_whole(const jobs::Job& job);

}  // namespace promin::work
