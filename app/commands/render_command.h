// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin render SCENE -o FILE`, which renders a picture.
Command add_render_command(CLI::App& program);

}  // namespace promin::app
