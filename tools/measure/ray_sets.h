// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "promin/ray.h"
#include "scene/world_scene.h"

namespace promin::measure {

/// Rays of one kind in the order in which they are cast, with the query they are cast for. They have the same bits
/// every time.
struct RaySet {
  std::string name;
  HitQuery query = HitQuery::kNearest;
  std::vector<Ray> rays;
};

/// Returns a ray from `origin` towards `target`, both rounded to fp32; the direction has unit length to rounding.
Ray ray_towards(const dvec3& origin, const dvec3& target);

/// Returns a ray through the centre of each pixel of a picture, row by row.
RaySet make_camera_rays(const Camera& camera, const uvec2& size);

/// Returns a ray from each point that a camera ray sees, a little off its surface, to one light: the scene's first, or
/// a point beside the camera if the scene has no light. `hits` are the hits of the camera rays; misses are left out, so
/// that no ray is idle.
RaySet make_shadow_rays(const RaySet& camera_rays, std::span<const Hit> hits, const world::Scene& scene,
                        const Camera& camera);

/// Returns chords between uniform points of the sphere around everything finite in the scene.
RaySet make_random_rays(const world::Scene& scene, size_t count);

}  // namespace promin::measure
