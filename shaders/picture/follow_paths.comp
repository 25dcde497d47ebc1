// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Ends a turn of the stream. For each path of its list it adds the contributions of shadow rays that were not blocked,
// traces the path's ray, shades its hit, and requests shadow rays and the mirror ray. If there are more light sources
// than a turn can take, a bounce takes several turns, which trace the same ray again; the last one requests the mirror
// ray.
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
#include "shade/secondary.glsl"
#include "shade/shading_records.glsl"
#include "shade/lights.glsl"
#include "shade/environment.glsl"
#include "shade/shading.glsl"
// Sums are loaded from the storage buffer: a lane may add twice to a part in a turn, and texels would not contain the
// first addition.
#define load_sum(record) uintBitsToFloat(pixels[record])
#include "picture/path.glsl"
#include "picture/tree.glsl"
#include "picture/scatter.glsl"
#include "picture/turns.glsl"
#include "picture/ray_bins.glsl"
#include "shared/group_rows.glsl"
#include "shared/loop_check.glsl"

uint shadow_ray_count = 0u;
uint mirror_ray_count = 0u;
uint refraction_count = 0u;
uint pass_count = 0u;

// Returns the number of bounces before the path's ray.
uint bounces_of(Path path) { return KEEPS_PROGRESS != 0u ? path.bounces : turn / turns_of_bounce() + 1u; }

// Adds the light sources of the last turn to the radiance.
vec3 add_contributions(uint path, vec3 seen) {
  uint sources = sources_at(turn - 1u);
  uint source = 0u;
  do {
    if (source < sources) {
      vec3 unshadowed = load_record(record_of_source(path, source) + RECORD_CONTRIBUTION).xyz;
      bool is_blocked = load_word(ask_of_source(path, source)) == ASK_BLOCKED;
      precise vec3 contribution = is_blocked ? vec3(0.0) : unshadowed;
      precise vec3 sum = seen + contribution;
      seen = sum;
      if (has(FEATURE_RAY_LOG)) log_sum(entry_of_source(source), contribution);
      ++source;
    }
  } while (source < sources);
  return seen;
}

// Chooses the sample of a light source of the current bounce. Each bounce has a pair of dimensions for each source.
void choose_source_sample(uint path, uint source) {
  uvec2 id = uvec2(sample_key, sample_number);
  if (TRACES_SHADOWS == 0u) id = floatBitsToUint(load_record(record_of_path(path) + RECORD_SAMPLE).xy);
  choose_sample(id, FIRST_LIGHT_PAIR + (turn / turns_of_bounce() + 1u) * source_count() + source);
}

// With FEATURE_SHADOW_CATCHERS: the light of the current point without the sources of this turn.
vec3 left_of_caught;

// Stores the unblocked contribution of a light source of this turn, and requests the source's shadow ray.
void ask_source(uint path, uint source, ShadingPoint point, vec3 to_eye) {
  LightRecord light = load_light(VIEW.first_index.y + first_source(turn) + source);
  LightSample sampled;
  if (has(FEATURE_SAMPLED_LIGHT)) {
    choose_source_sample(path, first_source(turn) + source);
    sampled = sample_light_or_lobe(point, to_eye, light);
  } else {
    sampled = sample_light(light, point.position);
  }
  vec3 contribution = unshadowed_contribution(point, to_eye, light, sampled);
  store_vector(record_of_source(path, source) + RECORD_CONTRIBUTION, contribution);
  if (has(FEATURE_SHADOW_CATCHERS)) left_of_caught = without_caught(point, contribution, left_of_caught);
  begin_source_log(first_source(turn) + source);
  end_source_log(contribution);
  uint asked = ASK_NOTHING;
  if (max_abs(contribution) > 0.0) {
    bool is_behind = has(FEATURE_DIFFUSE_TRANSMISSION) && lies_behind(point, sampled.direction);
    if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
      pixels[record_of_source(path, source) + RECORD_CONTRIBUTION].w = floatBitsToUint(is_behind ? 1.0 : 0.0);
    }
    vec3 origin = is_behind ? shadow_origin_behind(point) : shadow_origin(point);
    vec3 to_source = direction_to_source(origin, light, sampled);
    if (has(FEATURE_SAMPLED_LIGHT)) {
      Ray ray = sampled_shadow_ray(point, origin, light, sampled);
      pixels[record_of_source(path, source) + RECORD_WAY] = floatBitsToUint(vec4(ray.direction, ray.tmax));
      to_source = ray.direction;
    }
    asked = ask(LIST_OF_SHADOW_RAYS, bin_of(origin, to_source));
    ++shadow_ray_count;
  }
  words[ask_of_source(path, source)] = asked;
}

// Requests the shadow rays of all sources of this turn.
void ask_sources(uint path, ShadingPoint point, vec3 to_eye) {
  // Shadow rays of a path share their origins.
  store_vector(record_of_path(path) + RECORD_SHADOW_ORIGIN, shadow_origin(point));
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
    store_vector(record_of_path(path) + RECORD_SHADOW_BEHIND, shadow_origin_behind(point));
  }
  uint sources = sources_at(turn);
  uint source = 0u;
  do {
    if (source < sources) {
      ask_source(path, source, point, to_eye);
      ++source;
    }
  } while (source < sources);
  // The last turn of a bounce may have fewer sources. The remaining requests are cleared, so that answers of the turn
  // before do not count as requests.
  for (; source < sources_of_turn; ++source) words[ask_of_source(path, source)] = ASK_NOTHING;
}

// Adds all light sources to the radiance, if no object casts shadows or with TRACES_SHADOWS.
vec3 add_sources(uint path, ShadingPoint point, vec3 to_eye, vec3 seen) {
  uint source = 0u;
  do {
    if (source < source_count()) {
      LightRecord light = load_light(VIEW.first_index.y + source);
      LightSample sampled;
      if (has(FEATURE_SAMPLED_LIGHT)) {
        choose_source_sample(path, source);
        sampled = sample_light_or_lobe(point, to_eye, light);
      } else {
        sampled = sample_light(light, point.position);
      }
      vec3 contribution = unshadowed_contribution(point, to_eye, light, sampled);
      if (has(FEATURE_SHADOW_CATCHERS)) seen = without_caught(point, contribution, seen);
      if (has(FEATURE_SHADOWS) && TRACES_SHADOWS != 0u) {
        packet[0].tmax = -1.0;
        passes_backs = false;
        if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = true;
        sight_width = 0.0;
        sight_spread = 0.0;
        if (max_abs(contribution) > 0.0) {
          Ray ray = shadow_ray(point, light, sampled);
          packet[0] = ray;
          ++shadow_ray_count;
        }
        trace_packet(true);
        contribution = found[0].primitive == NO_PRIMITIVE ? contribution : vec3(0.0);
      }
      precise vec3 sum = seen + contribution;
      seen = sum;
      begin_source_log(source);
      end_source_log(contribution);
      ++source;
    }
  } while (source < source_count());
  return seen;
}

// Returns the kind (LOG_*) of the path's ray.
uint kind_of_ray(Path path) {
  if (has(FEATURE_GLASS)) return path.kind;
  return has(FEATURE_BLENDING) && path.passed_t >= 0.0 ? LOG_THROUGH : LOG_REFLECTION;
}

// The values of store_passed and store_glass for the current path. Set by prepare_sight.
uint path_progress;
uvec4 path_glass;

// Requests the path's next ray.
uint ask_ray(uint number, Path path) {
  store_vector(record_of_weight(number, turn + 1u), path.weight);
  store_vector(record_of_path(number) + RECORD_ORIGIN, path.origin);
  store_vector(record_of_path(number) + RECORD_DIRECTION, path.direction);
  store_passed(number, path);
  store_part_of_ray(path);
  if (SEES_ENVIRONMENT) pixels[record_of_path(number) + RECORD_DIRECTION].w = floatBitsToUint(path.roughness);
  if (has(FEATURE_TEXTURES)) {
    pixels[record_of_path(number) + RECORD_RADIANCE].w = floatBitsToUint(path.cone_width);
    pixels[record_of_path(number) + RECORD_SEEN].w = floatBitsToUint(path.cone_spread);
  }
  return ask(LIST_OF_PATHS, bin_of(path.origin, path.direction));
}

// With FEATURE_SCATTERING: requests the ray in which the point scatters the path. If the path ends here, does the same
// as ask_mirror.
uint ask_scattered(uint number, inout Path path, ShadingPoint point, bool touches) {
  bool goes_on =
      leads_on(point, bounces_of(path)) && scatter(path, point, turn / turns_of_bounce() + 1u, touches);
  if (has(FEATURE_GLASS)) store_glass(number, path, 0u, true);
  if (TRACES_SHADOWS != 0u) {
    if (!goes_on) return ASK_NOTHING;
    ++mirror_ray_count;
    store_scattered(number, path);
    store_part_of_ray(path);
    return ask(LIST_OF_PATHS, bin_of(path.origin, path.direction));
  }
  if (!goes_on) return ask(LIST_OF_PATHS, BIN_WITHOUT_RAY);
  bool is_refracted = has(FEATURE_GLASS) && path.kind == LOG_REFRACTION;
  refraction_count += is_refracted ? 1u : 0u;
  mirror_ray_count += is_refracted ? 0u : 1u;
  store_scattering(number);
  return ask_ray(number, path);
}

// Requests the path's mirror ray. If there is none, requests the turn after the shadow rays for which the path waits.
uint ask_mirror(uint number, inout Path path, ShadingPoint point) {
  if (!leads_on(point, bounces_of(path)) || !bounce(path, point)) return ask(LIST_OF_PATHS, BIN_WITHOUT_RAY);
  ++mirror_ray_count;
  return ask_ray(number, path);
}

// With FEATURE_GLASS, to be called at the end of a ray: requests the last of the waiting rays. If no ray waits, does
// the same as ask_mirror. `path` has the number of rays and the radiance so far.
uint ask_waiting(uint number, Path path, bool has_seen) {
  uint waiting = path_glass.w & ((1u << KIND_SHIFT) - 1u);
  if (waiting == 0u) {
    store_glass(number, path, 0u, has_seen);
    return ask(LIST_OF_PATHS, BIN_WITHOUT_RAY);
  }
  --waiting;
  uint record = record_of_waiting(number, waiting);
  vec4 origin = load_record(record);
  vec4 direction = load_record(record + 1u);
  vec4 weight = load_record(record + 2u);
  uvec4 rest = floatBitsToUint(load_record(record + 3u));
  path.origin = origin.xyz;
  path.cone_width = origin.w;
  path.direction = direction.xyz;
  path.cone_spread = direction.w;
  path.weight = weight.xyz;
  path.roughness = weight.w;
  path.media = rest.xy;
  path.bounces = rest.z & WAITING_BOUNCES_MASK;
  path.part = (rest.z & WAITING_IS_TRANSMITTED) != 0u ? PART_TRANSMISSION : PART_REFLECTION;
  path.skipped = rest.z >> WAITING_OBJECT_SHIFT;
  path.skip = uintBitsToFloat(rest.w);
  path.kind = LOG_REFRACTION;
  path.passed_t = -1.0;
  path.passed_order = 0u;
  store_glass(number, path, waiting, has_seen);
  return ask_ray(number, path);
}

// Requests the rays on which a path continues at a point on glass.
uint ask_beyond(uint number, inout Path path, ShadingPoint point, bool touches) {
  Children children;
  part_path(path, point, touches, children);
  store_vector(record_of_path(number) + RECORD_RADIANCE, path.radiance);
  mirror_ray_count += children.is_mirrored ? 1u : 0u;
  uint refracted = count_refracted(children);
  refraction_count += refracted;
  if (!children.is_mirrored && refracted == 0u) return ask_waiting(number, path, true);
  uint waiting = path_glass.w & ((1u << KIND_SHIFT) - 1u);
  store_glass(number, path, store_children(number, waiting, children, point, touches), true);
  return ask_ray(number, path);
}

// With FEATURE_GLASS, returns the request of a path whose ray has missed while other rays wait. Waiting rays start with
// a bounce, so until then the path requests the same ray again.
uint ask_after_miss(uint number, Path path, Ray ray) {
  store_vector(record_of_path(number) + RECORD_RADIANCE, path.radiance);
  for (uint source = 0u; source < sources_of_turn; ++source) words[ask_of_source(number, source)] = ASK_NOTHING;
  if (begins_bounce(turn + 1u)) return ask_waiting(number, path, false);
  store_vector(record_of_weight(number, turn + 1u), path.weight);
  return ask(LIST_OF_PATHS, bin_of(ray.origin, ray.direction));
}

// Requests the continuation of the path's ray behind its hit.
uint ask_through(uint number, inout Path path, Ray ray, Hit hit, float coverage) {
  precise vec3 weight = coverage * path.weight;
  store_vector(record_of_weight(number, turn), weight);
  go_through(path, ray, hit.t, hit.order, coverage);
  store_vector(record_of_weight(number, turn + 1u), path.weight);
  store_vector(record_of_path(number) + RECORD_DIRECTION, path.direction);
  store_passed(number, path);
  if (has(FEATURE_GLASS)) store_glass(number, path, path_glass.w & ((1u << KIND_SHIFT) - 1u), true);
  ++pass_count;
  return ask(LIST_OF_PATHS, bin_of(path.origin, path.direction));
}

// Shades the hit of the path's ray. Returns the path's request.
uint shade(uint number, inout Path path, vec3 seen, Ray ray, Hit hit) {
  uint bounces = bounces_of(path);
  if (hit.primitive == NO_PRIMITIVE) {
    bool has_waiting = has(FEATURE_GLASS) && (path_glass.w & ((1u << KIND_SHIFT) - 1u)) != 0u;
    // While other rays wait, the same ray may be traced several times.
    if (has_waiting && !begins_bounce(turn + 1u)) return ask_after_miss(number, path, ray);
    begin_path_log(ray, hit, bounces, path.weight, kind_of_ray(path));
    bool is_of_camera = has(FEATURE_BLENDING) && bounces == 0u;
    vec3 beyond = is_of_camera ? radiance_behind(ray.origin, normalize3(ray.direction), true)
                               : radiance_beyond(ray.origin, ray.direction, path.roughness);
    if (has(FEATURE_SCATTERING)) beyond = share_of_ray(beyond);
    if (has(FEATURE_UNLIT_SHARE) && is_of_camera) add_backdrop(path, beyond);
    add_radiance(path, beyond, 1.0);
    add_beyond(path, beyond);
    log_own_light(beyond);
    end_path_log(path.radiance, 1.0);
    if (has_waiting) return ask_after_miss(number, path, ray);
    if (TRACES_SHADOWS == 0u) finish_path(path);
    return ASK_NOTHING;
  }
  vec3 weight_at_start = path.weight;
  absorb(path, ray, hit);
  begin_path_log(ray, hit, bounces, path.weight, kind_of_ray(path));
  path.direction = normalize3(ray.direction);
  widen_cone(path, ray, hit);
  ShadingPoint point;
  make_shading_point(ray, path.direction, hit, path.cone_width, path.media, color_of(path.weight), point);
  float coverage = coverage_of(path, point);
  vec3 own = own_light(point, path.direction, coverage == 1.0 && leads_on(point, bounces));
  // Planes and unlit surfaces are no sources, so their light arrives by rays alone.
  if (has(FEATURE_SCATTERING) && LAMP_FEATURES != 0u && model_of(point) != MATERIAL_UNLIT &&
      hit.primitive < first_unbounded()) {
    own = share_of_ray(own);
  }
  log_own_light(own);
  if (begins_bounce(turn)) {
    seen = own;
    if (has(FEATURE_UNLIT_SHARE)) add_unlit(path, bounces, point, own, coverage);
    if (has(FEATURE_LIGHT_AOVS)) {
      store_seen_part(path, own);
      add_own_parts(path, point, own, coverage);
    }
  }
  if (has(FEATURE_SHADOW_CATCHERS)) {
    left_of_caught = seen;
    // The light of the point is a factor of what is behind it.
    bool is_of_camera = has(FEATURE_BLENDING) && bounces == 0u;
    vec3 behind = is_of_camera ? radiance_behind(ray.origin, path.direction, true)
                               : radiance_beyond(ray.origin, ray.direction, path.roughness);
    if (has(FEATURE_SCATTERING)) behind = share_of_ray(behind);
    precise vec3 shown = path.weight * behind;
    if (catches_shadows(point)) path.weight = shown;
    store_vector(record_of_weight(number, turn), path.weight);
  }
  if (has(FEATURE_SHADOWS) && TRACES_SHADOWS == 0u) {
    ask_sources(number, point, -path.direction);
    if (has(FEATURE_SHADOW_CATCHERS)) seen = left_of_caught;
  } else {
    seen = add_sources(number, point, -path.direction, seen);
  }
  if (TRACES_SHADOWS != 0u) {
    add_radiance(path, seen, 1.0);
    if (has(FEATURE_LIGHT_AOVS)) add_seen_part(path.pixel, path.part, path.weight, own, seen);
    return ask_scattered(number, path, point, false);
  }
  store_vector(record_of_path(number) + RECORD_RADIANCE, path.radiance);
  store_vector(record_of_path(number) + RECORD_SEEN, seen);
  if (has(FEATURE_GLASS)) pixels[record_of_glass(number) + RECORD_SHADOW_MEDIA].xy = path.media;
  if (begins_bounce(turn + 1u)) {
    end_path_log(path.radiance, coverage);
    if (has(FEATURE_GLASS)) store_vector(record_of_weight(number, turn), path.weight);
    if (has(FEATURE_BLENDING) && coverage < 1.0) return ask_through(number, path, ray, hit, coverage);
    if (has(FEATURE_SCATTERING)) {
      return ask_scattered(number, path, point, has(FEATURE_GLASS) && hit.t <= skipped_until);
    }
    if (has(FEATURE_GLASS)) return ask_beyond(number, path, point, hit.t <= skipped_until);
    return ask_mirror(number, path, point);
  }
  // The weight is stored again, because the same ray is traced again.
  store_vector(record_of_weight(number, turn + 1u), weight_at_start);
  return ask(LIST_OF_PATHS, bin_of(ray.origin, ray.direction));
}

void follow(uint number, bool has_ray, Ray ray, Hit hit) {
  if (has(FEATURE_SCATTERING)) load_scattering(number);
  uint record = record_of_path(number);
  Path path;
  path.pixel = pixels[record + RECORD_ORIGIN].w;
  path.radiance = load_record(record + RECORD_RADIANCE).xyz;
  path.weight = load_record(record_of_weight(number, turn)).xyz;
  if (has(FEATURE_TEXTURES)) {
    path.cone_width = load_record(record + RECORD_RADIANCE).w;
    path.cone_spread = load_record(record + RECORD_SEEN).w;
  }
  if (KEEPS_PROGRESS != 0u) {
    path.passed_t = passed_t[0];
    path.passed_order = passed_order[0];
    path.layers = path_progress >> LAYERS_SHIFT;
    path.bounces = path_progress & ((1u << LAYERS_SHIFT) - 1u);
  }
  bool has_seen = turn > 0u;
  path.media = uvec2(NO_MEDIUM);
  if (has(FEATURE_GLASS)) {
    path.media = path_glass.xy;
    path.skip = 0.0;
    path.skipped = 0u;
    path.rays = path_glass.z & ((1u << HAS_SEEN_SHIFT) - 1u);
    path.kind = path_glass.w >> KIND_SHIFT;
    has_seen = !begins_bounce(turn) || (path_glass.z >> HAS_SEEN_SHIFT) != 0u;
  }
  uvec4 seen_part = uvec4(0u, 0u, 0u, PART_REFLECTION);
  path.part = PART_REFLECTION;
  if (STREAM_HAS_PARTS != 0u) {
    seen_part = pixels[record_of_part(path.pixel, PART_SEEN)];
    path.part = seen_part.w >> PART_OF_RAY_SHIFT;
  }
  path.roughness = SEES_ENVIRONMENT ? load_record(record + RECORD_DIRECTION).w : NO_ENVIRONMENT;
  vec3 seen = vec3(0.0);
  if (has_seen) {
    seen = load_record(record + RECORD_SEEN).xyz;
    if (has(FEATURE_SHADOWS)) seen = add_contributions(number, seen);
    if (begins_bounce(turn)) {
      vec3 weight = load_record(record_of_weight(number, turn - 1u)).xyz;
      precise vec3 sum = path.radiance + weight * seen;
      path.radiance = sum;
      if (has(FEATURE_LIGHT_AOVS)) {
        uint part = seen_part.w & ((1u << PART_OF_RAY_SHIFT) - 1u);
        add_seen_part(path.pixel, part, weight, uintBitsToFloat(seen_part.xyz), seen);
      }
      if (has(FEATURE_RAY_LOG)) log_sum(1u, path.radiance);
    }
  }
  uint asked = ASK_NOTHING;
  if (has_ray) {
    asked = shade(number, path, seen, ray, hit);
  } else {
    finish_path(path);
  }
  words[ask_of_path(number)] = asked;
}

// With TRACES_SHADOWS: follows a path to its next point, and adds all light of the point.
void follow_scattered(uint number) {
  Path path;
  load_scattered(number, path);
  path.part = PART_REFLECTION;
  if (STREAM_HAS_PARTS != 0u) path.part = pixels[record_of_part(path.pixel, PART_SEEN)].w >> PART_OF_RAY_SHIFT;
  Ray ray = make_ray(path.origin, path.direction, 0.0, INFINITY);
  step_counts = uvec2(0u);
  packet[0] = ray;
  passes_backs = true;
  if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = false;
  if (has(FEATURE_HOLES)) {
    sight_width = path.cone_width;
    sight_spread = path.cone_spread;
  }
  trace_packet(false);
  Hit hit = found[0];
  uint asked = shade(number, path, vec3(0.0), ray, hit);
  if (asked == ASK_NOTHING) finish_path(path);
  words[ask_of_path(number)] = asked;
}

// Sets the properties of the path's ray, except its origin and direction.
void prepare_sight(uint number) {
  passes_backs = true;
  if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = false;
  if (has(FEATURE_HOLES)) {
    sight_width = load_record(record_of_path(number) + RECORD_RADIANCE).w;
    sight_spread = load_record(record_of_path(number) + RECORD_SEEN).w;
  }
  if (has(FEATURE_GLASS)) {
    path_glass = floatBitsToUint(load_record(record_of_glass(number) + RECORD_MEDIA));
    vec4 skip = load_record(record_of_glass(number) + RECORD_SHADOW_MEDIA);
    precise float until = skip.z / length3(packet[0].direction);
    skipped_until = skip.z > 0.0 ? until : -1.0;
    skipped_object = floatBitsToUint(skip.w);
  }
  if (KEEPS_PROGRESS == 0u) return;
  forget_passed(0u);
  float t = load_record(record_of_weight(number, 0u)).w;
  if (t >= 0.0) pass(0u, t, floatBitsToUint(load_record(record_of_weight(number, 1u)).w));
  path_progress = floatBitsToUint(load_record(record_of_path(number) + RECORD_SHADOW_ORIGIN).w);
}

void main() {
  begin_stream();
  uint place = group_number() * gl_WorkGroupSize.x + gl_LocalInvocationIndex;
  if (TRACES_SHADOWS != 0u) {
    if (place < paths_of_turn(turn)) follow_scattered(load_word(path_list(turn) + place));
  } else if (place < paths_of_turn(turn)) {
    uint path = load_word(path_list(turn) + place);
    bool has_ray = place < paths_with_ray();
    Ray ray = make_ray(load_record(record_of_path(path) + RECORD_ORIGIN).xyz,
                       load_record(record_of_path(path) + RECORD_DIRECTION).xyz, 0.0, has_ray ? INFINITY : 0.0);
    step_counts = uvec2(0u);
    packet[0] = ray;
    prepare_sight(path);
    trace_packet(false);
    Hit hit = found[0];
    follow(path, has_ray, ray, hit);
  }
  add_passes(uvec3(pass_count, refraction_count, 0u));
  add_counts(uvec3(0u, shadow_ray_count, mirror_ray_count), were_loops_cut());
}
