// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A library to preload (LD_PRELOAD) into a program. The program can then have at most PROMIN_TEST_THREADS threads at a
// time besides its first, as with a limit by pids.max or ulimit -u.

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <memory>

namespace {

std::atomic<int> count = 0;

/// Counts a thread until it returns or calls pthread_exit.
struct Counted {
  Counted() = default;
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --count; }
};

struct Start {
  void* (*work)(void*);
  void* argument;
};

void* run_counted(void* start_address) {
  const Counted counted;
  const Start start = *std::unique_ptr<Start>(static_cast<Start*>(start_address));
  return start.work(start.argument);
}

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                              void* argument) noexcept {
  static const auto create = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  const char* most = std::getenv("PROMIN_TEST_THREADS");
  if (++count > std::atoi(most == nullptr ? "1000" : most)) {
    --count;
    return EAGAIN;
  }
  auto start = std::make_unique<Start>(Start{work, argument});
  const int error = create(thread, attributes, run_counted, start.get());
  if (error != 0) {
    --count;
  } else {
    static_cast<void>(start.release());
  }
  return error;
}
