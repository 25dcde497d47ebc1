// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What the stages of a picture write.

// A pixel's sum over samples (bits) and the `order` of what it shows; after all pixels, with FEATURE_AOVS, each one's
// geometric normal and depth (bits); after these, from dispatch.queue.x on, the paths that camera_stage.comp leaves to
// mirror_stage.comp. And rays traced, x = primary, y = shadow, z = reflection, and w = times that were_loops_cut(), a
// counter a lane of a workgroup: one for all would have every lane queue for it, and a sum over the group would need
// barriers, for which lavapipe 22.3 runs a coroutine a subgroup and leaks it.
layout(std430, set = 0, binding = BINDING_FILM) buffer Film {
  Dispatch dispatch;
  uvec4 ray_counts[BLOCK_SIZE * BLOCK_SIZE];
  uvec4 pixels[];
};

#include "dispatch.glsl"

// A lane's last words.
void add_counts(uvec3 rays, bool is_cut) {
  uint lane = gl_LocalInvocationIndex;
  if (rays.x > 0u) atomicAdd(ray_counts[lane].x, rays.x);
  if (rays.y > 0u) atomicAdd(ray_counts[lane].y, rays.y);
  if (rays.z > 0u) atomicAdd(ray_counts[lane].z, rays.z);
  if (is_cut) atomicAdd(ray_counts[lane].w, 1u);
}
