// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin {

/// Sets core_count() (core/parallel.h) to `count`, at least 1. Call it at the start of a program.
void limit_threads(unsigned count);

}  // namespace promin
