// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Renders: one lane a pixel, `samples` samples each, mirror bounces in a loop.
#version 450
#extension GL_GOOGLE_include_directive : require
#include "layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "bindings.glsl"
#include "math.glsl"
#include "ray.glsl"
#include "primitives.glsl"
#include "traversal.glsl"
#include "lights.glsl"
#include "shading.glsl"
#include "camera.glsl"

// Whitted's recursion without refraction is a loop: I = sum of (product of kr so far) * Phong.
vec3 radiance(Ray ray, inout uvec3 ray_count) {
  vec3 sum = vec3(0.0);
  vec3 weight = vec3(1.0);
  ++ray_count.x;
  for (uint bounce = 0u;; ++bounce) {
    Hit hit = trace(ray, false);
    if (hit.primitive == NO_PRIMITIVE) {
      precise vec3 total = sum + weight * frame.background.xyz;
      return total;
    }
    ShadingPoint point = make_shading_point(ray, hit);
    vec3 direction = normalize3(ray.direction);
    precise vec3 next_sum = sum + weight * shade(point, -direction, ray_count.y);
    sum = next_sum;
    if (!has(FEATURE_MIRRORS) || bounce >= dispatch.range.w) return sum;
    precise vec3 next_weight = weight * point.material.reflection.xyz;
    weight = next_weight;
    if (!(max_abs(weight) > 0.0)) return sum;
    ray = make_ray(lifted_origin(point.position, point), reflect_direction(point, direction), 0.0, INFINITY);
    ++ray_count.z;
  }
}

void main() {
  uint block = dispatch.range.x + gl_WorkGroupID.x;
  uvec2 pixel = BLOCK_SIZE * uvec2(block % dispatch.sampling.z, block / dispatch.sampling.z) +
                pixel_in_block(gl_LocalInvocationIndex);
  if (any(greaterThanEqual(pixel, dispatch.window.zw))) return;

  uint index = pixel.y * dispatch.window.z + pixel.x;
  vec3 sum = dispatch.range.y == 0u ? vec3(0.0) : pixels[index].xyz;
  uvec3 ray_count = uvec3(0u);
  for (uint s = dispatch.range.y; s < dispatch.range.y + dispatch.range.z; ++s) {
    precise vec3 next_sum = sum + radiance(camera_ray(pixel, s), ray_count);
    sum = next_sum;
  }
  pixels[index] = vec4(sum, 0.0);
  atomicAdd(ray_counts[gl_LocalInvocationIndex].x, ray_count.x);
  if (ray_count.y > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].y, ray_count.y);
  if (ray_count.z > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].z, ray_count.z);
}
