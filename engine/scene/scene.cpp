// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/scene.h"

#include <algorithm>

namespace promin {
namespace {

/// How far the framing camera looks down, radians.
constexpr double kFramePitch = 0.25;
constexpr double kFrameMargin = 1.05;
constexpr float kFrameYfov = 0.7F;

struct BoundsOfShape {
  Bounds operator()(const NotDrawn&) const { return {}; }
  Bounds operator()(const Plane&) const { return {}; }
  Bounds operator()(const Mesh& mesh) const {
    Bounds bounds;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) bounds.extend(bounds_of_triangle(mesh, i));
    return bounds;
  }
  template <class Solid>
  Bounds operator()(const Solid& solid) const {
    return bounds_of(solid);
  }
};

/// What to look at: everything finite, or else a box of size 2 around the first plane's point or the origin.
Bounds frame_of(const Scene& scene) {
  Bounds bounds = bounds_of(scene);
  if (!bounds.is_empty()) return bounds;
  vec3 center(0.0F);
  for (const Object& object : scene.objects) {
    if (const auto* plane = std::get_if<Plane>(&object.shape)) {
      center = plane->point;
      break;
    }
  }
  bounds.extend(center - 1.0F);
  bounds.extend(center + 1.0F);
  return bounds;
}

}  // namespace

Bounds bounds_of(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) bounds.extend(std::visit(BoundsOfShape{}, object.shape));
  return bounds;
}

uint32_t primitive_count(const Shape& shape) {
  if (const auto* mesh = std::get_if<Mesh>(&shape)) return static_cast<uint32_t>(mesh->triangles.size());
  return std::holds_alternative<NotDrawn>(shape) ? 0 : 1;
}

Camera frame_scene(const Scene& scene, float aspect_ratio) {
  const Bounds frame = frame_of(scene);
  const dvec3 center = 0.5 * (dvec3(frame.lo) + dvec3(frame.hi));
  const dvec3 half = 0.5 * (dvec3(frame.hi) - dvec3(frame.lo));

  const dvec3 look(0.0, -std::sin(kFramePitch), -std::cos(kFramePitch));
  const dvec3 up(0.0, std::cos(kFramePitch), -std::sin(kFramePitch));
  const double tan_y = std::tan(0.5 * static_cast<double>(kFrameYfov));
  const double tan_x = tan_y * static_cast<double>(aspect_ratio);

  // The least distance at which each corner of the box lies within both fields of view.
  double distance = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 sign((corner & 1) != 0 ? 1.0 : -1.0, (corner & 2) != 0 ? 1.0 : -1.0, (corner & 4) != 0 ? 1.0 : -1.0);
    const dvec3 offset = sign * half;
    const double across = std::max(std::abs(offset.x) / tan_x, std::abs(glm::dot(offset, up)) / tan_y);
    distance = std::max(distance, across - glm::dot(offset, look));
  }
  distance *= kFrameMargin;
  // A lone point has no size to go by.
  if (distance == 0.0) distance = 1.0;
  // Far from the origin the eye must still be another fp32 number than what it looks at.
  const dvec3 magnitude = glm::abs(center);
  distance = std::max(distance, 0x1p-20 * std::max({magnitude.x, magnitude.y, magnitude.z}));

  Camera camera;
  camera.name = "framing";
  camera.eye = vec3(center - distance * look);
  camera.look = vec3(look);
  camera.up = vec3(up);
  camera.yfov = kFrameYfov;
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

Light make_headlight() {
  Light light;
  light.name = "headlight";
  light.kind = LightKind::kHeadlight;
  return light;
}

}  // namespace promin
