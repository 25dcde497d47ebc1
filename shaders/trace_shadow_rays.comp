// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Answers the shadow rays of the stream's list.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "bindings.glsl"
#include "film.glsl"
#include "stream.glsl"
#include "stream_records.glsl"
#include "math.glsl"
#include "ray.glsl"
#include "make_ray.glsl"
#include "primitives.glsl"
#include "packet.glsl"
#include "packet_triangles.glsl"
#include "family.glsl"
#include "node_boxes.glsl"
#include "traversal.glsl"
#include "ray_log.glsl"
#include "shading_records.glsl"
#include "lights.glsl"
#include "turns.glsl"
#include "group_rows.glsl"
#include "loop_check.glsl"

void main() {
  begin_stream();
  uint place = group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (place >= stream.shadow_rays.x) return;
  uint entry = load_word(shadow_list() + place);
  uint path = entry / STREAM_SOURCES;
  uint source = entry % STREAM_SOURCES;
  LightRecord light = load_light(VIEW.first_index.y + first_source(turn - 1u) + source);
  Ray ray = shadow_ray(load_record(record_of_path(path) + RECORD_SHADOW_ORIGIN).xyz, light);
  step_counts = uvec2(0u);
  Hit blocker = trace(ray, true);
  words[ask_of_source(path, source)] = blocker.primitive == NO_PRIMITIVE ? ASK_NOTHING : ASK_BLOCKED;
  if (has(FEATURE_RAY_LOG)) log_answer(entry_of_source(source), ray, blocker);
  add_counts(uvec3(0u), were_loops_cut());
}
