// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "jobs/job.h"

namespace promin::app {

/// Throws RunError where some of these pieces are missing or bad, and names a few, with what is bad about them.
void check_done(const jobs::Job& job, const std::vector<size_t>& pieces);
/// The same of all.
void check_whole(const jobs::Job& job);

}  // namespace promin::app
