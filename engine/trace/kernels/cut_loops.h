// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/error.h"

namespace promin {

/// Throws RunError if the driver has cut loops (shaders/shared/loop_check.glsl), because the output of the shaders is
/// then incomplete. All code that traces calls this function.
inline void refuse_cut_loops(bool were_loops_cut) {
  if (!were_loops_cut) return;
  throw RunError({"device.loops.cut",
                  "tracing takes longer than the driver allows: it ends loops after 65535 iterations", "",
                  "use another device, or remove surfaces that coincide", Setting::kDevice});
}

}  // namespace promin
