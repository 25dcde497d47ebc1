// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/free_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

namespace promin {

std::optional<uint64_t> available_memory() {
  std::optional<uint64_t> available;
  uint64_t swap = 0;
  std::ifstream system("/proc/meminfo");
  std::string name;
  uint64_t kib = 0;
  std::string rest;
  while (system >> name >> kib && std::getline(system, rest)) {
    if (name == "MemAvailable:") available = kib << 10;
    if (name == "SwapFree:") swap = kib << 10;
  }
  if (!available) return std::nullopt;
  *available += swap;
  return std::min(*available, available_in_group("/sys/fs/cgroup").value_or(*available));
}

std::optional<uint64_t> available_in_group(const std::filesystem::path& folder) {
  uint64_t most = 0;
  // The file contains the word "max" if there is no limit.
  if (!(std::ifstream(folder / "memory.max") >> most)) return std::nullopt;
  uint64_t used = 0;
  std::ifstream(folder / "memory.current") >> used;
  uint64_t files = 0;
  std::ifstream stat(folder / "memory.stat");
  std::string name;
  uint64_t bytes = 0;
  while (stat >> name >> bytes) {
    if (name == "active_file" || name == "inactive_file") files += bytes;
  }
  used -= std::min(used, files);
  return most - std::min(most, used);
}

}  // namespace promin
