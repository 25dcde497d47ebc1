// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin {

/// From here on core_count() (core/parallel.h) is `count`, at least 1. For the beginning of a program.
void limit_threads(unsigned count);

}  // namespace promin
