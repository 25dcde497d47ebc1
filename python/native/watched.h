// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <functional>
#include <mutex>

#include "promin/progress.h"

namespace promin::python {

/// Work that takes a while and tells how far it is.
using Work = std::function<void(const ProgressCallback&)>;

/// Does the work on a thread of its own while the caller's, without the GIL, waits and every 50 ms takes the GIL, looks
/// for signals and tells `progress`, a callable that takes the fraction, or None. So it does not matter on which thread
/// the library reports, and Ctrl-C is answered on Python's main thread. A signal's exception, one of `progress`, or
/// its returning False end the work before its next dispatch. Throws what the work does, after it has ended always.
void run_watched(const nanobind::object& progress, const Work& work);

/// Waits for the mutex, and gives up as the progress says: throws Cancelled.
std::unique_lock<std::timed_mutex> lock_watched(std::timed_mutex& mutex, const ProgressCallback& progress);

}  // namespace promin::python
