// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/luminance.h"
#include "scene/framing.h"
#include "scene/light_kinds.h"
#include "scene/upright.h"

namespace promin {
namespace {

constexpr double kPi = std::numbers::pi;

/// The direction from which the studio's directional light comes, as seen by the viewer, in radians; positive angles
/// are to the right and upwards.
constexpr double kStudioLightAzimuth = -35.0 * kPi / 180.0;
constexpr double kStudioLightElevation = 40.0 * kPi / 180.0;

/// If a camera looks up or down more steeply than this, its azimuth is computed from `up`, because the horizontal part
/// of its look has too few digits.
constexpr float kLeastHorizontalLook = 1e-3F;

/// The range of illuminances that need no exposure, and the illuminance to which the exposure changes all others, in
/// lux. A white surface under pi lux has a radiance of 1.
constexpr double kLeastIlluminance = kPi / 4.0;
constexpr double kMostIlluminance = 4.0 * kPi;

template <typename Model>
bool has_any(const std::vector<Material>& materials) {
  const auto is_one = [](const Material& material) { return std::holds_alternative<Model>(material.model); };
  return std::ranges::any_of(materials, is_one);
}

bool is_surrounded(const Environment& environment) {
  return environment.has_sky() || environment.ambient != vec3(0.0F);
}

bool is_of_phong(const Scene& scene) {
  return has_any<Phong>(scene.materials) && !has_any<MetallicRoughness>(scene.materials);
}

/// Returns whether the scene shows only colours that do not depend on light.
bool is_all_unlit(const Scene& scene) {
  bool is_any_unlit = false;
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry) continue;
    const auto is_unlit = [&](uint32_t i) { return std::holds_alternative<Unlit>(scene.materials[i].model); };
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
    const bool has_one = mesh == nullptr || mesh->triangle_materials.empty();
    if (has_one ? !is_unlit(object.material) : !std::ranges::all_of(mesh->triangle_materials, is_unlit)) return false;
    is_any_unlit = true;
  }
  return is_any_unlit;
}

/// Returns the power that a light of one lux must have for the scene's material models (docs/model.md, "Light").
double power_per_lux(const Scene& scene) {
  return is_of_phong(scene) ? 1.0 / kPi : 1.0;
}

/// Returns the illuminance in the middle of the scene, as exposure_of() defines it.
double illuminance_of(const Scene& scene) {
  dvec3 center(0.0);
  double least_distance = 0.0;
  // Computing the bounds of a large scene takes time, so the function does this only if a light needs the bounds.
  const auto has_distance = [](const Light& light) { return falls_off(light) || is_flat(light.kind); };
  if (std::ranges::any_of(scene.lights, has_distance)) {
    const Bounds bounds = frame_of(scene);
    center = middle_of(bounds);
    least_distance = 0.25 * glm::length(dvec3(bounds.hi) - dvec3(bounds.lo));
  }
  double sum = 0.0;
  for (const Light& light : scene.lights) {
    const double distance =
        has_distance(light) ? std::max(glm::length(dvec3(light.position) - center), least_distance) : 1.0;
    double share = 1.0 / (distance * distance);
    if (is_flat(light.kind)) {
      // A flat light has the intensity of its radiance times its area. It fills at most a half space.
      const double area = static_cast<double>(light.size.x) * static_cast<double>(light.size.y) *
                          (light.kind == LightKind::kDisk ? 0.25 * kPi : 1.0);
      share = std::min(area * share, kPi);
    }
    sum += luminance_of(dvec3(light.diffuse)) * share;
  }
  return sum / power_per_lux(scene);
}

/// Gives materials an ambient factor. Exporters write ambient factors of 0 for scenes without ambient light; surfaces
/// that the studio's light does not reach would then be black.
void let_ambient_light_in(Scene& scene) {
  for (Material& material : scene.materials) {
    auto* phong = std::get_if<Phong>(&material.model);
    if (phong != nullptr && phong->ambient == vec3(0.0F)) phong->ambient = phong->diffuse;
  }
}

}  // namespace

std::span<const std::string_view> light_choice_names() {
  using std::string_view_literals::operator""sv;
  static constexpr std::array kNames = {"auto"sv, "studio"sv, "headlight"sv, "none"sv, "soft"sv, "fill"sv};
  return kNames;
}

AssumedLight light_scene(Scene& scene, LightChoice choice, double surface_lux) {
  if (choice == LightChoice::kAuto) choice = scene.is_classic ? LightChoice::kHeadlight : LightChoice::kStudio;
  const float unexposed = std::exp2(-exposure_of(scene, surface_lux));
  const bool is_soft = choice == LightChoice::kSoft;
  const bool is_fill = choice == LightChoice::kFill || !scene.lights.empty();
  if (is_soft || choice == LightChoice::kFill) choice = LightChoice::kStudio;
  AssumedLight assumed;
  Environment& environment = scene.environment;
  const bool had_sky = is_surrounded(environment);

  if (!scene.is_classic && !had_sky && environment.background == vec3(0.0F) && !environment.backdrop) {
    environment.background = vec3(0.5F * (kStudioBackdropTop + kStudioBackdropBottom) * unexposed);
    environment.backdrop = Backdrop{vec3(kStudioBackdropTop), vec3(kStudioBackdropBottom), unexposed};
    assumed.has_background = true;
  }
  if (choice == LightChoice::kHeadlight) {
    const AddedLights added = add_default_lights(scene);
    assumed.has_headlight = added.has_headlight;
    assumed.has_ambient = added.has_ambient;
  }
  if (choice != LightChoice::kStudio || had_sky) return assumed;
  const float front = front_of(scene);
  environment.sky = Studio{front};
  assumed.has_studio = true;
  if (!scene.is_classic) let_ambient_light_in(scene);
  if (is_fill) {
    environment.intensity = kStudioFill * unexposed;
    return assumed;
  }
  Light lamp = make_studio_light(front, static_cast<float>(kStudioLightPower * power_per_lux(scene)));
  lamp.direction = vec3(turn_from_y(environment.up, lamp.direction));
  if (is_soft) lamp.angle = kSoftSunAngle;
  scene.lights.push_back(lamp);
  assumed.has_studio_light = true;
  return assumed;
}

float front_of(const Scene& scene) {
  if (scene.cameras.empty()) return 0.0F;
  const Camera& camera = scene.cameras.front();
  const vec3 look(turn_to_y(scene.environment.up, camera.look));
  vec3 to_viewer = -look;
  if (std::max(std::abs(to_viewer.x), std::abs(to_viewer.z)) < kLeastHorizontalLook) {
    // A viewer who looks from above stands at the lower edge of the picture.
    const vec3 top(turn_to_y(scene.environment.up, camera.up));
    to_viewer = look.y < 0.0F ? -top : top;
  }
  return std::atan2(to_viewer.x, to_viewer.z);
}

Light make_studio_light(float front, float power) {
  const double azimuth = static_cast<double>(front) + kStudioLightAzimuth;
  Light light;
  light.name = "studio";
  light.kind = LightKind::kDirectional;
  light.direction = -vec3(dvec3(std::cos(kStudioLightElevation) * std::sin(azimuth), std::sin(kStudioLightElevation),
                                std::cos(kStudioLightElevation) * std::cos(azimuth)));
  light.diffuse = light.specular = vec3(power);
  return light;
}

float exposure_of(const Scene& scene, double surface_lux) {
  const double illuminance = illuminance_of(scene) + surface_lux;
  if (!(illuminance > 0.0) || (illuminance >= kLeastIlluminance && illuminance <= kMostIlluminance)) return 0.0F;
  // The powers are floats and the distances are at least about 1e-15, so the logarithm is finite unless the illuminance
  // is infinite.
  const double stops = 0.5 * std::round(2.0 * std::log2(kPi / illuminance));
  return std::isfinite(stops) ? static_cast<float>(stops) : 0.0F;
}

DisplayTransform display_of(const Scene& scene, LightChoice choice, double surface_lux) {
  if (scene.is_classic || (choice == LightChoice::kHeadlight && is_of_phong(scene)) || is_all_unlit(scene)) return {};
  return {exposure_of(scene, surface_lux), ToneMapping::kNeutral};
}

bool mixes_unlit(const Scene& scene) {
  return mixes_unlit(scene, scene.environment);
}

bool mixes_unlit(const Scene& scene, const Environment& environment) {
  return (has_any<Unlit>(scene.materials) || environment.shows_backdrop()) && !is_all_unlit(scene);
}

}  // namespace promin
