// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace promin {

/// Returns the memory in bytes that the process may still use: what the system estimates to be available, with free
/// swap space, but at most what the control group in /sys/fs/cgroup allows. Returns nullopt if the system does not
/// report it. A container sees its own control group of version 2 there. Other limits are not seen: those of version 1,
/// and those of a group below this folder, as outside containers.
std::optional<uint64_t> available_memory();

/// Returns the memory in bytes that a control group may still use: its limit without what it uses, except for copies
/// of files, which the system can drop. Returns nullopt if there is no limit. The folder is that of a control group of
/// version 2.
std::optional<uint64_t> available_in_group(const std::filesystem::path& folder);

}  // namespace promin
