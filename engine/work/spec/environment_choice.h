// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "promin/scene.h"

namespace promin::work {

/// Ranges of the options' values.
inline constexpr double kMaxRotationDeg = 3600.0;
inline constexpr double kMaxIntensity = 1e15;

/// The changes of a scene's environment that the user requests.
struct EnvironmentOptions {
  /// A panorama that replaces the scene's sky.
  std::optional<std::filesystem::path> panorama;
  /// Rotation of the sky about its upward direction, in degrees.
  double rotation_deg = 0.0;
  /// Factor by which the sky's radiance is multiplied.
  double intensity = 1.0;
  /// Rotation of the sky and of all lights without a position about the sky's upward direction, in degrees.
  double light_rotation_deg = 0.0;
};

/// Rotates a sky and the lights that shine in one direction of the world about the sky's upward direction. If that is
/// +Y, the rotation is from +Z towards +X. An angle of 0 changes no bit.
void turn_light(double degrees, Environment& environment, std::span<Light> lights);

/// The options with the panorama, which is read once for any number of scenes.
class EnvironmentChoice {
 public:
  EnvironmentChoice() = default;
  /// Reads the panorama. Throws InputError if the file is not a panorama.
  explicit EnvironmentChoice(const EnvironmentOptions& options);

  /// Returns the warnings about the panorama.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Replaces the scene's sky by the panorama, if one is given. Call it before a default sky is added.
  void replace_sky(Scene& scene) const;
  /// Rotates the scene's sky and multiplies its radiance by the factor, then rotates the lights.
  void adjust_sky(Scene& scene) const;

 private:
  std::optional<Panorama> panorama_;
  std::vector<std::string> warnings_;
  float rotation_ = 0.0F;
  float intensity_ = 1.0F;
  double light_rotation_deg_ = 0.0;
};

}  // namespace promin::work
