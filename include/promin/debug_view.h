// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"

namespace promin {

/// What a picture shows of each camera ray instead of light (docs/shadings.md); kNone shows light.
enum class DebugView : uint32_t {
  kNone = 0,
#define PROMIN_DEBUG_VIEW(VIEW, ENUMERATOR, PREFIX, NUMBER, NAME, REQUEST, HELP) ENUMERATOR = NUMBER,
#include "promin/kinds/debug_views.def"
};

/// Names for people, by the value of the DebugView; the first is "full".
PROMIN_EXPORT std::span<const std::string_view> debug_view_names();

}  // namespace promin
