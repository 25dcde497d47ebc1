// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace promin {

/// Leaves elements that are made without a value as the memory is.
template <typename T>
struct UnsetAllocator : std::allocator<T> {
  static_assert(std::is_trivially_copyable_v<T>);
  template <typename U>
  struct rebind {
    using other = UnsetAllocator<U>;
  };
  template <typename U>
  void construct(U*) noexcept {}
  template <typename U, typename... Args>
  void construct(U* place, Args&&... args) {
    std::construct_at(place, std::forward<Args>(args)...);
  }
};

/// For millions of elements that several threads fill: resize() does not touch the memory, so the pages of each part
/// come to the thread that writes it.
template <typename T>
using UnsetVector = std::vector<T, UnsetAllocator<T>>;

}  // namespace promin
