// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "device/spirv.h"

namespace promin::test {

/// Values of the specialisation constants of branches.comp.
struct BranchConstants {
  uint32_t first = 0;
  uint32_t second = 0;
  bool third = false;

  std::vector<gpu::SpecializationConstant> list() const { return {{0, first}, {1, second}, {2, third ? 1U : 0U}}; }
};

/// Returns all values that lead to different branches.
inline std::vector<BranchConstants> all_branch_constants() {
  std::vector<BranchConstants> all;
  for (uint32_t i = 0; i < 18; ++i) all.push_back({i % 3, i / 3 % 3, i / 9 != 0});
  return all;
}

/// Returns what branches.comp computes from a number.
class Branches {
 public:
  explicit Branches(const BranchConstants& constants)
      : first_(constants.first), second_(constants.second), third_(constants.third) {}

  uint32_t compute(uint32_t x) const {
    const bool is_any = first_ != 0 || third_;
    const uint32_t chosen = third_ ? first_ : second_;
    Walk w{x % 50, second_};
    walk(w);
    walk(w);
    x += w.at * (w.steps + 1);
    x = first_ > 0 ? called_twice(x) + 7 : x ^ 21U;
    if (second_ != 0 && called_twice(x) % 2 != 0) x += 100;
    if (third_ || x % 2 != 0) x += 1000;
    x += is_any ? called_twice(x) : (first_ + second_ * 4) / 2;
    if (chosen >= 2 && second_ != 1) {
      if (x > 4000 && !third_) x -= 77;
    } else if (first_ == 1) {
      x += 3;
    }
    if (x % 3 == 0) return x + (first_ == 0 ? 11 : 13);
    if (x % 3 == 1) x = turn(x);
    return second_ == 2 ? x : turn(x) + 17;
  }

 private:
  struct Walk {
    uint32_t at;
    uint32_t steps;
  };

  static uint32_t called_twice(uint32_t x) { return x * 5 + 1; }

  void walk(Walk& w) const {
    for (uint32_t i = 0; i < 9; i += third_ ? 2 : 1) {
      if (first_ == 1 && w.at % 7 == 3) break;
      if (first_ == 2) {
        w.at += i + 4;
        break;
      }
      w.at = w.at * 3 + called_twice(i);
      w.steps += 1;
    }
    do {
      const uint32_t before = w.at;
      w.at += w.steps + 1;
      w.steps ^= before & 1U;
    } while (third_ && w.at < 200);
  }

  uint32_t turn(uint32_t x) const {
    while (first_ > 1 && x < 1000) {
      x = x * 3 + 1;
      if (second_ == 0 && x > 500) break;
      if (second_ != 1) x += 5;
    }
    for (uint32_t i = 0; !third_ && i < 5; ++i) x += i;
    for (uint32_t i = 0; i < second_; ++i) x += called_twice(i);
    if (first_ != 0 || third_) return x + 1;
    do x += 2;
    while (x < 50);
    return x;
  }

  uint32_t first_;
  uint32_t second_;
  bool third_;
};

}  // namespace promin::test
