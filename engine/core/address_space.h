// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "promin/error.h"

namespace promin {

/// The most address space that this process may have, in bytes, as ulimit -v sets it; nullopt without a limit.
std::optional<uint64_t> address_space_limit();

/// What is wrong where address space is limited and so many bytes of it are not free; `what` needs them.
std::optional<Problem> find_lack_of_space(const std::string& what, uint64_t bytes);

/// What to do where memory is short: `cure` and, where address space is limited, to raise that limit.
std::string cure_short_memory(std::string cure);

}  // namespace promin
