// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "promin/math.h"
#include "promin/ray.h"

namespace promin {

/// A source at a point that it may light.
struct ExplainedSource {
  /// Index into Scene::lights.
  uint32_t light = 0;
  /// None where the source adds nothing, seen or not, and where nothing in the scene can throw a shadow.
  std::optional<Ray> shadow_ray;
  /// What the shadow ray met, not always the nearest; as Hit on a miss where it met nothing. Without a normal.
  Hit blocker;
  /// What it adds to the light that the point sends; 0 where it is blocked.
  vec3 contribution{0.0F};

  bool is_visible() const { return shadow_ray ? blocker.object < 0 : contribution != vec3(0.0F); }
};

/// A ray of the path: the camera's, or of the mirror at the hit before. As traced: the direction's largest component is
/// in [1, 2) and t counts in its units.
struct ExplainedRay {
  Ray ray;
  Hit hit;
  /// Of a hit: its point and the bound on that's error, by which secondary rays start off the surface; the unit normal
  /// that it is shaded with, which faces the ray; and an index into Scene::materials.
  vec3 position{0.0F};
  float lift = 0.0F;
  vec3 shading_normal{0.0F};
  uint32_t material = 0;
  /// By which all that comes along this ray counts: the product of the mirrors so far.
  vec3 weight{1.0F};
  /// Ambient and emitted light; of a miss the background.
  vec3 own{0.0F};
  /// In the scene's order.
  std::vector<ExplainedSource> sources;
  /// The path's sum up to here: the ray before's + weight * (own + contributions, in their order), to the bit in fp32.
  vec3 radiance{0.0F};
};

/// Its rays are one behind the other, with the sources' rays at each; at least one.
struct ExplainedSample {
  std::vector<ExplainedRay> rays;
  const vec3& radiance() const { return rays.back().radiance; }
};

/// Where a pixel's colour comes from.
struct Explanation {
  uvec2 pixel{0};
  std::vector<ExplainedSample> samples;
  /// Of the samples' radiances, in their order; and that over their number, which is what the picture has, to the bit.
  vec3 sum{0.0F};
  vec3 color{0.0F};
};

}  // namespace promin
