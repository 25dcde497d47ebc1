// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Computes the start of the renderer's secondary rays, with the renderer's own code. Writes a record for each ray:
//   a  bits of the lifted origin; bits of the lift
//   b  bits of the mirror direction; the primitive's number in order, NO_ORDER on a miss
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "shared/bindings.glsl"
#include "cast/cast_bindings.glsl"
#include "shared/math.glsl"
#include "trace/ray.glsl"
#include "trace/make_ray.glsl"
#include "trace/primitives.glsl"
#include "trace/packet.glsl"
#include "trace/no_cutouts.glsl"
#include "trace/packet_shapes.glsl"
#include "trace/packet_triangles.glsl"
#include "trace/family.glsl"
#include "trace/node_boxes.glsl"
#include "trace/traversal.glsl"
#include "shade/secondary.glsl"
#include "shared/group_rows.glsl"

void main() {
  uint index = first_ray() + group_number() * BLOCK_SIZE * BLOCK_SIZE + gl_LocalInvocationIndex;
  if (index >= end_ray()) return;
  RayRecord request = load_ray(index);
  Ray ray = make_ray(request.origin_tmin.xyz, request.direction_tmax.xyz, request.origin_tmin.w,
                     request.direction_tmax.w);
  Hit hit = trace(ray, false);
  hits[index] = HitRecord(uvec4(0u), uvec4(0u, 0u, 0u, NO_ORDER));
  if (hit.primitive == NO_PRIMITIVE) return;
  SurfacePoint surface = surface_point(ray, load_primitive(hit.primitive), hit);
  vec3 normal = dot3(surface.normal, ray.direction) > 0.0 ? -surface.normal : surface.normal;
  vec3 origin = lift_off(surface.position, normal, surface.lift);
  vec3 mirrored = reflect_direction(normalize3(ray.direction), normal, normal);
  hits[index] = HitRecord(floatBitsToUint(vec4(origin, surface.lift)),
                          uvec4(floatBitsToUint(mirrored), hit.order));
}
