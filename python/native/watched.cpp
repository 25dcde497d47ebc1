// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "watched.h"

#include <atomic>
#include <chrono>
#include <future>
#include <optional>
#include <system_error>

#include "core/parallel.h"
#include "promin/error.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

/// Interval at which the waiting thread checks for signals and progress.
constexpr std::chrono::milliseconds kLook{50};

/// Returns whether the work may continue. Throws python_error.
bool ask(const nb::object& progress, double fraction) {
  if (PyErr_CheckSignals() != 0) throw nb::python_error();
  return progress.is_none() || !progress(fraction).is(nb::handle(Py_False));
}

}  // namespace

void run_watched(const nb::object& progress, const Work& work) {
  std::atomic<double> fraction = 0.0;
  std::atomic<bool> stops = false;
  std::optional<nb::python_error> interruption;
  std::future<void> result;
  {
    const nb::gil_scoped_release release;
    const ProgressCallback tell = [&](double done) {
      fraction = done;
      return !stops;
    };
    try {
      result = std::async(std::launch::async, [&] { work(tell); });
    } catch (const std::system_error&) {
      throw RunError(explain_no_threads());
    }
    while (!stops && result.wait_for(kLook) != std::future_status::ready) {
      const nb::gil_scoped_acquire acquire;
      try {
        stops = !ask(progress, fraction);
      } catch (nb::python_error& error) {
        interruption.emplace(std::move(error));
        stops = true;
      }
    }
    result.wait();
  }
  if (interruption) {
    // The work ended because of the interruption, so its own exception is dropped.
    throw nb::python_error(std::move(*interruption));
  }
  result.get();
  if (!progress.is_none()) ask(progress, 1.0);
}

std::unique_lock<std::timed_mutex> lock_watched(std::timed_mutex& mutex, const ProgressCallback& progress) {
  std::unique_lock lock(mutex, std::defer_lock);
  while (!lock.try_lock_for(kLook)) {
    if (progress && !progress(0.0)) throw Cancelled();
  }
  return lock;
}

}  // namespace promin::python
