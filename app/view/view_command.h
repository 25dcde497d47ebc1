// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// The work of promin-view, which has no commands: it shows a scene in a window.
Command add_view_command(CLI::App& program);

}  // namespace promin::app
