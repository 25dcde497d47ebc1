// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <latch>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "core/address_space.h"
#include "core/limit_threads.h"

namespace promin {

namespace {

/// The number of threads that limit_threads() chose; 0 uses the number of cores.
std::atomic<unsigned> chosen_count = 0;

}  // namespace

unsigned core_count() {
  const unsigned count = chosen_count;
  return std::max(1U, count > 0 ? count : std::thread::hardware_concurrency());
}

void limit_threads(unsigned count) {
  chosen_count = count;
}

bool can_start_threads(size_t count) {
  std::latch end(1);
  bool has_started = true;
  {
    std::vector<std::jthread> probes;
    try {
      while (probes.size() < count) probes.emplace_back([&] { end.wait(); });
    } catch (const std::system_error&) {
      has_started = false;
    }
    end.count_down();
  }
  return has_started;
}

Problem explain_no_threads() {
  // Each thread's stack uses address space.
  const char* cure = address_space_limit() ? "raise pids.max, ulimit -u or ulimit -v" : "raise pids.max or ulimit -u";
  return {"threads.refused", "the system refuses to start another thread", "", cure};
}

void for_each_index(size_t count, unsigned thread_count, const std::function<void(size_t)>& task) {
  if (thread_count == 0) thread_count = core_count();
  std::atomic<size_t> next = 0;
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (size_t i = next++; i < count; i = next++) task(i);
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    const size_t helper_count = std::min<size_t>(thread_count, count) - (count > 0 ? 1 : 0);
    helpers.reserve(helper_count);
    try {
      while (helpers.size() < helper_count) helpers.emplace_back(work);
    } catch (const std::system_error&) {
      // If the system refuses another thread, the running threads do the work.
    }
    work();
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace promin
