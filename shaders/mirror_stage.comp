// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The second stage of a picture traces the paths that camera_stage.comp has put into the queue, with all of their
// mirror rays and shadow rays. These go everywhere, so lanes do not wait for each other: every turn of the loop traces
// one ray of each lane, which may belong to its path or go to a source.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "layout.h"

layout(local_size_x = BLOCK_SIZE * BLOCK_SIZE) in;

#include "bindings.glsl"
#include "film.glsl"
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
#include "secondary.glsl"
#include "lights.glsl"
#include "shading.glsl"
#include "path.glsl"
#include "loop_check.glsl"

uvec3 ray_count = uvec3(0u);

Path path;
uint bounces;
ShadingPoint point;  // the point that the path has reached
vec3 seen;           // light that the point sends, summed so far
uint source;         // the next one to look at; source_count() after the last
vec3 contribution;   // of the source that the shadow ray goes to
Ray ray;             // to trace next
bool is_to_source;   // it is a shadow ray

void follow_path() {
  ray = make_ray(path.origin, path.direction, 0.0, INFINITY);
  is_to_source = false;
  ++bounces;
  ++ray_count.z;
}

// Shades the hit. False where the path ends.
bool arrive(Hit hit) {
  begin_path_log(ray, hit, bounces, path.weight);
  bool is_miss = hit.primitive == NO_PRIMITIVE;
  seen = VIEW.background.xyz;
  if (!is_miss) {
    path.direction = normalize3(ray.direction);
    point = make_shading_point(ray, hit);
    seen = own_light(point);
  }
  log_own_light(seen);
  source = is_miss ? source_count() : 0u;
  return !is_miss;
}

void add_contribution(vec3 unblocked) {
  end_source_log(unblocked);
  precise vec3 sum = seen + unblocked;
  seen = sum;
  ++source;
}

// Takes the sources in turn, up to one that needs a shadow ray. False where no source is left.
bool aim_at_source() {
  while (source < source_count()) {
    begin_source_log(source);
    LightRecord light = load_light(VIEW.first_index.y + source);
    LightSample sampled = sample_light(light, point.position);
    contribution = unshadowed_contribution(point, -path.direction, light, sampled);
    if (has(FEATURE_SHADOWS) && max_abs(contribution) > 0.0) {
      ray = shadow_ray(point, light, sampled);
      is_to_source = true;
      ++ray_count.y;
      return true;
    }
    add_contribution(contribution);
  }
  return false;
}

// Adds the point to the path and turns to its mirror ray. False where the path ends.
bool leave(bool is_on_surface) {
  add_radiance(path, seen);
  end_path_log(path.radiance);
  return is_on_surface && bounces < most_bounces() && bounce(path, point);
}

void main() {
  uint left = dispatch.queue.w;
  bool is_underway = false;
  for (;;) {
    while (!is_underway && left > 0u) {
      is_underway = take_path(path);
      left = is_underway ? left - 1u : 0u;
      bounces = 0u;
      if (is_underway) follow_path();
    }
    if (!is_underway) break;
    Hit hit = trace(ray, is_to_source);
    bool is_on_surface = true;
    if (is_to_source) {
      log_shadow_ray(ray, hit);
      add_contribution(hit.primitive == NO_PRIMITIVE ? contribution : vec3(0.0));
    } else {
      is_on_surface = arrive(hit);
    }
    if (aim_at_source()) continue;
    if (leave(is_on_surface)) {
      follow_path();
    } else {
      finish_path(path);
      is_underway = false;
    }
  }
  add_counts(ray_count, were_loops_cut());
}
