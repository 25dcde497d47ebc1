// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/error.h"

namespace promin::gpu {

/// Returns a problem if the process may have too little address space for a Vulkan driver; drivers crash at the limit.
std::optional<Problem> find_lack_of_address_space();

/// Returns a problem for the first file that the environment names for Vulkan's loader and that is not a manifest.
std::optional<Problem> find_manifest_fault();

/// Returns the reason why Vulkan's loader finds no working driver: one of the problems above, else a variable that
/// selects drivers, else that none is installed.
Problem explain_missing_driver();

}  // namespace promin::gpu
