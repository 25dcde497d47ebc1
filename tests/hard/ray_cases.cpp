// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/hard_case.h"

namespace promin::hard {

std::span<const HardCase> ray_cases() {
  return {};
}

}  // namespace promin::hard
