// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/error.h"

namespace promin::gpu {

/// Where the process may have too little address space for a Vulkan driver: these crash where they meet the limit.
std::optional<Problem> find_lack_of_address_space();

/// The first file that is no manifest among those that the environment names for Vulkan's loader.
std::optional<Problem> find_manifest_fault();

/// Why Vulkan's loader finds no driver that works: such a lack, such a file, else a variable that chooses drivers, else
/// that none is installed.
Problem explain_missing_driver();

}  // namespace promin::gpu
