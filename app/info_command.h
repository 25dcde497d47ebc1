// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

/// `promin info SCENE`: what a scene holds and what the renderer models of it. Needs no Vulkan device.
Command add_info_command(CLI::App& program);

}  // namespace promin::app
