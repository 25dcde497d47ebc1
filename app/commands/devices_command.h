// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

/// Adds `promin devices`, which lists the Vulkan devices, the features that they lack, and the default.
Command add_devices_command(CLI::App& program);

}  // namespace promin::app
