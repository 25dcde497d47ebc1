// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin info SCENE`, which prints the contents of a scene and which of them the renderer models. Needs no
/// Vulkan device.
Command add_info_command(CLI::App& program);

}  // namespace promin::app
