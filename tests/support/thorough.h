// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <vector>

namespace promin::test {

/// Whether tests take all of their cases, as tools/test --long has them do, and not a few that stand for them.
inline bool is_thorough() {
  return std::getenv("PROMIN_TEST_THOROUGH") != nullptr;
}

/// All cases, or the first of them: those that any run takes.
template <class Case>
std::vector<Case> cases_of(std::vector<Case> all, size_t first) {
  if (!is_thorough()) all.resize(std::min(first, all.size()));
  return all;
}

}  // namespace promin::test
