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
  uint64_t most = 0;
  // The file contains the word "max" if there is no limit.
  if (std::ifstream("/sys/fs/cgroup/memory.max") >> most) *available = std::min(*available, most);
  return available;
}

}  // namespace promin
