// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace promin::work {

/// Returns the current memory use of the process, for a line of -v: "uses 123 MB". It counts resident memory, which on
/// a CPU device includes the device's memory.
std::string describe_memory();

/// Returns the largest memory use so far, in MB.
double peak_memory_mb();

/// Returns freed memory to the system. CPU drivers free about 50 MB after compiling, and the C library would otherwise
/// keep the parts that lie between used blocks.
void give_back_memory();

}  // namespace promin::work
