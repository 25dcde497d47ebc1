// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin info SCENE`, which prints the contents of a scene and whether the renderer models them. It needs no
/// Vulkan device.
Command add_info_command(CLI::App& program);

}  // namespace promin::app
