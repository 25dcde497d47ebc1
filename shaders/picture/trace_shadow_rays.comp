// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Traces the shadow rays of the stream's list.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "shared/layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "shared/bindings.glsl"
#include "picture/film.glsl"
#include "picture/stream.glsl"
#include "picture/stream_records.glsl"
#include "shared/math.glsl"
#include "trace/ray.glsl"
#include "trace/make_ray.glsl"
#include "trace/primitives.glsl"
#include "trace/packet.glsl"
#include "trace/packet_shapes.glsl"
#include "trace/packet_triangles.glsl"
#include "trace/family.glsl"
#include "trace/node_boxes.glsl"
#include "trace/traversal.glsl"
#include "picture/ray_log.glsl"
#include "shade/shading_records.glsl"
#include "shade/glass.glsl"
#include "shade/textures.glsl"
#include "shade/cutouts.glsl"
#include "shade/lights.glsl"
#include "shade/light_way.glsl"
#include "picture/turns.glsl"
#include "shared/group_rows.glsl"
#include "shared/loop_check.glsl"

// Returns the hit that blocks the ray, or the last surface that the ray has passed through. `record` is the record of
// the source's contribution.
Hit go_through_layers(uint record, uvec2 media) {
  LightWay way = light_way(media);
  Hit last = Hit(INFINITY, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
  uint layers = 0u;
  forget_passed(0u);
  for (;;) {
    trace_packet(false);
    if (found[0].primitive == NO_PRIMITIVE) break;
    last = found[0];
    if (!goes_on_behind(way, packet[0], last, layers)) break;
    pass(0u, last.t, last.order);
    ++layers;
  }
  end_way(way, packet[0]);
  precise vec3 contribution = way.arriving * load_record(record).xyz;
  store_vector(record, contribution);
  add_passes(uvec3(layers, 0u, 0u));
  return last;
}

void main() {
  begin_stream();
  uint place = group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (place >= stream.shadow_rays.x) return;
  uint entry = load_word(shadow_list() + place);
  uint path = entry / STREAM_SOURCES;
  uint source = entry % STREAM_SOURCES;
  LightRecord light = load_light(VIEW.first_index.y + first_source(turn - 1u) + source);
  uint origin = RECORD_SHADOW_ORIGIN;
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
    bool is_behind = load_record(record_of_source(path, source) + RECORD_CONTRIBUTION).w != 0.0;
    origin = is_behind ? RECORD_SHADOW_BEHIND : origin;
  }
  Ray ray;
  if (has(FEATURE_SAMPLED_LIGHT)) {
    vec4 way = load_record(record_of_source(path, source) + RECORD_WAY);
    ray = make_ray(load_record(record_of_path(path) + origin).xyz, way.xyz, 0.0, way.w);
  } else {
    ray = shadow_ray(load_record(record_of_path(path) + origin).xyz, light);
  }
  step_counts = uvec2(0u);
  if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = true;
  packet[0] = ray;
  Hit blocker;
  if (PASSES != 0u) {
    uvec2 media = has(FEATURE_GLASS) ? floatBitsToUint(load_record(record_of_glass(path) + RECORD_SHADOW_MEDIA).xy)
                                     : uvec2(NO_MEDIUM);
    blocker = go_through_layers(record_of_source(path, source) + RECORD_CONTRIBUTION, media);
    words[ask_of_source(path, source)] = ASK_NOTHING;
    if (has(FEATURE_RAY_LOG)) log_answer(entry_of_source(source), ray, blocker);
    add_counts(uvec3(0u), were_loops_cut());
    return;
  }
  blocker = trace(ray, true);
  words[ask_of_source(path, source)] = blocker.primitive == NO_PRIMITIVE ? ASK_NOTHING : ASK_BLOCKED;
  if (has(FEATURE_RAY_LOG)) log_answer(entry_of_source(source), ray, blocker);
  add_counts(uvec3(0u), were_loops_cut());
}
