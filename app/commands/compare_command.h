// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin compare`, which measures the difference of two pictures.
Command add_compare_command(CLI::App& program);

}  // namespace promin::app
