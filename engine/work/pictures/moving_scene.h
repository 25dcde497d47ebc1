// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "core/feature_mask.h"
#include "promin/motion.h"
#include "promin/scene.h"

namespace promin::work {

/// The number of pictures per second of a film if the user does not choose it.
inline constexpr double kDefaultFps = 24.0;
/// The largest number of poses from which properties of a whole film are computed.
inline constexpr size_t kMostSampledPoses = 64;

/// Returns the plane under a scene that light_up() has added after its own objects (ground.h).
std::optional<Plane> find_ground(const Scene& lit, size_t own_objects);

/// Returns a scene with what light_up() has added to the same scene in another pose: lights, the environment, ambient
/// light and the ground.
Scene with_light_of(Scene posed, const Scene& lit, const std::optional<Plane>& ground);

/// A scene whose frames have different poses. Framing, light and features belong to the animations and not to a frame,
/// so that a frame has the same pixels alone and in any sequence.
class MovingScene {
 public:
  /// `scene` is in the pose of its nodes. `clip` has at least one animation; its time is not used.
  MovingScene(Scene scene, PoseChoice clip);

  /// Returns the scene that stands for all frames (envelope_of), without light.
  const Scene& envelope() const { return envelope_; }
  /// Uses the light and the environment of the envelope after light_up() for all frames, with some lights off.
  void take_light(const Scene& lit_envelope, const std::vector<uint32_t>& lights_off);
  double duration_s() const { return duration_s_; }
  /// Returns whether lights_itself() is true for a pose at a time of a key.
  bool lights_itself() const;
  /// Returns the pose at a time of a key whose surfaces emit the most light, without added light.
  Scene brightest() const;
  /// Returns the features of pictures of all poses at the times of keys, so that all frames use the same kernels.
  const FeatureMask& features() const { return features_; }
  /// Returns the scene at a time, with its light. Throws InputError.
  Scene at(double time_s) const;

 private:
  bool may_emit() const;
  Scene pose(double time_s) const;

  Scene scene_;
  PoseChoice clip_;
  double duration_s_;
  std::vector<double> times_;
  Scene envelope_;
  Scene lit_;
  /// The ground under all poses, if there is one.
  std::optional<Plane> ground_;
  std::vector<uint32_t> lights_off_;
  FeatureMask features_;
};

}  // namespace promin::work
