// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

/// Adds `promin compare`, which tells how far two pictures are apart.
Command add_compare_command(CLI::App& program);

}  // namespace promin::app
