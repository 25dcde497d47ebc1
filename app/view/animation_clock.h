// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "output/work_names.h"
#include "promin/scene.h"
#include "work/spec/common_spec.h"

namespace promin::app {

/// The animation that a window shows, and its time. It repeats forever.
class AnimationClock {
 public:
  /// The animations of a scene, or all of them together, as a user chooses them.
  struct Clip {
    /// The name in lists.
    std::string name;
    /// The word of --animation.
    std::string word;
    double duration_s = 0.0;
  };

  /// Makes a clock that stands at the pose with which the scene was opened.
  explicit AnimationClock(const Scene& scene = {}, const MotionOptions& opened = {});

  const std::vector<Clip>& clips() const { return clips_; }
  /// Returns the index of the current clip; -1 for a pose that no clip gives.
  int clip() const { return clip_; }
  double time_s() const { return time_s_; }
  double speed() const { return speed_; }
  bool is_playing() const { return is_playing_; }
  /// Returns the duration of the current clip in seconds; 0 without a clip.
  double duration_s() const { return clip_ < 0 ? 0.0 : clips_[static_cast<size_t>(clip_)].duration_s; }
  /// Returns the pose to show.
  const MotionOptions& pose() const { return pose_; }

  /// Moves to this time of a steady clock, in seconds. Time passes only while the clock is playing.
  void advance(double now_s);
  /// Plays, or stops. Without a current clip, it begins with the first one.
  void toggle();
  void stop() { is_playing_ = false; }
  /// Stops, and moves by a number of frames of 1/24 s.
  void step(int frames);
  /// Moves to a time of the current clip.
  void seek(double time_s);
  /// Chooses a clip, or with -1 the pose of the nodes. The time begins at 0.
  void choose(int clip);
  /// Chooses the next clip.
  void choose_next();
  /// Sets the seconds of the animation per second, within kMinSpeed and kMaxSpeed.
  void set_speed(double speed);

  static constexpr double kMinSpeed = 1.0 / 16.0;
  static constexpr double kMaxSpeed = 16.0;

 private:
  void begin();
  void put_pose();

  std::vector<Clip> clips_;
  int clip_ = -1;
  double time_s_ = 0.0;
  double speed_ = 1.0;
  double last_s_ = 0.0;
  /// True until the first advance() after the clock began to play.
  bool is_starting_ = false;
  bool is_playing_ = false;
  MotionOptions pose_;
};

}  // namespace promin::app
