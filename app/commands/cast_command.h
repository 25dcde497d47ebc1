// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin cast`, which casts rays from a file and writes their hits.
Command add_cast_command(CLI::App& program);

}  // namespace promin::app
