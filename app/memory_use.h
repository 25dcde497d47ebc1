// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace promin::app {

/// How much memory the process holds now, for a stage's line of -v: "holds 123 MB". It counts what is resident, which
/// on a CPU device is the device's memory too.
std::string describe_memory();

/// The most that it has held so far, in MB.
double peak_memory_mb();

/// Gives the system back what has been freed. CPU drivers free some 50 MB when they have compiled, of which the C
/// library else keeps what lies between pieces that are in use.
void give_back_memory();

}  // namespace promin::app
