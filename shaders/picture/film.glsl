// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The buffer that the stages of a picture write to.

// `pixels` holds the records of pixels (layout.h, from AOV_* on), and after them the stream of paths that
// camera_stage.comp leaves to later stages (stream.glsl). `ray_counts` counts rays (x = primary, y = shadow, z =
// reflection) and how often loops were cut (w), `pass_counts` how often rays passed through a surface (x), refracted
// rays (y) and primary rays with a hit (z). Each lane of a workgroup has its own counter. With a single counter all
// lanes would wait for each other. A sum over the group would need barriers, for which lavapipe 22.3 creates a
// coroutine per subgroup that it never frees.
layout(std430, set = 0, binding = BINDING_FILM) buffer Film {
  FILM_HEAD(dispatch, film_stream, ray_counts, pass_counts)
  uvec4 pixels[];
};

#include "shared/dispatch.glsl"

// Adds to this lane's counts: x = surfaces passed through, y = refracted rays, z = primary rays with a hit.
void add_passes(uvec3 counts) {
  uint lane = gl_LocalInvocationIndex;
  if (counts.x > 0u) atomicAdd(pass_counts[lane].x, counts.x);
  if (has(FEATURE_GLASS) && counts.y > 0u) atomicAdd(pass_counts[lane].y, counts.y);
  if (counts.z > 0u) atomicAdd(pass_counts[lane].z, counts.z);
}

// Adds this lane's counts. It must be the last call in main().
void add_counts(uvec3 rays, bool is_cut) {
  uint lane = gl_LocalInvocationIndex;
  if (rays.x > 0u) atomicAdd(ray_counts[lane].x, rays.x);
  if (rays.y > 0u) atomicAdd(ray_counts[lane].y, rays.y);
  if (rays.z > 0u) atomicAdd(ray_counts[lane].z, rays.z);
  if (is_cut) atomicAdd(ray_counts[lane].w, 1u);
}
