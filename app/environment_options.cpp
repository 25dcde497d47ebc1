// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment_options.h"

#include <cmath>

#include "arguments.h"
#include "environment/read_panorama.h"

namespace promin::app {
namespace {

constexpr double kMaxRotationDeg = 3600.0;
constexpr double kMaxIntensity = 1e15;

}  // namespace

void add_environment_options(OptionTable& table, EnvironmentOptions& options) {
  table.add(
      "--environment", "FILE",
      "Equirectangular panorama that surrounds the scene, .hdr or .exr; its middle lies at -Z [the scene's own sky]",
      [&](const OptionValues& w) { options.panorama = w.text(); });
  table.add("--environment-rotation", "DEG", "Turn the sky about +Y, from +Z towards +X, in degrees [0]",
            [&](const OptionValues& w) { options.rotation_deg = w.real(0, -kMaxRotationDeg, kMaxRotationDeg); });
  table.add("--environment-intensity", "X", "Multiply the sky's radiance by this factor [1]",
            [&](const OptionValues& w) { options.intensity = w.real(0, 0.0, kMaxIntensity); });
  table.add("--light-rotation", "DEG",
            "Turn the sky and directional lights about +Y, from +Z towards +X, in degrees [0]",
            [&](const OptionValues& w) { options.light_rotation_deg = w.real(0, -kMaxRotationDeg, kMaxRotationDeg); });
}

void turn_light(double degrees, Environment& environment, std::span<Light> lights) {
  if (degrees == 0.0) return;
  const double angle = glm::radians(degrees);
  environment.rotation += static_cast<float>(angle);
  for (Light& light : lights) {
    if (light.kind != LightKind::kDirectional) continue;
    const dvec3 way(light.direction);
    light.direction = vec3(dvec3(way.x * std::cos(angle) + way.z * std::sin(angle), way.y,
                                 way.z * std::cos(angle) - way.x * std::sin(angle)));
  }
}

EnvironmentChoice::EnvironmentChoice(const EnvironmentOptions& options)
    : rotation_(static_cast<float>(glm::radians(options.rotation_deg))),
      intensity_(static_cast<float>(options.intensity)),
      light_rotation_deg_(options.light_rotation_deg) {
  if (options.panorama) panorama_ = read_panorama(*options.panorama, warnings_);
}

void EnvironmentChoice::replace_sky(Scene& scene) const {
  if (!panorama_) return;
  scene.environment.sky = *panorama_;
  scene.environment.rotation = 0.0F;
  scene.environment.intensity = 1.0F;
}

void EnvironmentChoice::adjust_sky(Scene& scene) const {
  scene.environment.rotation += rotation_;
  scene.environment.intensity *= intensity_;
  turn_light(light_rotation_deg_, scene.environment, scene.lights);
}

}  // namespace promin::app
