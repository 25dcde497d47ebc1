// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::app {

// The commands of promin-bvh. None needs a Vulkan device.

/// `build SCENE -o FILE.pbvh`: a scene's tree to a file.
Command add_build_command(CLI::App& program);

/// `info FILE.pbvh`: what a file holds.
Command add_bvh_info_command(CLI::App& program);

/// `verify SCENE FILE.pbvh`: holds a file against its scene; throws InputError where they do not fit.
Command add_verify_command(CLI::App& program);

}  // namespace promin::app
