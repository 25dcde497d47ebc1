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
  /// Index into Scene::lights.
  uint32_t light = 0;
  /// Empty if the light contributes nothing even when unblocked, or if nothing in the scene can cast a shadow.
  std::optional<Ray> shadow_ray;
  /// A hit of the shadow ray, not always the nearest, without a normal; a miss if the ray hits nothing.
  Hit blocker;
  /// The radiance that the light adds at the point; 0 if it is blocked.
  vec3 contribution{0.0F};

  /// Returns whether its light reaches the point, directly or through surfaces that blend.
  bool is_visible() const { return contribution != vec3(0.0F); }
};

/// The kind of event that produced a ray of a path.
enum class RayKind : uint32_t {
  kCamera = 0,
  kReflection = 1,
  kRefraction = 2,
  /// The continuation of its parent behind a surface that blends.
  kThrough = 3,
};

/// A ray of the path: the camera ray, a ray that left the previous hit, or the continuation of a ray behind its hit.
struct ExplainedRay {
  /// The origin of the ray.
  RayKind kind = RayKind::kCamera;
  /// Index in ExplainedSample::rays of the ray whose hit it leaves; the camera ray has its own index.
  uint32_t parent = 0;
  /// The ray as traced: the largest component of its direction is in [1, 2), and t is in units of that direction.
  Ray ray;
  /// The hit. The members from `position` to `material` are valid only if there is one.
  Hit hit;
  /// The hit point in the world.
  vec3 position{0.0F};
  /// A bound on the error of `position`. Shadow and mirror rays start at this distance from the surface.
  float lift = 0.0F;
  /// The unit shading normal, which faces the ray.
  vec3 shading_normal{0.0F};
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Weight of the radiance at its hit: the product of the factors of mirrors, glass, surfaces that blend and media
  /// along the path.
  vec3 weight{1.0F};
  /// Opacity of the hit, 0...1; 1 unless the material blends. The remainder of the weight goes to the next ray, which
  /// continues this one behind the hit.
  float coverage = 1.0F;
  /// Ambient and emitted light of the point; the background on a miss.
  vec3 own{0.0F};
  /// The contributions of all lights, in the scene's order.
  std::vector<ExplainedSource> sources;
  /// The path's sum up to this ray, bit for bit in fp32: the sum of the previous ray + coverage * weight * (own +
  /// contributions in their order). With glass, the environment is added first in place of rays that were not traced.
  vec3 radiance{0.0F};
};

/// The path of one sample.
struct ExplainedSample {
  /// The camera ray, then its secondary rays in the order of summation; at least one. At glass the reflected ray and
  /// all its descendants come before the refracted one.
  std::vector<ExplainedRay> rays;
  /// Returns the radiance of the sample: the sum of the last ray.
  const vec3& radiance() const { return rays.back().radiance; }
};

/// All rays and contributions that make up a pixel's colour.
struct Explanation {
  /// Coordinates in the whole picture.
  uvec2 pixel{0};
  /// The samples in the order of summation.
  std::vector<ExplainedSample> samples;
  /// Sum of the samples' radiances, bit for bit.
  vec3 sum{0.0F};
  /// `sum` divided by the number of samples: the picture's pixel, bit for bit.
  vec3 color{0.0F};
};

}  // namespace promin
