// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/motion.h"

#include <algorithm>

namespace promin::app {

void MotionSum::set(Hold hold, bool is_down, double time) {
  advance(time);
  down_[static_cast<size_t>(hold)] = is_down;
}

void MotionSum::release_all(double time) {
  advance(time);
  down_ = {};
}

Motion MotionSum::take(double time) {
  advance(time);
  const Motion taken = sum_;
  sum_ = {};
  return taken;
}

bool MotionSum::is_held() const {
  return std::any_of(down_.begin(), down_.begin() + static_cast<size_t>(Hold::kFast), [](bool down) { return down; });
}

void MotionSum::advance(double time) {
  const double seconds = time - last_time_;
  last_time_ = time;
  const double factor = (held(Hold::kFast) > 0.0 ? kFastFactor : 1.0) * (held(Hold::kSlow) > 0.0 ? kSlowFactor : 1.0);
  sum_.travel += seconds * factor *
                 dvec3(held(Hold::kRight) - held(Hold::kLeft), held(Hold::kUp) - held(Hold::kDown),
                       held(Hold::kAhead) - held(Hold::kBack));
  sum_.roll += seconds * (held(Hold::kRollLeft) - held(Hold::kRollRight));
}

}  // namespace promin::app
