// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace promin {

/// Allocates memory that is aligned to 64 bytes. From 4 MiB on the memory has huge pages if the system supports them,
/// because otherwise the first access to millions of elements takes as long as computing them. Throws std::bad_alloc.
void* allocate_pages(size_t bytes);
void free_pages(void* memory, size_t bytes);

/// An allocator that leaves elements without a value uninitialised.
template <typename T>
struct UnsetAllocator {
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 64);
  using value_type = T;

  UnsetAllocator() = default;
  template <typename U>
  UnsetAllocator(const UnsetAllocator<U>&) noexcept {}
  T* allocate(size_t count) { return static_cast<T*>(allocate_pages(count * sizeof(T))); }
  void deallocate(T* elements, size_t count) { free_pages(elements, count * sizeof(T)); }
  template <typename U>
  void construct(U*) noexcept {}
  template <typename U, typename... Args>
  void construct(U* place, Args&&... args) {
    std::construct_at(place, std::forward<Args>(args)...);
  }
  bool operator==(const UnsetAllocator&) const = default;
};

/// A vector for millions of elements that several threads fill. resize() does not touch the memory, so the system
/// assigns each page to the thread that writes it first.
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace promin
