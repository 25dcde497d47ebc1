// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/error.h"
#include "trace/tile_scheduler.h"

namespace promin {

/// The error for loops of a shader that were cut (shaders/loop_check.glsl), so that its output is incomplete.
inline RunError make_cut_loops_error(const std::string& cure) {
  return RunError(
      {"tracing takes longer than the driver allows: it ends loops after 65535 turns", "on this device", cure});
}

/// Decides what to do about loops that the driver cuts; it is the one place for all pictures. They are traced again
/// with one path per lane, and so are all that follow. Where that does not suffice, they are refused.
class CutLoops {
 public:
  bool takes_many_paths() const { return takes_many_paths_; }

  TileOptions limit(TileOptions options) const {
    if (!takes_many_paths_) options.most_paths_a_lane = 1;
    return options;
  }

  /// Takes note of tiles that were traced while takes_many_paths() was `took_many_paths`. Returns whether they must be
  /// traced again; throws RunError where that would be in vain.
  bool must_trace_again(bool has_cut_loops, bool took_many_paths) {
    if (!has_cut_loops) return false;
    if (!took_many_paths) throw make_cut_loops_error("take a smaller depth or another device");
    takes_many_paths_ = false;
    return true;
  }

 private:
  bool takes_many_paths_ = true;
};

}  // namespace promin
