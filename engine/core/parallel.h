// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>

namespace promin {

/// Calls task(i) once for every i in [0, count) and returns when all calls have. The calls share up to `thread_count`
/// threads (0: as many as the machine has cores) and start in the order of i. After an exception no further call
/// starts, and the first one is rethrown here.
void for_each_index(size_t count, unsigned thread_count, const std::function<void(size_t)>& task);

}  // namespace promin
