// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "promin/scene.h"

namespace promin::app {

class OptionTable;

/// What the user changes about a scene's surroundings.
struct EnvironmentOptions {
  /// A panorama that takes the place of the scene's sky.
  std::optional<std::filesystem::path> panorama;
  /// An angle by which the sky is turned about +Y, degrees.
  double rotation_deg = 0.0;
  /// A factor of the sky's radiance.
  double intensity = 1.0;
  /// An angle by which the sky and all lights without a place are turned about +Y, degrees.
  double light_rotation_deg = 0.0;
};

/// Turns a sky, and lights that shine along one direction of the world, about +Y from +Z towards +X. An angle of 0
/// changes no bit.
void turn_light(double degrees, Environment& environment, std::span<Light> lights);

/// Adds the rows of the options. `options` must outlive the parsing.
void add_environment_options(OptionTable& table, EnvironmentOptions& options);

/// The options with the panorama read, once however many scenes take them.
class EnvironmentChoice {
 public:
  EnvironmentChoice() = default;
  /// Throws InputError where the panorama is none.
  explicit EnvironmentChoice(const EnvironmentOptions& options);

  /// What was amiss with the panorama.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// Puts the panorama around a scene. Comes before a scene without a sky gets one.
  void replace_sky(Scene& scene) const;
  /// Turns the scene's sky, whichever it has got, and makes it brighter; then turns its light.
  void adjust_sky(Scene& scene) const;

 private:
  std::optional<Panorama> panorama_;
  std::vector<std::string> warnings_;
  float rotation_ = 0.0F;
  float intensity_ = 1.0F;
  double light_rotation_deg_ = 0.0;
};

}  // namespace promin::app
