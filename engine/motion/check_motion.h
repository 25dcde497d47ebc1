// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/motion.h"

namespace promin {

/// Returns the problems of a scene's motion: indices out of range, wrong counts, nodes that are their own ancestors.
std::vector<Problem> check_motion(const Scene& scene);

}  // namespace promin
