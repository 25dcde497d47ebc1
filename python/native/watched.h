// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <mutex>

#include "promin/progress.h"

namespace promin::python {

/// Long work that reports its progress.
using Work = std::function<void(const ProgressCallback&)>;

/// Does the work on a separate thread. Meanwhile the caller's thread waits without the GIL. Every 50 ms it takes the
/// GIL, checks for signals and calls `progress`, a callable that receives the fraction, or None. The library may
/// therefore report on any thread, and Python's main thread handles Ctrl-C. The work ends before its next dispatch if a
/// signal or `progress` raises an exception or `progress` returns False. Always waits for the end of the work, then
/// throws the work's exceptions.
void run_watched(const nanobind::object& progress, const Work& work);

/// Waits for the mutex. Throws Cancelled if `progress` returns false meanwhile.
std::unique_lock<std::timed_mutex> lock_watched(std::timed_mutex& mutex, const ProgressCallback& progress);

}  // namespace promin::python
