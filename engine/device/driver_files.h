// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/error.h"

namespace promin::gpu {

/// Returns a problem if the process may have too little address space for a Vulkan driver, because drivers crash at the
/// limit.
std::optional<Problem> find_lack_of_address_space();

/// Returns a problem if a file that the environment names for the Vulkan loader is not a manifest; it describes the
/// first such file.
std::optional<Problem> find_manifest_fault();

/// Returns the reason why the Vulkan loader finds no working driver: one of the two problems above, or a variable that
/// selects drivers, or that no driver is installed.
Problem explain_missing_driver();

}  // namespace promin::gpu
