// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

/// What promin-view does, which has no commands: shows a scene in a window.
Command add_view_command(CLI::App& program);

}  // namespace promin::app
