// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "promin/framing.h"
#include "promin/math.h"

namespace promin::app {

class OptionTable;

/// The user's choices of a camera's position, directions and lens. Positions are in the world. Directions need not be
/// unit vectors.
struct PoseOptions {
  /// The side from which to frame the scene, even if it has cameras.
  std::optional<Framing> from = std::nullopt;
  /// The part of the picture that a framed scene covers.
  std::optional<float> fit = std::nullopt;
  std::optional<dvec3> eye = std::nullopt;
  /// At most one of these two.
  std::optional<dvec3> look_at = std::nullopt;
  std::optional<dvec3> direction = std::nullopt;
  std::optional<dvec3> up = std::nullopt;
  Orbit orbit = {};
  /// Magnifies the picture around its middle.
  double zoom = 1.0;
  /// The vertical field of view, degrees in (0, 180).
  std::optional<double> fov_deg = std::nullopt;
  std::optional<double> near = std::nullopt;

  bool looks() const { return look_at || direction; }
  bool any() const { return from || fit || eye || looks() || up || orbit != Orbit() || zoom != 1.0 || fov_deg || near; }
};

/// Adds the rows of the options. `pose` must outlive the parsing.
void add_pose_options(OptionTable& table, PoseOptions& pose);

/// Throws UsageError if two options contradict each other, or an option contradicts a named camera of the scene.
void check_pose_options(const PoseOptions& pose, bool names_camera);

}  // namespace promin::app
