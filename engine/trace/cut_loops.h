// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "promin/error.h"
#include "trace/tile_scheduler.h"

namespace promin {

/// What is done about loops that the driver cuts (shaders/loop_check.glsl), the one place for all that traces: what a
/// shader wrote then is not all. Pictures are traced again with one path a lane, and so are all that follow; where that
/// does not suffice, or there is no such way, they are refused.
class CutLoops {
 public:
  static CutLoops of_pictures() { return {true, "take a smaller depth or take another device", Setting::kDepth}; }
  /// Of pixels that are explained: a lane takes one path anyway.
  static CutLoops of_pixels() { return {false, "take a smaller depth", Setting::kDepth}; }
  static CutLoops of_rays() { return {false, "take another device", Setting::kDevice}; }

  bool takes_many_paths() const { return takes_many_paths_; }

  TileOptions limit(TileOptions options) const {
    if (!takes_many_paths_) options.most_paths_a_lane = 1;
    return options;
  }

  /// Takes note of tiles that were traced while takes_many_paths() was `took_many_paths`. Returns whether they must be
  /// traced again; throws RunError where that would be in vain.
  bool must_trace_again(bool has_cut_loops, bool took_many_paths) {
    if (!has_cut_loops) return false;
    if (!took_many_paths) refuse();
    takes_many_paths_ = false;
    return true;
  }

  /// The same of what is not traced with many paths: throws RunError if its loops were cut.
  void check(bool has_cut_loops) const {
    if (has_cut_loops) refuse();
  }

 private:
  CutLoops(bool takes_many_paths, std::string cure, Setting setting)
      : takes_many_paths_(takes_many_paths), cure_(std::move(cure)), setting_(setting) {}

  [[noreturn]] void refuse() const {
    throw RunError({"tracing takes longer than the driver allows: it ends loops after 65535 turns", "on this device",
                    cure_, setting_});
  }

  bool takes_many_paths_;
  std::string cure_;
  Setting setting_;
};

}  // namespace promin
