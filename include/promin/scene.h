// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "scene/shapes.h"

namespace promin {

/// Phong (docs/model.md, "Light"). All factors are linear RGB and not negative; nothing is clamped to 1.
struct Material {
  std::string name;
  vec3 ambient{0.8F};
  /// Kd as it multiplies N.L * i_d: a metallic-roughness material's base colour arrives divided by pi.
  vec3 diffuse{0.8F};
  vec3 specular{0.0F};
  /// Phong's exponent; <= 0 means no specular term.
  float shininess = 0.0F;
  /// kr: weight of the mirror ray.
  vec3 reflection{0.0F};
  /// Added as it is.
  vec3 emissive{0.0F};
};

/// A headlight is a directional source that shines along the view of whatever camera looks.
enum class LightKind { kPoint, kDirectional, kSpot, kHeadlight };
enum class Attenuation { kNone, kInverseSquare };

/// A source with its own diffuse and specular power. Classic sources do not fall off with distance; physical ones
/// (KHR_lights_punctual) have candela in both powers and fall off as clamp(1 - (d/range)^4, 0, 1) / d^2.
struct Light {
  std::string name;
  LightKind kind = LightKind::kPoint;
  /// Of point and spot sources.
  vec3 position{0.0F};
  /// Unit vector in which the light travels; of directional and spot sources.
  vec3 direction{0.0F, 0.0F, -1.0F};
  vec3 diffuse{1.0F};
  vec3 specular{1.0F};
  Attenuation attenuation = Attenuation::kNone;
  float range = std::numeric_limits<float>::infinity();
  /// Half angles of a spot, radians, 0 <= inner < outer <= pi/2.
  float inner_cone_angle = 0.0F;
  float outer_cone_angle = 0.785398163F;
};

enum class Projection { kPerspective, kOrthographic };

/// A pose and a projection. `look` and `up` are orthonormal to rounding; right = look x up.
struct Camera {
  std::string name;
  Projection projection = Projection::kPerspective;
  vec3 eye{0.0F};
  vec3 look{0.0F, 0.0F, -1.0F};
  vec3 up{0.0F, 1.0F, 0.0F};
  /// Vertical field of view of a perspective camera, radians in (0, pi).
  float yfov = 0.7F;
  /// Half height of what an orthographic camera sees, in world units.
  float ymag = 1.0F;
  /// Width over height that the file asks for; 0 where it does not say.
  float aspect_ratio = 0.0F;
  /// Distance of the viewport plane: nothing nearer is drawn. >= 0.
  float near = 0.0F;
};

using Shape = std::variant<NotDrawn, Mesh, Sphere, Plane, Cylinder, Cone>;

/// One numbered scene object: its index in Scene::objects is the number that `cast` and `--aov` give.
struct Object {
  std::string name;
  Shape shape;
  /// Index into Scene::materials.
  uint32_t material = 0;
};

/// Everything a renderer needs, validated: what load_scene returns can be uploaded without further checks.
struct Scene {
  std::filesystem::path file;
  std::vector<Object> objects;
  /// Never empty.
  std::vector<Material> materials;
  std::vector<Light> lights;
  /// In depth-first order of the nodes that carry them. Empty where the file has none: see frame_scene.
  std::vector<Camera> cameras;
  vec3 ambient{0.0F};
  vec3 background{0.0F};
  /// What the file asks for and the renderer does not model, and what it assumed instead; one sentence each.
  std::vector<std::string> warnings;
};

/// Bounds of everything finite; empty if there is nothing finite.
Bounds bounds_of(const Scene& scene);

/// Number of triangles (degenerate ones included) or 1 for an analytic shape, 0 for NotDrawn.
uint32_t primitive_count(const Shape& shape);

/// A perspective camera that looks down -Z, a little from above, and frames everything finite in the scene.
/// `aspect_ratio` is width over height of the picture.
Camera frame_scene(const Scene& scene, float aspect_ratio);

/// The light of a scene without lights: i_d = i_s = 1.
Light make_headlight();

}  // namespace promin
