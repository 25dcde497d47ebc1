// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"

namespace promin {

/// A property of camera rays that a picture shows in place of light. debug_view_names() returns the names;
/// docs/shadings.md describes each view.
enum class DebugView : uint32_t {
  /// No debug view: the picture shows light.
  kNone = 0,
/// @cond
#define PROMIN_DEBUG_VIEW(KIND, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) ENUMERATOR = NUMBER,
#include "promin/kinds/debug_views.def"
  /// @endcond
};

/// Returns the names to display, indexed by DebugView. The first name is "full".
PROMIN_EXPORT std::span<const std::string_view> debug_view_names();

}  // namespace promin
