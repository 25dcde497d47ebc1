// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "promin/error.h"

namespace promin {

/// Returns this process's limit of address space in bytes, as set by ulimit -v; nullopt without a limit.
std::optional<uint64_t> address_space_limit();

/// Returns a problem if address space is limited and this number of bytes is not free. `what` names the part that needs
/// them.
std::optional<Problem> find_lack_of_space(const std::string& what, uint64_t bytes);

/// Returns the advice for a lack of memory. If address space is limited, it also suggests raising the limit.
std::string cure_short_memory(std::string cure);

}  // namespace promin
