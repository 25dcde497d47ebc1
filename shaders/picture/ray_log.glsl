// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// FEATURE_RAY_LOG stores the rays of a picture of one pixel after that pixel in the film. The log contains the
// picture's own numbers; this file computes none.

layout(std430, set = 0, binding = BINDING_FILM) buffer LoggedFilm {
  FILM_HEAD(logged_dispatch, logged_stream, logged_ray_counts, logged_pass_counts)
  uvec4 logged_pixel;
  uvec4 log_count;  // x = number of entries
  RayLog logs[];
};

RayLog path_log;    // entry of the current ray of the path
RayLog source_log;  // entry of the current source

// Starts the log with the first ray of a sample.
void begin_log() {
  if (has(FEATURE_RAY_LOG)) log_count.x = 0u;
}

void append_log(RayLog log) {
  logs[log_count.x] = log;
  ++log_count.x;
}

void log_ray(inout RayLog log, Ray ray, Hit hit) {
  log.origin_tmin = vec4(ray.origin, ray.tmin);
  log.direction_tmax = vec4(ray.direction, ray.tmax);
  bool is_miss = hit.primitive == NO_PRIMITIVE;
  log.hit = uvec4(floatBitsToUint(is_miss ? INFINITY : hit.t), is_miss ? NO_ORDER : hit.order,
                  floatBitsToUint(vec2(hit.u, hit.v)));
}

RayLog empty_log(uint kind, uint number) {
  return RayLog(uvec4(kind, number, 0u, 0u), vec4(0.0), vec4(0.0), uvec4(0u, NO_ORDER, 0u, 0u), vec4(0.0), vec4(0.0),
                vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
}

void begin_source_log(uint light) {
  if (has(FEATURE_RAY_LOG)) source_log = empty_log(LOG_SOURCE, light);
}

void log_shadow_ray(Ray ray, Hit blocker) {
  if (!has(FEATURE_RAY_LOG)) return;
  source_log.ids.w = 1u;
  log_ray(source_log, ray, blocker);
}

void end_source_log(vec3 contribution) {
  if (!has(FEATURE_RAY_LOG)) return;
  source_log.radiance = vec4(contribution, 0.0);
  append_log(source_log);
}

void begin_path_log(Ray ray, Hit hit, uint bounce, vec3 weight, uint kind) {
  if (!has(FEATURE_RAY_LOG)) return;
  path_log = empty_log(LOG_PATH, bounce);
  path_log.ids.w = kind;
  log_ray(path_log, ray, hit);
  path_log.weight = vec4(weight, 0.0);
}

void log_surface(vec3 position, float lift, vec3 normal, vec3 shading_normal, uint material) {
  path_log.position = vec4(position, lift);
  path_log.normal = vec4(normal, 0.0);
  path_log.shading_normal = vec4(shading_normal, 0.0);
  path_log.ids.z = material;
}

void log_own_light(vec3 own) {
  if (has(FEATURE_RAY_LOG)) path_log.own = vec4(own, 0.0);
}

void end_path_log(vec3 radiance, float coverage) {
  if (!has(FEATURE_RAY_LOG)) return;
  path_log.weight.w = coverage;
  path_log.radiance = vec4(radiance, 0.0);
  append_log(path_log);
}

// Adds a shadow ray's result to an entry of an earlier dispatch. The last entry belongs to the path; the entries before
// it are the light sources of the last turn. `entry` counts from the end: 1 is the last.
void log_answer(uint entry, Ray ray, Hit blocker) {
  RayLog log = logs[log_count.x - entry];
  log_ray(log, ray, blocker);
  logs[log_count.x - entry].origin_tmin = log.origin_tmin;
  logs[log_count.x - entry].direction_tmax = log.direction_tmax;
  logs[log_count.x - entry].hit = log.hit;
  logs[log_count.x - entry].ids.w = 1u;
}

void log_sum(uint entry, vec3 radiance) {
  if (has(FEATURE_RAY_LOG)) logs[log_count.x - entry].radiance = vec4(radiance, 0.0);
}
