// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

/// `promin render SCENE -o FILE`: one picture.
Command add_render_command(CLI::App& program);

}  // namespace promin::app
