// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/divide_up.h"
#include "promin/math.h"

namespace promin {

/// Returns the number of workgroups to dispatch in x and y: at least `groups` in at most `most_rows` rows. The rows
/// take the work in turns (shaders/shared/group_rows.glsl), and every row has work. Both arguments are >= 1.
inline uvec2 arrange_in_rows(uint32_t groups, uint32_t most_rows) {
  const uint32_t rows = std::min(groups, most_rows);
  return {divide_up(groups, rows), rows};
}

}  // namespace promin
