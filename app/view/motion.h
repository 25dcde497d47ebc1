// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "promin/math.h"

namespace promin::app {

/// What the camera does while its key is down.
enum class Hold { kAhead, kBack, kLeft, kRight, kUp, kDown, kRollLeft, kRollRight, kFast, kSlow };
inline constexpr size_t kHoldCount = 10;

/// What the keys and the pointer asked of the camera over some time.
struct Motion {
  /// Movement along the camera's right, up and look: the seconds that the keys were down, counted several times when
  /// fast.
  dvec3 travel{0.0};
  /// Seconds of roll, anticlockwise.
  double roll = 0.0;
  // The pointer's way, in pixels to the right and down:
  /// while it turned the camera,
  dvec2 turn{0.0};
  /// while it turned the scene around what the camera looks at,
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

/// Sums motion up between frames, event by event: how far the camera goes does not depend on when frames are taken.
class MotionSum {
 public:
  /// Takes note that a key goes down or up at a time in seconds, which never goes back.
  void set(Hold hold, bool is_down, double time);
  void turn(const dvec2& pixels) { sum_.turn += pixels; }
  void orbit(const dvec2& pixels) { sum_.orbit += pixels; }
  void pan(const dvec2& pixels) { sum_.pan += pixels; }
  void turn_light(double pixels) { sum_.light += pixels; }
  void zoom(double steps) { sum_.zoom += steps; }
  /// Takes note that all keys go up, because the window has lost them.
  void release_all(double time);

  /// The motion since the last call.
  Motion take(double time);
  bool is_held() const;
  /// Whether there is any motion but that of keys that are down.
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
