// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "promin/error.h"

namespace promin {

/// Returns the machine's number of cores, or 1 if it is unknown.
unsigned core_count();

/// Returns whether the system can start this number of further threads now.
bool can_start_threads(size_t count);

/// Returns the problem for the case that can_start_threads() returned false.
Problem explain_no_threads();

/// Calls task(i) once for every i in [0, count) and returns when all calls have returned. Up to `thread_count` threads
/// (0: one per core) make the calls, which start in the order of i. If the system starts fewer threads, these do the
/// whole work. After an exception no further call starts, and for_each_index() rethrows the first exception.
void for_each_index(size_t count, unsigned thread_count, const std::function<void(size_t)>& task);

/// Calls task(begin, end) for ranges: divides [0, count) into pieces of `size`, of which the last one may be smaller.
/// Threads and exceptions are as for for_each_index().
template <typename Task>
void for_each_chunk(size_t count, size_t size, unsigned thread_count, const Task& task) {
  for_each_index((count + size - 1) / size, thread_count,
                 [&](size_t i) { task(i * size, std::min(count, (i + 1) * size)); });
}

/// Returns a part for each piece of for_each_chunk(), in order. work(begin, end, part) changes a part, which is a copy
/// of `initial`. A result that is computed from the parts in order does not depend on the number of threads.
template <typename Part, typename Work>
std::vector<Part> make_parts(size_t count, size_t size, unsigned thread_count, const Part& initial, const Work& work) {
  std::vector<Part> parts((count + size - 1) / size, initial);
  for_each_chunk(count, size, thread_count, [&](size_t begin, size_t end) { work(begin, end, parts[begin / size]); });
  return parts;
}

/// Returns the indices in [0, count) for which a cheap test returns true, in order.
template <typename Test>
std::vector<uint32_t> find_indices(size_t count, const Test& test) {
  using Indices = std::vector<uint32_t>;
  constexpr size_t kIndices = 16384;
  Indices all;
  for (const Indices& part : make_parts(count, kIndices, 0, Indices(), [&](size_t begin, size_t end, Indices&found) {
         for (size_t i = begin; i < end; ++i) {
           if (test(static_cast<uint32_t>(i))) found.push_back(static_cast<uint32_t>(i));
         }
       })) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

/// Calls task(i) for each pixel or other cheap item. A thread takes many items at a time.
template <typename Task>
void for_each_pixel(size_t count, const Task& task) {
  constexpr size_t kPixels = 4096;
  for_each_chunk(count, kPixels, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) task(i);
  });
}

}  // namespace promin
