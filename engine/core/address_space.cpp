// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/address_space.h"

#include <sys/mman.h>
#include <sys/resource.h>

namespace promin {

std::optional<uint64_t> address_space_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return std::nullopt;
  return limit.rlim_cur;
}

bool has_address_space(uint64_t bytes) {
  void* probe = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe == MAP_FAILED) return false;
  munmap(probe, bytes);
  return true;
}

std::string cure_short_memory(std::string cure) {
  const auto limit = address_space_limit();
  if (!limit) return cure;
  return cure + ", or raise ulimit -v (" + std::to_string(*limit >> 20) + " MiB)";
}

}  // namespace promin
