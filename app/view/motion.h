// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin::app {

/// The motion of the camera while a key is down.
enum class Hold { kAhead, kBack, kLeft, kRight, kUp, kDown, kRollLeft, kRollRight, kFast, kSlow };
inline constexpr size_t kHoldCount = 10;

/// The motion of the camera that keys and pointer have requested over some time.
struct Motion {
  /// Movement along the camera's right, up and look. It is the number of seconds that the keys were down, multiplied by
  /// the speed key's factor.
  dvec3 travel{0.0};
  /// Seconds for which the camera rolled, anticlockwise.
  double roll = 0.0;
  /// The pointer's movement in pixels, to the right and down, while it turned the camera.
  dvec2 turn{0.0};
  /// The pointer's movement while it orbited the camera around the point at which it looks.
  dvec2 orbit{0.0};
  /// The pointer's movement while it moved the scene.
  dvec2 pan{0.0};
  /// The pointer's movement to the right while it turned the light.
  double light = 0.0;
  /// Number of steps of the wheel towards the scene.
  double zoom = 0.0;

  bool operator==(const Motion&) const = default;
  bool is_none() const { return *this == Motion(); }
};

/// Adds up motion between frames, event by event, so that the distance does not depend on the times of frames.
class MotionSum {
 public:
  /// Records that a key is pressed or released at a time in seconds, which never decreases.
  void set(Hold hold, bool is_down, double time);
  void turn(const dvec2& pixels) { sum_.turn += pixels; }
  void orbit(const dvec2& pixels) { sum_.orbit += pixels; }
  void pan(const dvec2& pixels) { sum_.pan += pixels; }
  void turn_light(double pixels) { sum_.light += pixels; }
  void zoom(double steps) { sum_.zoom += steps; }
  /// Releases all keys, because the window has lost the keyboard focus.
  void release_all(double time);

  /// Returns the motion since the last call.
  Motion take(double time);
  bool is_held() const;
  /// Returns whether there is any motion other than the motion of keys that are down.
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
