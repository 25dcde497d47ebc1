// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/error.h"

namespace promin {

/// What is done about loops that the driver cuts (shaders/loop_check.glsl), the one place for all that traces: what a
/// shader wrote then is not all. Throws RunError if loops were cut.
inline void refuse_cut_loops(bool were_loops_cut) {
  if (!were_loops_cut) return;
  throw RunError({"tracing takes longer than the driver allows: it ends loops after 65535 iterations", "on this device",
                  "use another device, or remove surfaces that coincide", Setting::kDevice});
}

}  // namespace promin
