// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Counts each ray's crossings with all primitives or, with LISTS_CROSSINGS, lists them (layout.h, HitRecord). A lane
// traces PACKET_SIZE consecutive rays. Both visit everything that a ray hits, in any order, so ALL_ASK_FOR_ANY suits
// them.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#define ASKS_FOR_ALL true
#include "shared/layout.h"
#include "shared/bindings.glsl"
#include "cast/cast_bindings.glsl"
#include "shared/math.glsl"
#include "trace/ray.glsl"
#include "trace/make_ray.glsl"
#include "trace/primitives.glsl"
#include "trace/packet.glsl"
#include "trace/no_cutouts.glsl"
#include "trace/packet_crossings.glsl"
#include "trace/family.glsl"
#include "trace/node_boxes.glsl"
#include "trace/traversal.glsl"
#include "shared/group_rows.glsl"
#include "shared/loop_check.glsl"

const uint LANES = BLOCK_SIZE * BLOCK_SIZE;
layout(local_size_x = LANES) in;

// Converts an entry of the list to the form that the host reads.
void finish(uint place, Ray ray, float unit) {
  HitRecord record = hits[place];
  vec2 weights = uintBitsToFloat(record.a.zw);
  Hit hit = Hit(uintBitsToFloat(record.a.x), weights.x, weights.y, record.b.y, record.b.x, record.a.y);
  vec3 normal = surface_point(ray, load_primitive(hit.primitive), hit).normal;
  precise float t = hit.t * unit;
  hits[place] = HitRecord(uvec4(floatBitsToUint(t), record.a.yzw), uvec4(floatBitsToUint(normal), record.b.z));
}

void main() {
  uint first = first_ray() + PACKET_SIZE * (group_number() * LANES + gl_LocalInvocationIndex);
  if (first >= end_ray()) return;
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    // A lane with fewer rays than the packet repeats the last ray, whose results are then ignored.
    bool is_ray = first + i < end_ray();
    uint index = is_ray ? first + i : end_ray() - 1u;
    RayRecord request = load_ray(index);
    packet[i] = make_ray(request.origin_tmin.xyz, request.direction_tmax.xyz, request.origin_tmin.w,
                         request.direction_tmax.w);
    units[i] = power_of_two_inverse(max_abs(request.direction_tmax.xyz));
    given_tmins[i] = max(request.origin_tmin.w, 0.0);
    given_tmaxs[i] = request.direction_tmax.w;
    // A larger t would not be finite in units of the given direction.
    precise float farthest = LARGEST_FLOAT * power_of_two_inverse(units[i]);
    packet[i].tmax = is_ray ? (packet[i].tmax < farthest ? packet[i].tmax : farthest) : -1.0;
    crossing_counts[i] = 0u;
    first_places[i] = LISTS_CROSSINGS != 0u ? hits[index].a.y : 0u;
    rooms[i] = LISTS_CROSSINGS != 0u ? hits[index].a.z : 0u;
  }
  step_counts = uvec2(0u);
  trace_packet(true);
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    if (LISTS_CROSSINGS != 0u) {
      uint end = first_places[i] + min(crossing_counts[i], rooms[i]);
      for (uint place = first_places[i]; place < end; ++place) finish(place, packet[i], units[i]);
    }
    if (first + i < end_ray()) hits[first + i].a.x = crossing_counts[i];
  }
  if (were_loops_cut()) dispatch.outcome.x = 1u;
}
