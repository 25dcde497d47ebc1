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

std::optional<Problem> find_lack_of_space(const std::string& what, uint64_t bytes) {
  const auto limit = address_space_limit();
  if (!limit || bytes == 0) return std::nullopt;
  void* probe = mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (probe != MAP_FAILED) {
    munmap(probe, bytes);
    return std::nullopt;
  }
  return Problem{"memory.space.short",
                 "there is too little address space for " + what + ": of the " + std::to_string(*limit >> 20) +
                     " MiB that ulimit -v allows, fewer than " + std::to_string(bytes >> 20) + " are free",
                 "", "raise ulimit -v"};
}

std::string cure_short_memory(std::string cure) {
  const auto limit = address_space_limit();
  if (!limit) return cure;
  return cure + ", or raise ulimit -v (" + std::to_string(*limit >> 20) + " MiB)";
}

}  // namespace promin
