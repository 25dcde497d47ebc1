// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Renders: one lane a pixel, `samples` samples each, mirror bounces in a loop.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "bindings.glsl"

// A pixel's sum over samples (bits) and the `order` of what it shows; after all pixels, with FEATURE_AOVS, each one's
// geometric normal and depth (bits). And rays traced, x = primary, y = shadow, z = reflection, a counter a lane of a
// block: one for all would have every lane queue for it, and a sum over the block would need barriers, for which
// lavapipe 22.3 runs a coroutine a subgroup and leaks it.
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
#include "secondary.glsl"
#include "lights.glsl"
#include "shading.glsl"
#include "camera.glsl"

// Whitted's recursion without refraction is a loop: I = sum of (product of kr so far) * Phong. `first` becomes the
// primary ray's hit.
vec3 radiance(Ray ray, inout uvec3 ray_count, out Hit first) {
  vec3 sum = vec3(0.0);
  vec3 weight = vec3(1.0);
  ++ray_count.x;
  for (uint bounce = 0u;; ++bounce) {
    Hit hit = trace(ray, false);
    if (bounce == 0u) first = hit;
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
    ray = mirror_ray(point, direction);
    ++ray_count.z;
  }
}

// Bits of the normal, as wound or outward, and of the distance from the ray's origin; infinite on a miss.
uvec4 normal_and_depth(Ray ray, Hit hit) {
  if (hit.primitive == NO_PRIMITIVE) return floatBitsToUint(vec4(0.0, 0.0, 0.0, INFINITY));
  SurfacePoint surface = surface_point(ray, load_primitive(hit.primitive), hit);
  precise float depth = hit.t * length3(ray.direction);
  return floatBitsToUint(vec4(surface.normal, depth));
}

void main() {
  uint block = dispatch.range.x + gl_WorkGroupID.x;
  uvec2 pixel = BLOCK_SIZE * uvec2(block % dispatch.sampling.z, block / dispatch.sampling.z) +
                pixel_in_block(gl_LocalInvocationIndex);
  if (any(greaterThanEqual(pixel, dispatch.window.zw))) return;

  uint index = pixel.y * dispatch.window.z + pixel.x;
  uvec4 record = dispatch.range.y == 0u ? uvec4(0u) : pixels[index];
  vec3 sum = uintBitsToFloat(record.xyz);
  uvec3 ray_count = uvec3(0u);
  for (uint s = dispatch.range.y; s < dispatch.range.y + dispatch.range.z; ++s) {
    Ray ray = camera_ray(pixel, s);
    Hit hit;
    precise vec3 next_sum = sum + radiance(ray, ray_count, hit);
    sum = next_sum;
    // Depths and ids have no average: the middle sample stands for the pixel. Of an odd number it is the centre.
    if (has(FEATURE_AOVS) && s == dispatch.sampling.x / 2u) {
      record.w = hit.primitive == NO_PRIMITIVE ? NO_ORDER : hit.order;
      pixels[dispatch.window.z * dispatch.window.w + index] = normal_and_depth(ray, hit);
    }
  }
  pixels[index] = uvec4(floatBitsToUint(sum), record.w);
  atomicAdd(ray_counts[gl_LocalInvocationIndex].x, ray_count.x);
  if (ray_count.y > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].y, ray_count.y);
  if (ray_count.z > 0u) atomicAdd(ray_counts[gl_LocalInvocationIndex].z, ray_count.z);
}
