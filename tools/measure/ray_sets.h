// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "promin/ray.h"
#include "scene/world_scene.h"

namespace promin::measure {

/// Rays of one kind, in the order in which they are cast, and what is asked of them. The same bits every time.
struct RaySet {
  std::string name;
  HitQuery query = HitQuery::kNearest;
  std::vector<Ray> rays;
};

/// From `origin` towards `target`, both rounded to fp32; the direction has unit length to rounding.
Ray ray_towards(const dvec3& origin, const dvec3& target);

/// A ray through the centre of each pixel of a picture, row by row.
RaySet make_camera_rays(const Camera& camera, const uvec2& size);

/// From each point that a camera ray sees, a little off its surface, to one light: the scene's first, or where it has
/// none a point beside the camera. `hits` are those of the camera rays; misses are left out, so no ray is idle.
RaySet make_shadow_rays(const RaySet& camera_rays, std::span<const Hit> hits, const world::Scene& scene,
                        const Camera& camera);

/// Chords between uniform points of the sphere around everything finite in the scene.
RaySet make_random_rays(const world::Scene& scene, size_t count);

}  // namespace promin::measure
