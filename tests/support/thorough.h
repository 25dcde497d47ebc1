// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace promin::test {

/// Returns whether tests run all of their cases, as with tools/test --long, and not only a few representative ones.
inline bool is_thorough() {
  return std::getenv("PROMIN_TEST_THOROUGH") != nullptr;
}

/// Returns all cases, or only the first cases, which every run tests.
template <class Case>
std::vector<Case> cases_of(std::vector<Case> all, size_t first) {
  if (!is_thorough()) all.resize(std::min(first, all.size()));
  return all;
}

}  // namespace promin::test
