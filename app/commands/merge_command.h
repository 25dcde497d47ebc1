// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `merge`, which writes the files of a job from its pieces.
Command add_merge_command(CLI::App& program);

}  // namespace promin::app
