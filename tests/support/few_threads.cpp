// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A library to preload (LD_PRELOAD) into a program that is to get PROMIN_TEST_THREADS threads and no more, as where
// pids.max or ulimit -u bounds them.

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*work)(void*),
                              void* argument) noexcept {
  static std::atomic<int> count = 0;
  static const auto start = reinterpret_cast<decltype(&pthread_create)>(dlsym(RTLD_NEXT, "pthread_create"));
  const char* most = std::getenv("PROMIN_TEST_THREADS");
  if (most != nullptr && count++ >= std::atoi(most)) return EAGAIN;
  return start(thread, attributes, work, argument);
}
