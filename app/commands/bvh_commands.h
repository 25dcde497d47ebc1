// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "options/arguments.h"

namespace promin::app {

// The commands of promin-bvh. No command needs a Vulkan device.

/// `build SCENE -o FILE.pbvh`: writes a scene's tree to a file.
Command add_build_command(CLI::App& program);

/// `info FILE.pbvh`: prints the contents of a file.
Command add_bvh_info_command(CLI::App& program);

/// `verify SCENE FILE.pbvh`: checks that a file belongs to a scene. Throws InputError if they do not match.
Command add_verify_command(CLI::App& program);

}  // namespace promin::app
