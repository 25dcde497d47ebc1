// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/environment_choice.h"

#include <cmath>

#include "environment/read_panorama.h"
#include "scene/upright.h"

namespace promin::work {

void turn_light(double degrees, Environment& environment, std::span<Light> lights) {
  if (degrees == 0.0) return;
  const double angle = glm::radians(degrees);
  environment.rotation += static_cast<float>(angle);
  for (Light& light : lights) {
    if (light.kind != LightKind::kDirectional) continue;
    const dvec3 way = turn_to_y(environment.up, light.direction);
    light.direction = vec3(turn_from_y(environment.up, dvec3(way.x * std::cos(angle) + way.z * std::sin(angle), way.y,
                                                             way.z * std::cos(angle) - way.x * std::sin(angle))));
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

}  // namespace promin::work
