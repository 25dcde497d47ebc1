// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/attach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/light_kinds.h"
#include "scene/limits.h"

namespace promin {
namespace {

/// The smallest length of a column, and the smallest sine of the angle between two columns, for which a direction can
/// be normalised.
constexpr double kLeastSine = 1e-9;
/// The smallest angle of a cone. The area of a narrower cone on the unit sphere is too small for fp32.
constexpr float kLeastConeAngle = 1e-3F;

/// Sets the camera's axes from columns of any length. Returns whether the columns determine axes.
bool take_axes(const dmat3& columns, Camera& camera) {
  const dvec3 look = -columns[2] / glm::length(columns[2]);
  const dvec3 up = columns[1] / glm::length(columns[1]);
  const dvec3 upright = up - glm::dot(up, look) * look;
  const double sine = glm::length(upright);
  // The condition is written so that a NaN, from a column without length, fails.
  if (!(sine > kLeastSine)) return false;
  camera.look = vec3(look);
  camera.up = vec3(upright / sine);
  return true;
}

/// Returns the unit direction along -Z of a node. If that vector has no length, only the rotations determine it.
std::optional<dvec3> direction_of(const dmat4& world_from_node, const std::optional<dmat3>& rotation) {
  const dvec3 direction(-world_from_node[2]);
  const double length = glm::length(direction);
  if (length > 0.0 && std::isfinite(length)) return direction / length;
  if (!rotation) return std::nullopt;
  return glm::normalize(-(*rotation)[2]);
}

}  // namespace

Attached attach(const dmat4& world_from_node, const std::optional<dmat3>& rotation, Light& light) {
  const dvec3 position(world_from_node[3]);
  if (!is_in_range(position)) return Attached::kFar;
  if (light.kind != LightKind::kPoint) {
    const std::optional<dvec3> direction = direction_of(world_from_node, rotation);
    if (!direction) return Attached::kWithoutDirection;
    if (is_flat(light.kind)) {
      const dvec3 across(world_from_node[0]);
      const dvec3 right = across - glm::dot(across, *direction) * *direction;
      if (!(glm::length(right) > 0.0)) return Attached::kWithoutDirection;
      light.right = vec3(glm::normalize(right));
    }
    light.direction = vec3(*direction);
  }
  light.position = vec3(position);
  return Attached::kDone;
}

Attached attach(const dmat4& world_from_node, const std::optional<dmat3>& rotation, Camera& camera) {
  const dvec3 eye(world_from_node[3]);
  if (!is_in_range(eye)) return Attached::kFar;
  const bool has_axes = take_axes(dmat3(world_from_node), camera) || (rotation && take_axes(*rotation, camera));
  if (!has_axes) return Attached::kWithoutDirection;
  camera.eye = vec3(eye);
  return Attached::kDone;
}

bool set_cone(double inner, double outer, Light& light) {
  light.inner_cone_angle = static_cast<float>(inner);
  light.outer_cone_angle = static_cast<float>(std::min(outer, std::numbers::pi / 2.0));
  // Compares the angles both as the file gives them and after their conversion to fp32.
  if (inner < outer && light.inner_cone_angle < light.outer_cone_angle) return true;
  light.outer_cone_angle = std::max(light.outer_cone_angle, kLeastConeAngle);
  light.inner_cone_angle = std::nextafter(light.outer_cone_angle, 0.0F);
  return false;
}

}  // namespace promin
