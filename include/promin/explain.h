// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "promin/math.h"
#include "promin/ray.h"

namespace promin {

/// A light at a point that it may light.
struct ExplainedSource {
  /// Index into Scene::lights.
  uint32_t light = 0;
  /// There is none where the light adds nothing, seen or not, and where nothing in the scene can throw a shadow.
  std::optional<Ray> shadow_ray;
  /// What the shadow ray met, not always the nearest; as Hit on a miss where it met nothing. Without a normal.
  Hit blocker;
  /// What the light adds to the light that the point sends; 0 where it is blocked.
  vec3 contribution{0.0F};

  /// Whether its light reaches the point, be it through surfaces that blend.
  bool is_visible() const { return contribution != vec3(0.0F); }
};

/// Where a ray of a path comes from.
enum class RayKind : uint32_t {
  kCamera = 0,
  kReflection = 1,
  kRefraction = 2,
  /// The same ray as its parent, from behind a surface that blends on.
  kThrough = 3,
};

/// A ray of the path: the camera's, that of the mirror at the hit before, or the same from behind that hit on.
struct ExplainedRay {
  /// What the ray comes from.
  RayKind kind = RayKind::kCamera;
  /// The number in ExplainedSample::rays of the ray whose hit it leaves; of the camera's its own.
  uint32_t parent = 0;
  /// As traced: the largest component of its direction is in [1, 2), and t is in its units.
  Ray ray;
  /// What it met. The members from `position` to `material` are of a hit alone.
  Hit hit;
  /// The point that was hit, in the world.
  vec3 position{0.0F};
  /// A bound on the error of `position`; shadow and mirror rays start so far off the surface.
  float lift = 0.0F;
  /// The unit normal that the point is shaded with; it faces the ray.
  vec3 shading_normal{0.0F};
  /// Index into Scene::materials.
  uint32_t material = 0;
  /// Weight of what is seen at its end: the product of the mirrors and the glass so far, and of what surfaces that
  /// blend and media on the way leave.
  vec3 weight{1.0F};
  /// How much of what is behind it the hit covers, 0...1: the rest of the weight is the next ray's, which is this one
  /// from behind the hit on. 1 unless the material blends.
  float coverage = 1.0F;
  /// Ambient and emitted light of the point; on a miss the background.
  vec3 own{0.0F};
  /// The lights at the point, in the scene's order.
  std::vector<ExplainedSource> sources;
  /// The path's sum up to here, to the bit in fp32: that of the ray before + coverage * weight * (own + contributions
  /// in their order). With glass the environment in place of rays that were not followed comes before that.
  vec3 radiance{0.0F};
};

/// The path of one sample.
struct ExplainedSample {
  /// The camera's ray, then those that follow from it, in the order in which they are summed: of the two that leave
  /// glass the mirror's with all that follows from it, then the refracted. At least one.
  std::vector<ExplainedRay> rays;
  /// Light that the path brings to the sample: the last ray's sum.
  const vec3& radiance() const { return rays.back().radiance; }
};

/// Where a pixel's colour comes from.
struct Explanation {
  /// Coordinates in the whole picture.
  uvec2 pixel{0};
  /// In the order in which they are summed.
  std::vector<ExplainedSample> samples;
  /// Sum of the samples' radiances, to the bit.
  vec3 sum{0.0F};
  /// `sum` over the number of samples: what the picture has, to the bit.
  vec3 color{0.0F};
};

}  // namespace promin
