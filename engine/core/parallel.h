// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "promin/error.h"

namespace promin {

/// The machine's number of cores, or 1 where it is not known.
unsigned core_count();

/// Whether the system starts so many further threads now.
bool can_start_threads(size_t count);

/// The problem where it does not.
Problem explain_no_threads();

/// Calls task(i) once for every i in [0, count) and returns when all calls have. The calls share up to `thread_count`
/// threads (0: as many as the machine has cores) and start in the order of i; where the
/// system starts fewer threads, those do the whole work. After an exception no further call starts, and the first one
/// is rethrown here.
void for_each_index(size_t count, unsigned thread_count, const std::function<void(size_t)>& task);

/// Does the same for ranges: calls task(begin, end) for [0, count) in pieces of `size`; the last one has what is left.
template <typename Task>
void for_each_chunk(size_t count, size_t size, unsigned thread_count, const Task& task) {
  for_each_index((count + size - 1) / size, thread_count,
                 [&](size_t i) { task(i * size, std::min(count, (i + 1) * size)); });
}

/// Calls task(i) for each pixel, or whatever else takes little: many to a piece.
template <typename Task>
void for_each_pixel(size_t count, const Task& task) {
  constexpr size_t kPixels = 4096;
  for_each_chunk(count, kPixels, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) task(i);
  });
}

}  // namespace promin
