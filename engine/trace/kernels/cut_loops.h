// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/error.h"

namespace promin {

/// Throws RunError if the driver has cut loops (shaders/shared/loop_check.glsl), because the output of the shaders is
/// then incomplete. All code that traces calls this function.
inline void refuse_cut_loops(bool were_loops_cut) {
  if (!were_loops_cut) return;
  throw RunError({"device.loops.cut", "tracing takes too many iterations: the driver ends loops after 65535 iterations",
                  "", "use another device, or remove coincident surfaces", Setting::kDevice});
}

}  // namespace promin
