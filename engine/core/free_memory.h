// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>

namespace promin {

/// Returns the memory in bytes that the process may still use: what the system estimates to be available, with free
/// swap space, but at most the limit of the process's control group. Returns nullopt if the system does not report it.
std::optional<uint64_t> available_memory();

}  // namespace promin
