// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"

namespace promin {

/// Returns a picture's size for a message.
inline std::string name_size(const uvec2& size) {
  return std::to_string(size.x) + "x" + std::to_string(size.y);
}

}  // namespace promin
