// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Renders: pixels shared out among lanes, shadow rays and mirror bounces in loops.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "bindings.glsl"

// A pixel's sum over samples (bits) and the `order` of what it shows; after all pixels, with FEATURE_AOVS, each one's
// geometric normal and depth (bits). And rays traced, x = primary, y = shadow, z = reflection, and w = times that
// were_loops_cut(), a counter a lane of a block: one for all would have every lane queue for it, and a sum over the
// block would need barriers, for which lavapipe 22.3 runs a coroutine a subgroup and leaks it.
layout(std430, set = 0, binding = BINDING_FILM) buffer Film {
  Dispatch dispatch;
  uvec4 ray_counts[BLOCK_SIZE * BLOCK_SIZE];
  uvec4 pixels[];
};

#include "math.glsl"
#include "ray.glsl"
#include "make_ray.glsl"
#include "primitives.glsl"
#include "traversal.glsl"
#include "debug_shading.glsl"
#include "ray_log.glsl"
#include "secondary.glsl"
#include "lights.glsl"
#include "shading.glsl"
#include "camera.glsl"
#include "loop_check.glsl"

// Bits of the normal, as wound or outward, and of the distance from the ray's origin; infinite on a miss.
uvec4 normal_and_depth(Ray ray, Hit hit) {
  if (hit.primitive == NO_PRIMITIVE) return floatBitsToUint(vec4(0.0, 0.0, 0.0, INFINITY));
  SurfacePoint surface = surface_point(ray, load_primitive(hit.primitive), hit);
  precise float depth = hit.t * length3(ray.direction);
  return floatBitsToUint(vec4(surface.normal, depth));
}

// Whitted's recursion without refraction is a loop: I = sum of (product of kr so far) * Phong.
struct Path {
  Ray ray;
  vec3 weight;    // product of kr so far
  vec3 radiance;  // sum so far
  uint bounces;
};

// Adds what is seen at the hit, and turns the path into its mirror ray. False where it ends.
bool follow(inout Path path, Hit hit, inout uvec3 ray_count) {
  begin_path_log(path.ray, hit, path.bounces, path.weight);
  if (hit.primitive == NO_PRIMITIVE) {
    precise vec3 total = path.radiance + path.weight * frame.background.xyz;
    path.radiance = total;
    log_own_light(frame.background.xyz);
    end_path_log(total);
    return false;
  }
  ShadingPoint point = make_shading_point(path.ray, hit);
  vec3 direction = normalize3(path.ray.direction);
  precise vec3 radiance = path.radiance + path.weight * shade(point, -direction, ray_count.y);
  path.radiance = radiance;
  end_path_log(radiance);
  if (!has(FEATURE_MIRRORS) || path.bounces >= dispatch.range.w) return false;
  precise vec3 weight = path.weight * point.material.reflection.xyz;
  path.weight = weight;
  if (!(max_abs(weight) > 0.0)) return false;
  path.ray = mirror_ray(point, direction);
  ++path.bounces;
  ++ray_count.z;
  return true;
}

// A lane takes its pixel of one block after the other and one sample after the other, without waiting for its
// neighbours' mirror rays: the loop's every turn traces one ray of each lane.
void main() {
  uint block = dispatch.range.x + gl_WorkGroupID.x;
  uint end_block = dispatch.share.x;
  uint end_sample = dispatch.range.y + dispatch.range.z;
  uvec3 ray_count = uvec3(0u);
  uvec2 pixel = uvec2(0u);
  uint index = 0u;
  uint sample_index = end_sample;
  vec3 sum = vec3(0.0);  // of the pixel's samples
  uint order = NO_ORDER;
  Path path;
  bool is_underway = false;
  while (is_underway || sample_index < end_sample || block < end_block) {
    while (!is_underway && (sample_index < end_sample || block < end_block)) {
      if (sample_index == end_sample) {
        pixel = BLOCK_SIZE * uvec2(block % dispatch.sampling.z, block / dispatch.sampling.z) +
                pixel_in_block(gl_LocalInvocationIndex);
        block += gl_NumWorkGroups.x;
        if (any(greaterThanEqual(pixel, dispatch.window.zw))) continue;
        index = pixel.y * dispatch.window.z + pixel.x;
        sample_index = dispatch.range.y;
        uvec4 record = sample_index == 0u ? uvec4(0u, 0u, 0u, NO_ORDER) : pixels[index];
        sum = uintBitsToFloat(record.xyz);
        order = record.w;
      }
      path = Path(camera_ray(pixel, sample_index), vec3(1.0), vec3(0.0), 0u);
      ++ray_count.x;
      is_underway = true;
    }
    if (!is_underway) break;

    if (SHADING == SHADING_STEPS) step_counts = uvec2(0u);
    Hit hit = trace(path.ray, false);
    // Depths and ids have no average: the middle sample stands for the pixel. Of an odd number it is the centre.
    if (has(FEATURE_AOVS) && path.bounces == 0u && sample_index == dispatch.sampling.x / 2u) {
      order = hit.primitive == NO_PRIMITIVE ? NO_ORDER : hit.order;
      pixels[dispatch.window.z * dispatch.window.w + index] = normal_and_depth(path.ray, hit);
    }
    if (SHADING == SHADING_FULL) {
      is_underway = follow(path, hit, ray_count);
    } else {
      path.radiance = debug_color(hit, uintBitsToFloat(normal_and_depth(path.ray, hit)));
      is_underway = false;
    }
    if (!is_underway) {
      precise vec3 next_sum = sum + path.radiance;
      sum = next_sum;
      ++sample_index;
      if (sample_index == end_sample) pixels[index] = uvec4(floatBitsToUint(sum), order);
    }
  }
  atomicAdd(ray_counts[gl_LocalInvocationIndex].x, ray_count.x);
  if (ray_count.y > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].y, ray_count.y);
  if (ray_count.z > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].z, ray_count.z);
  if (were_loops_cut()) atomicAdd(ray_counts[gl_LocalInvocationIndex].w, 1u);
}
