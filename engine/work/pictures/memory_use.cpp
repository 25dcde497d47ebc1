// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/memory_use.h"

#include <fmt/format.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

namespace promin::work {

std::string describe_memory() {
  // The file has numbers of pages: first the address space, then the resident memory (proc_pid_statm(5)).
  std::ifstream statm("/proc/self/statm");
  double total_pages = 0.0;
  double resident_pages = 0.0;
  if (!(statm >> total_pages >> resident_pages)) return "uses an unknown amount of memory";
  return fmt::format("uses {:.0f} MB", 1e-6 * resident_pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  // ru_maxrss is in units of 1024 bytes.
  return 1.024e-3 * static_cast<double>(usage.ru_maxrss);
}

void give_back_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace promin::work
