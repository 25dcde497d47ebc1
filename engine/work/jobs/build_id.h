// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace promin::work {

/// Returns the build of the program or module that contains this function, in hexadecimal digits: the hash that the
/// linker has computed over the whole file (GNU build-id note). Different builds have different ids, even if they have
/// the same sources, like a program and the Python module. Pieces of jobs record it (jobs::check_build).
const std::string& build_id();

}  // namespace promin::work
