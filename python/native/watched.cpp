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

/// How often the waiting thread looks.
constexpr std::chrono::milliseconds kLook{50};

/// Whether the work is to go on. Throws python_error.
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
    // What the work threw is the end that it was brought to.
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
