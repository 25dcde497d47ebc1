// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

/// `promin devices`: the Vulkan devices, what each lacks and which one is picked.
Command add_devices_command(CLI::App& program);

}  // namespace promin::app
