// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin::app {

/// The camera's motion while a key is down.
enum class Hold { kAhead, kBack, kLeft, kRight, kUp, kDown, kRollLeft, kRollRight, kFast, kSlow };
inline constexpr size_t kHoldCount = 10;

/// The camera motion that keys and pointer requested over some time.
struct Motion {
  /// Movement along the camera's right, up and look, in seconds that the keys were down, multiplied by the speed key's
  /// factor.
  dvec3 travel{0.0};
  /// Seconds of roll, anticlockwise.
  double roll = 0.0;
  // The pointer's movement in pixels to the right and down:
  /// while it turned the camera,
  dvec2 turn{0.0};
  /// while it orbited the point that the camera looks at,
  dvec2 orbit{0.0};
  /// while it moved the scene,
  dvec2 pan{0.0};
  /// to the right, while it turned the light.
  double light = 0.0;
  /// Steps of the wheel towards the scene.
  double zoom = 0.0;

  bool operator==(const Motion&) const = default;
  bool is_none() const { return *this == Motion(); }
};

/// Sums motion between frames, event by event, so that the distance does not depend on the times of frames.
class MotionSum {
 public:
  /// Records that a key goes down or up at a time in seconds, which never decreases.
  void set(Hold hold, bool is_down, double time);
  void turn(const dvec2& pixels) { sum_.turn += pixels; }
  void orbit(const dvec2& pixels) { sum_.orbit += pixels; }
  void pan(const dvec2& pixels) { sum_.pan += pixels; }
  void turn_light(double pixels) { sum_.light += pixels; }
  void zoom(double steps) { sum_.zoom += steps; }
  /// Records that all keys go up, because the window has lost the focus.
  void release_all(double time);

  /// Returns the motion since the last call.
  Motion take(double time);
  bool is_held() const;
  /// Returns whether there is any motion other than that of keys that are down.
  bool has_any() const { return !sum_.is_none(); }

  static constexpr double kFastFactor = 4.0;
  static constexpr double kSlowFactor = 0.25;

 private:
  void advance(double time);
  double held(Hold hold) const { return down_[static_cast<size_t>(hold)] ? 1.0 : 0.0; }

  std::array<bool, kHoldCount> down_{};
  double last_time_ = 0.0;
  Motion sum_;
};

}  // namespace promin::app
