// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"

namespace promin {

/// What a picture shows of each camera ray instead of light, by the names that debug_view_names() has; docs/shadings.md
/// tells what each shows.
enum class DebugView : uint32_t {
  /// Light: the picture as it is meant.
  kNone = 0,
/// @cond
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) ENUMERATOR = NUMBER,
#include "promin/kinds/debug_views.def"
  /// @endcond
};

/// Names for people, by the value of the DebugView; the first is "full".
PROMIN_EXPORT std::span<const std::string_view> debug_view_names();

}  // namespace promin
