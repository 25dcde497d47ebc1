// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/usual_integrator.h"

#include <algorithm>
#include <numbers>
#include <optional>
#include <vector>

#include "scene/glow.h"

namespace promin::work {
namespace {

/// The radiance that emissive surfaces must give a white surface.
constexpr double kLeastRadiance = 1.0 / 256.0;

/// The radiance that emissive surfaces must give a white surface so that the scene needs no other light.
constexpr double kStrongRadiance = 1.0 / 32.0;

/// The largest number of lamps that are compared with each object. The brightest are.
constexpr size_t kMostLamps = 64;

/// Returns whether a flux gives white surfaces on a sphere of this radius a radiance. The sphere receives pi times the
/// flux, and a white surface reflects 1 / pi of its irradiance.
bool lights_sphere(double flux, double radius, double radiance = kLeastRadiance) {
  return flux >= radiance * 4.0 * std::numbers::pi * radius * radius;
}

/// Returns the distance of a point to the farthest point of a box.
double farthest_distance(const dvec3& point, const Bounds& box) {
  return glm::length(glm::max(glm::abs(dvec3(box.lo) - point), glm::abs(dvec3(box.hi) - point)));
}

}  // namespace

bool lights_itself(const Scene& scene) {
  std::optional<Glow> glow = find_glow(scene);
  if (!glow) return false;
  if (lights_sphere(glow->flux, glow->radius)) return true;
  // A large floor does not hide that a lamp lights the objects on it.
  std::vector<GlowingObject>& lamps = glow->lamps;
  const size_t count = std::min(lamps.size(), kMostLamps);
  const auto end = lamps.begin() + static_cast<std::ptrdiff_t>(count);
  std::ranges::partial_sort(lamps, end, std::ranges::greater(), &GlowingObject::flux);
  return std::any_of(lamps.begin(), end, [&](const GlowingObject& lamp) {
    return std::ranges::any_of(glow->receivers, [&](const Bounds& box) {
      return lights_sphere(lamp.flux, farthest_distance(lamp.center, box));
    });
  });
}

void settle_light(const Scene& scene, Integrator integrator, LookOptions& look) {
  look.surface_lux = 0.0;
  const Environment& environment = scene.environment;
  const bool has_light = !scene.lights.empty() || environment.has_sky() || environment.ambient != vec3(0.0F);
  const bool may_add_none =
      look.light == LightChoice::kAuto || look.light == LightChoice::kFill || look.light == LightChoice::kNone;
  if (!may_add_none || scene.is_classic || has_light) return;
  const std::optional<Glow> glow = find_glow(scene);
  if (!glow || !lights_sphere(glow->flux, glow->radius, kStrongRadiance)) return;
  const bool has_lamps = integrator != Integrator::kWhitted;
  if (look.light == LightChoice::kAuto) look.light = has_lamps ? LightChoice::kFill : LightChoice::kStudio;
  if (has_lamps) look.surface_lux = glow->illuminance();
}

Integrator usual_integrator(const Scene& scene, LightChoice light) {
  return light == LightChoice::kSoft || lights_itself(scene) ? Integrator::kDirect : Integrator::kWhitted;
}

}  // namespace promin::work
