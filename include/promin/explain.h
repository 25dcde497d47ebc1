// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "promin/math.h"
#include "promin/ray.h"

namespace promin {

/// A light's contribution at a hit point.
struct ExplainedSource {
  /// The value of `light` for the light of the environment, with Integrator::kDirect and kPath.
  static constexpr uint32_t kSky = 0xFFFFFFFF;
  /// The value of `light` for the light of an object that emits light, with Integrator::kDirect.
  static constexpr uint32_t kSurfaces = 0xFFFFFFFE;
  /// The value of `light` if the sample has chosen one of many sources, with Integrator::kDirect.
  static constexpr uint32_t kChosen = 0xFFFFFFFD;

  /// Index into Scene::lights, or one of the constants above.
  uint32_t light = 0;
  /// The ray from the hit point to the light. Empty if the light contributes nothing even when nothing blocks it, or if
  /// nothing in the scene can cast a shadow.
  std::optional<Ray> shadow_ray;
  /// A hit of the shadow ray; a miss if nothing blocks the light. It is not always the nearest hit and has no normal.
  Hit blocker;
  /// The radiance that the light adds at the point; 0 if it is blocked.
  vec3 contribution{0.0F};

  /// Returns whether the light reaches the point, directly or through surfaces that blend.
  bool is_visible() const { return contribution != vec3(0.0F); }
};

/// The kind of event that produced a ray of a path.
enum class RayKind : uint32_t {
  kCamera = 0,
  kReflection = 1,
  kRefraction = 2,
  /// The ray continues its parent behind a surface that blends.
  kThrough = 3,
};

/// A ray of the path: the camera ray, a ray that left the previous hit, or the continuation of a ray behind its hit.
struct ExplainedRay {
  /// The kind of event that produced this ray.
  RayKind kind = RayKind::kCamera;
  /// Index into ExplainedSample::rays: the ray at whose hit this ray starts. The camera ray has its own index.
  uint32_t parent = 0;
  /// The ray as promin traces it: the largest component of its direction lies in [1, 2), and t is in units of that
  /// direction.
  Ray ray;
  /// The ray's hit. The members from `position` to `material` are valid only if the ray hits something.
  Hit hit;
  /// The hit point in the scene's coordinates.
  vec3 position{0.0F};
  /// A bound on the error of `position`. Shadow and mirror rays start at this distance from the surface.
  float lift = 0.0F;
  /// The unit shading normal on the side of the ray's origin.
  vec3 shading_normal{0.0F};
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Weight of the radiance at the ray's hit: the product of the factors of mirrors, glass, surfaces that blend and
  /// media along the path.
  vec3 weight{1.0F};
  /// Opacity of the hit, 0...1; 1 unless the material blends. The next ray continues this ray behind the hit and has
  /// the rest of the weight.
  float coverage = 1.0F;
  /// Ambient and emitted light of the hit point; on a miss the background.
  vec3 own{0.0F};
  /// The contributions of all lights, in the order of Scene::lights.
  std::vector<ExplainedSource> sources;
  /// The path's sum up to this ray, with the same fp32 bits as on the device: the previous ray's sum + coverage *
  /// weight * (own + contributions in their order). With glass, the sum starts with the environment's light in place of
  /// rays that were not traced.
  vec3 radiance{0.0F};
};

/// The path of one sample.
struct ExplainedSample {
  /// The camera ray, then its secondary rays in the order of summation; at least one. At glass the reflected ray and
  /// all its descendants come before the refracted one.
  std::vector<ExplainedRay> rays;
  /// Returns the radiance of the sample: the sum up to the last ray.
  const vec3& radiance() const { return rays.back().radiance; }
};

/// All rays and contributions that make up a pixel's colour.
struct Explanation {
  /// Coordinates of the pixel in the whole picture.
  uvec2 pixel{0};
  /// The samples in the order of summation.
  std::vector<ExplainedSample> samples;
  /// Sum of the samples' radiances, with the same bits as on the device.
  vec3 sum{0.0F};
  /// `sum` divided by the number of samples. It has the same bits as the picture's pixel.
  vec3 color{0.0F};
};

}  // namespace promin
