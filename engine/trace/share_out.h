// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/divide_up.h"
#include "promin/math.h"

namespace promin {

/// The numbers of workgroups to dispatch, across and down, so that there are at least `groups` of them, dealt out to at
/// most `most_parts` parts, one below the other (shaders/share_out.glsl). No part is without work. Both arguments are
/// >= 1.
inline uvec2 share_out(uint32_t groups, uint32_t most_parts) {
  const uint32_t parts = std::min(groups, most_parts);
  return {divide_up(groups, parts), parts};
}

}  // namespace promin
