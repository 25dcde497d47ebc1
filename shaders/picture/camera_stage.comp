// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The first stage of a picture: one sample of each pixel, with its camera ray and the shadow rays of its hit. A lane
// traces PACKET_SIZE neighbouring pixels. Paths that continue at a mirror go to the stream (stream.glsl).
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
#include "picture/ray_bins.glsl"
#include "trace/ray.glsl"
#include "trace/make_ray.glsl"
#include "trace/primitives.glsl"
#include "trace/packet.glsl"
#include "trace/packet_shapes.glsl"
#include "trace/packet_triangles.glsl"
#include "trace/family.glsl"
#include "trace/node_boxes.glsl"
#include "trace/traversal.glsl"
#include "picture/debug_views.glsl"
#include "picture/ray_log.glsl"
#include "shade/secondary.glsl"
#include "shade/shading_records.glsl"
#include "shade/lights.glsl"
#include "shade/environment.glsl"
#include "shade/shading.glsl"
#include "shade/light_way.glsl"
// A lane adds only once to each sum of its pixels, so no earlier addition of this lane must be loaded.
#define load_sum(record) load_record(record)
#include "picture/path.glsl"
#include "picture/tree.glsl"
#include "picture/scatter.glsl"
#include "shared/group_rows.glsl"
#include "picture/camera.glsl"
#include "shared/loop_check.glsl"
#include "picture/pixel_packet.glsl"

// Stores the id of the object that the sample shows. On the film of a list it is the only id.
void put_sample_id(uint pixel, uint order) {
  if (has(FEATURE_LISTED_SAMPLES)) {
    pixels[pixel].w = order;
    return;
  }
  uint place = sample_at_hand() % SAMPLE_IDS;
  uint before = (has(FEATURE_AOVS) ? AOV_RECORDS : 1u) + (has(FEATURE_LIGHT_AOVS) ? PART_RECORDS : 0u);
  pixels[(before + place / 4u) * window_pixel_count() + pixel][place % 4u] = order;
}

// Returns whether the sample is the middle one. Depths and ids have no average, so the middle sample represents the
// pixel. If the number of samples is odd, it lies at the pixel's centre.
bool is_middle_sample() { return has(FEATURE_AOVS) && sample_at_hand() == samples_per_pixel() / 2u; }

// Writes the result of the sample to the pixel's records.
void put_record(Path path, Hit hit) {
  uint order = hit.primitive == NO_PRIMITIVE ? NO_ORDER : hit.order;
  if (has(FEATURE_SAMPLE_IDS)) put_sample_id(path.pixel, order);
  if (has(FEATURE_LISTED_SAMPLES)) return;
  if (is_middle_sample()) pixels[path.pixel].w = order;
}

// True if the picture shows the share of directions in which nothing occludes a point.
#define SHOWS_OCCLUSION (DEBUG_VIEW == DEBUG_VIEW_OCCLUSION)

// True if shading points are computed. Most debug views show no light, but their AOVs need shading points.
const uint SHADES_LIGHT = uint(DEBUG_VIEW == DEBUG_VIEW_NONE) | uint(SHOWS_OCCLUSION);
const uint SHADES_POINTS = FEATURE_BIT(FEATURE_AOVS) | SHADES_LIGHT;

// Returns the texture coordinates of a hit in set 0; 0 if the surface has no texture.
vec2 texture_coordinates(Hit hit) {
  uvec4 corners = load_surface(hit.primitive).corners_material;
  if (!has(FEATURE_TEXTURES) || (corners.w & SURFACE_HAS_UVS) == 0u) return vec2(0.0);
  CornerUvs uvs = load_corner_uvs(corners.xyz);
  precise vec2 sum = (1.0 - hit.u - hit.v) * uvs.a.xy + hit.u * uvs.b.xy + hit.v * uvs.c.xy;
  return sum;
}

// Returns the bits of two values: the normal of the hit (outward on solids, by the winding on triangles), and the
// distance from the ray's origin, which is infinite on a miss.
uvec4 normal_and_depth(Ray ray, Hit hit) {
  if (hit.primitive == NO_PRIMITIVE) return floatBitsToUint(vec4(0.0, 0.0, 0.0, INFINITY));
  SurfacePoint surface = surface_point(ray, load_primitive(hit.primitive), hit);
  precise float depth = hit.t * length3(ray.direction);
  return floatBitsToUint(vec4(surface.normal, depth));
}

// Stores the AOVs of the middle sample's hit.
void put_aovs(uint pixel, Ray ray, Hit hit, ShadingPoint point) {
  if (!is_middle_sample()) return;
  uint count = window_pixel_count();
  bool is_hit = hit.primitive != NO_PRIMITIVE;
  uvec4 albedo = uvec4(0u, 0u, 0u, NO_ORDER);
  uvec4 position = uvec4(0u);
  uvec4 shading_normal = uvec4(0u);
  vec3 measures = vec3(0.0, 0.0, INFINITY);
  if (is_hit) {
    albedo = uvec4(floatBitsToUint(albedo_color(point)),
                   load_surface_of(hit.primitive, hit.part).corners_material.w & SURFACE_MATERIAL_MASK);
    position.xyz = floatBitsToUint(point.position);
    shading_normal.xyz = floatBitsToUint(point.normal);
    precise float along = hit.t * dot3(ray.direction, CAMERA.look.xyz);
    measures = vec3(texture_coordinates(hit), along);
  }
  pixels[AOV_NORMAL * count + pixel] = normal_and_depth(ray, hit);
  pixels[AOV_ALBEDO * count + pixel] = albedo;
  pixels[AOV_POSITION * count + pixel] = position;
  pixels[AOV_SHADING_NORMAL * count + pixel] = shading_normal;
  pixels[AOV_MEASURES * count + pixel] = uvec4(floatBitsToUint(measures), step_counts.x + step_counts.y);
}

// Shades the hit of a pixel's camera ray without light sources. Returns its radiance so far.
vec3 arrive_at(inout Path path, Ray ray, Hit hit, out ShadingPoint point) {
  put_record(path, hit);
  bool is_hit = hit.primitive != NO_PRIMITIVE;
  hit_count += is_hit ? 1u : 0u;
  if (is_hit && DEBUG_VIEW == DEBUG_VIEW_NONE) absorb(path, ray, hit);
  begin_path_log(ray, hit, 0u, path.weight, path.kind);
  if (SHADES_POINTS != 0u && is_hit) {
    widen_cone(path, ray, hit);
    make_shading_point(ray, path.direction, hit, path.cone_width, path.media, color_of(path.weight), point);
  }
  if (has(FEATURE_AOVS)) put_aovs(path.pixel, ray, hit, point);
  if (DEBUG_VIEW != DEBUG_VIEW_NONE) return debug_color(ray, hit, uintBitsToFloat(normal_and_depth(ray, hit)));
  vec3 light = radiance_behind(path.origin, path.direction, true);
  if (is_hit) {
    bool is_opaque = coverage_of(path, point) == 1.0;
    light = own_light(point, path.direction, is_opaque && leads_on(point, 0u));
    path.passed_t = hit.t;
    path.passed_order = hit.order;
  }
  log_own_light(light);
  return light;
}

// Not 0 if a camera ray that hits nothing takes more work than a constant or a gradient.
const uint MISSES_TAKE_WORK = FEATURE_BIT(FEATURE_SHOWN_SKY) | FEATURE_BIT(FEATURE_AOVS) |
                              FEATURE_BIT(FEATURE_SAMPLE_IDS) | FEATURE_BIT(FEATURE_RAY_LOG) |
                              uint(DEBUG_VIEW != DEBUG_VIEW_NONE);

// Returns the first pixel from `first` on that arrive() shades, or PACKET_SIZE.
uint next_arriving(uint first) {
  uint next = PACKET_SIZE;
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    bool arrives = is_inside[i] && (MISSES_TAKE_WORK != 0u || found[i].primitive != NO_PRIMITIVE);
    next = arrives && i >= first ? min(next, i) : next;
  }
  return next;
}

// Shades the pixels one after the other. Each pixel is copied out of the packet and back, because CPU drivers are slow
// with arrays at variable indices. Drivers do not unroll loops that contain loops, such as those of textures. A lane
// passes over pixels without a hit: lavapipe 22 executes the code of shading in each turn, even for no lane.
void arrive() {
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    is_lit[i] = false;
    if (MISSES_TAKE_WORK != 0u) continue;
    seen[i] = radiance_behind(paths[i].origin, paths[i].direction, true);
    if (has(FEATURE_LIGHT_AOVS)) own_lights[i] = seen[i];
  }
  uint at = next_arriving(0u);
  do {
    Path path = paths[0];
    Ray ray = packet[0];
    Hit hit = found[0];
    [[unroll]] for (uint i = 1u; i < PACKET_SIZE; ++i) {
      if (i != at) continue;
      path = paths[i];
      ray = packet[i];
      hit = found[i];
    }
    vec3 light = vec3(0.0);
    ShadingPoint point;
    if (at < PACKET_SIZE) light = arrive_at(path, ray, hit, point);
    [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
      if (i != at) continue;
      paths[i] = path;
      points[i] = point;
      seen[i] = light;
      if (has(FEATURE_LIGHT_AOVS)) own_lights[i] = light;
      is_lit[i] = SHADES_LIGHT != 0u && hit.primitive != NO_PRIMITIVE;
    }
    at = next_arriving(at + 1u);
  } while (at < PACKET_SIZE);
}

// With FEATURE_SKY_LIGHT: does the same as aim_at_source() for one pixel after the other, like arrive(), because
// choosing a direction of the sky takes a loop.
void aim_one_by_one(LightRecord light, uint source) {
  uint at = 0u;
  do {
    Path path = paths[0];
    ShadingPoint point = points[0];
    bool takes_part = is_lit[0];
    uvec2 id = sample_ids[0];
    Ray ray = packet[0];
    [[unroll]] for (uint i = 1u; i < PACKET_SIZE; ++i) {
      if (i != at) continue;
      path = paths[i];
      point = points[i];
      takes_part = is_lit[i];
      id = sample_ids[i];
      ray = packet[i];
    }
    ray.tmax = -1.0;
    vec3 contribution = vec3(0.0);
    if (takes_part) {
      choose_sample(id, FIRST_LIGHT_PAIR + source);
      LightRecord sampled_light = light;
      LightSample sampled = sample_light_or_lobe(point, -path.direction, sampled_light);
      contribution = unshadowed_contribution(point, -path.direction, sampled_light, sampled);
      if (has(FEATURE_SHADOWS) && max_abs(contribution) > 0.0) {
        ray = shadow_ray(point, sampled_light, sampled);
        ++ray_count.y;
      }
    }
    [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
      if (i != at) continue;
      contributions[i] = contribution;
      if (has(FEATURE_SHADOW_CATCHERS)) seen[i] = without_caught(point, contribution, seen[i]);
      packet[i] = ray;
      ways[i] = light_way(path.media);
      blockers[i].primitive = NO_PRIMITIVE;
      forget_passed(i);
    }
    ++at;
  } while (at < PACKET_SIZE);
}

// Computes the contributions of one light source, and the packet of the shadow rays for it.
void aim_at_source(LightRecord light, uint source) {
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    contributions[i] = vec3(0.0);
    packet[i].tmax = -1.0;
    ways[i] = light_way(paths[i].media);
    blockers[i].primitive = NO_PRIMITIVE;
    forget_passed(i);
    if (!is_lit[i]) continue;
    // Points and rays are copied here and elsewhere, because glslang 12 fails if packets of points are passed that
    // contain packets.
    ShadingPoint point = points[i];
    LightSample sampled;
    if (has(FEATURE_SAMPLED_LIGHT)) {
      choose_sample(sample_ids[i], FIRST_LIGHT_PAIR + source);
      sampled = sample_light_or_lobe(point, -paths[i].direction, light);
    } else {
      sampled = sample_light(light, point.position);
    }
    contributions[i] = unshadowed_contribution(point, -paths[i].direction, light, sampled);
    if (has(FEATURE_SHADOW_CATCHERS)) seen[i] = without_caught(point, contributions[i], seen[i]);
    if (!has(FEATURE_SHADOWS) || !(max_abs(contributions[i]) > 0.0)) continue;
    Ray ray = shadow_ray(point, light, sampled);
    packet[i] = ray;
    ++ray_count.y;
  }
}

// With SHOWS_OCCLUSION: does the same for light of strength 1 from all sides, from one direction that is chosen by its
// cosine to the normal.
void aim_around() {
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    contributions[i] = vec3(0.0);
    packet[i].tmax = -1.0;
    ways[i] = light_way(paths[i].media);
    blockers[i].primitive = NO_PRIMITIVE;
    forget_passed(i);
    if (!is_lit[i]) continue;
    ShadingPoint point = points[i];
    choose_sample(sample_ids[i], FIRST_LIGHT_PAIR);
    vec3 direction = choose_by_cosine(point.normal, sample_pair_point());
    contributions[i] = vec3(1.0);
    if (!has(FEATURE_SHADOWS)) continue;
    packet[i] = make_ray(shadow_origin(point), direction, 0.0, CAMERA.up.w);
    ++ray_count.y;
  }
}

// Continues a shadow ray behind a surface that blends. Returns whether it continues.
bool goes_through_layer(uint i, uint layers) {
  Hit hit = found[i];
  // Rays that have reached the light or are blocked are not traced any more.
  packet[i].tmin = INFINITY;
  if (hit.primitive == NO_PRIMITIVE) return false;
  blockers[i] = hit;
  LightWay way = ways[i];
  bool is_light_left = goes_on_behind(way, packet[i], hit, layers);
  ways[i] = way;
  if (!is_light_left) return false;
  pass(i, hit.t, hit.order);
  ++pass_count;
  return true;
}

// The loop over the pixels is unrolled by hand, because drivers do not unroll such loops (see arrive).
bool go_through_layers(uint layers) {
  bool is_any_left = goes_through_layer(0u, layers);
  if (PACKET_SIZE > 1u && goes_through_layer(1u, layers)) is_any_left = true;
  if (PACKET_SIZE > 2u && goes_through_layer(2u, layers)) is_any_left = true;
  if (PACKET_SIZE > 2u && goes_through_layer(3u, layers)) is_any_left = true;
  return is_any_left;
}

void add_contributions(uint source) {
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    if (!is_lit[i]) continue;
    begin_source_log(source);
    if (PASSES != 0u) {
      packet[i].tmin = 0.0;
      found[i] = blockers[i];
      LightWay way = ways[i];
      if (packet[i].tmax >= 0.0) end_way(way, packet[i]);
      ways[i] = way;
    }
    if (packet[i].tmax >= 0.0) log_shadow_ray(packet[i], found[i]);
    precise vec3 contribution =
        PASSES != 0u ? ways[i].arriving * contributions[i]
                     : (found[i].primitive == NO_PRIMITIVE ? contributions[i] : vec3(0.0));
    end_source_log(contribution);
    precise vec3 sum = seen[i] + contribution;
    seen[i] = sum;
  }
}

// Adds a path to the stream for the turn before the first one. Returns the path's number.
uint put_path(Path path) {
  begin_stream();
  uint number = atomicAdd(stream.turn.z, 1u);
  if (TRACES_SHADOWS != 0u) {
    store_scattered(number, path);
    store_part_of_ray(path);
    words[ask_of_path(number)] = ask(LIST_OF_PATHS, bin_of(path.origin, path.direction));
    words[path_list(turn) + number] = number;
    return number;
  }
  uint record = record_of_path(number);
  pixels[record + RECORD_ORIGIN] = uvec4(floatBitsToUint(path.origin), path.pixel);
  pixels[record + RECORD_DIRECTION].xyz = floatBitsToUint(path.direction);
  if (SEES_ENVIRONMENT) pixels[record + RECORD_DIRECTION].w = floatBitsToUint(path.roughness);
  store_passed(number, path);
  if (has(FEATURE_TEXTURES)) {
    pixels[record + RECORD_RADIANCE].w = floatBitsToUint(path.cone_width);
    pixels[record + RECORD_SEEN].w = floatBitsToUint(path.cone_spread);
  }
  pixels[record_of_weight(number, 0u)].xyz = floatBitsToUint(path.weight);
  pixels[record + RECORD_RADIANCE].xyz = floatBitsToUint(path.radiance);
  store_part_of_ray(path);
  if (has(FEATURE_SCATTERING)) {
    store_scattering(number);
  } else if (has(FEATURE_SAMPLED_LIGHT)) {
    pixels[record + RECORD_SAMPLE].xy = uvec2(sample_key, sample_number);
  }
  words[ask_of_path(number)] = ask(LIST_OF_PATHS, bin_of(path.origin, path.direction));
  words[path_list(turn) + number] = number;
  return number;
}

// Adds the path that continues at a surface of glass, and stores its other rays as waiting.
void leave_glass(Path path, ShadingPoint point) {
  Children children;
  part_path(path, point, false, children);
  log_sum(1u, path.radiance);
  ray_count.z += children.is_mirrored ? 1u : 0u;
  uint refracted = count_refracted(children);
  refraction_count += refracted;
  if (!children.is_mirrored && refracted == 0u) {
    finish_path(path);
    return;
  }
  uint number = put_path(path);
  store_glass(number, path, store_children(number, 0u, children, point, false), false);
}

// Returns the camera ray of a pixel of the film.
Ray ray_of(uint index) {
  if (has(FEATURE_LISTED_SAMPLES)) return listed_ray(index);
  return camera_ray(uvec2(index % window_size().x, index / window_size().x));
}

// Adds the radiance of a pixel to the AOVs of the parts of its light.
void add_parts(Path path, ShadingPoint point, vec3 light, vec3 own, bool is_on_surface, float coverage) {
  if (!is_on_surface) {
    add_beyond(path, light);
    return;
  }
  precise vec3 weight = coverage * path.weight;
  add_own_parts(path, point, own, coverage);
  add_seen_part(path.pixel, path.part, weight, own, light);
}

// Ends a path at a surface that shows only shadows. `share` is the fraction of light that arrives.
void leave_catcher(Path path, vec3 share) {
  share = max(share, vec3(0.0));
  precise vec3 light = share * radiance_behind(path.origin, path.direction, true);
  add_radiance(path, light, 1.0);
  add_caught(path, light, share);
  if (has(FEATURE_UNLIT_SHARE)) add_backdrop(path, light);
  end_path_log(path.radiance, 1.0);
  finish_path(path);
}

// Adds the radiance of a pixel to its path, and continues the path.
void leave_pixel(Path path, ShadingPoint point, vec3 light, vec3 own, bool is_on_surface) {
  float coverage = is_on_surface ? coverage_of(path, point) : 1.0;
  add_radiance(path, light, coverage);
  if (has(FEATURE_LIGHT_AOVS) && DEBUG_VIEW == DEBUG_VIEW_NONE) {
    add_parts(path, point, light, own, is_on_surface, coverage);
  }
  if (has(FEATURE_UNLIT_SHARE)) {
    if (is_on_surface) {
      add_unlit(path, 0u, point, light, coverage);
    } else {
      add_backdrop(path, light);
    }
  }
  if (DEBUG_VIEW == DEBUG_VIEW_NONE) end_path_log(path.radiance, coverage);
  if (has(FEATURE_BLENDING) && coverage < 1.0) {
    path.cone_width = CAMERA.look.w;
    go_through(path, ray_of(path.pixel), path.passed_t, path.passed_order, coverage);
    uint number = put_path(path);
    if (has(FEATURE_GLASS)) store_glass(number, path, 0u, false);
    ++pass_count;
  } else if (has(FEATURE_SCATTERING)) {
    if (is_on_surface && leads_on(point, 0u) && scatter(path, point, 0u, false)) {
      uint number = put_path(path);
      if (has(FEATURE_GLASS)) store_glass(number, path, 0u, false);
      bool is_refracted = has(FEATURE_GLASS) && path.kind == LOG_REFRACTION;
      refraction_count += is_refracted ? 1u : 0u;
      ray_count.z += is_refracted ? 0u : 1u;
    } else {
      finish_path(path);
    }
  } else if (has(FEATURE_GLASS) && is_on_surface) {
    leave_glass(path, point);
  } else if (is_on_surface && leads_on(point, 0u) && bounce(path, point)) {
    uint number = put_path(path);
    if (has(FEATURE_GLASS)) store_glass(number, path, 0u, false);
    ++ray_count.z;
  } else {
    finish_path(path);
  }
}

// Processes one pixel after the other if each needs much work, like arrive().
void leave_one_by_one() {
  uint at = 0u;
  do {
    Path path = paths[0];
    ShadingPoint point = points[0];
    vec3 light = seen[0];
    vec3 own = own_lights[0];
    bool is_on_surface = is_lit[0] && DEBUG_VIEW != DEBUG_VIEW_OCCLUSION;
    bool takes_part = is_inside[0];
    if (HAS_SAMPLE_POINTS != 0u) choose_sample(sample_ids[0], 0u);
    environment_share = 1.0;
    is_diffused = false;
    [[unroll]] for (uint i = 1u; i < PACKET_SIZE; ++i) {
      if (i != at) continue;
      path = paths[i];
      point = points[i];
      if (HAS_SAMPLE_POINTS != 0u) choose_sample(sample_ids[i], 0u);
      light = seen[i];
      own = own_lights[i];
      is_on_surface = is_lit[i] && DEBUG_VIEW != DEBUG_VIEW_OCCLUSION;
      takes_part = is_inside[i];
    }
    if (has(FEATURE_SHADOW_CATCHERS)) {
      bool catches = is_on_surface && catches_shadows(point);
      if (takes_part && catches) leave_catcher(path, light);
      takes_part = takes_part && !catches;
    }
    if (takes_part) leave_pixel(path, point, light, own, is_on_surface);
    ++at;
  } while (at < PACKET_SIZE);
}

// glslang 12 writes an invalid module for three constants with ||.
const uint LEAVES_ONE_BY_ONE =
    FEATURE_BIT(FEATURE_GLASS) | FEATURE_BIT(FEATURE_LIGHT_AOVS) | FEATURE_BIT(FEATURE_SHADOW_CATCHERS) |
    FEATURE_BIT(FEATURE_SCATTERING);

void leave() {
  if (LEAVES_ONE_BY_ONE != 0u) {
    leave_one_by_one();
    return;
  }
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    if (!is_inside[i]) continue;
    Path path = paths[i];
    ShadingPoint point = points[i];
    if (HAS_SAMPLE_POINTS != 0u) choose_sample(sample_ids[i], 0u);
    leave_pixel(path, point, seen[i], own_lights[i], is_lit[i] && DEBUG_VIEW != DEBUG_VIEW_OCCLUSION);
  }
}

// The first turn traces camera rays. Each later turn traces shadow rays to one light source. Both use the same copy of
// the traversal, which halves the code to compile. CPU drivers execute the whole body of a loop in each of its turns.
// Shading is therefore in the loop around the loop of turns, where it is executed twice and not once per source.
void trace_pixels() {
  uint sources = DEBUG_VIEW == DEBUG_VIEW_NONE ? source_count() : uint(SHOWS_OCCLUSION);
  uint source = 0u;
  uint layers = 0u;
  bool is_first_turn = true;
  bool aims = false;
  do {
    do {
      if (SHOWS_OCCLUSION) {
        if (aims) aim_around();
      } else if (has(FEATURE_SKY_LIGHT)) {
        if (aims) aim_one_by_one(load_light(VIEW.first_index.y + source), source);
      } else {
        if (aims) aim_at_source(load_light(VIEW.first_index.y + source), source);
      }
      aims = false;
      // If surfaces blend, shadow rays also need the nearest hit.
      trace_packet(!is_first_turn && PASSES == 0u);
      passes_backs = false;
      if (has(FEATURE_SHADOW_CATCHERS)) passes_catchers = !SHOWS_OCCLUSION;
      sight_width = 0.0;
      sight_spread = 0.0;
      if (!is_first_turn) {
        if (PASSES != 0u && go_through_layers(layers)) {
          ++layers;
          continue;
        }
        add_contributions(source);
        ++source;
        layers = 0u;
        aims = true;
      }
    } while (!is_first_turn && source < sources);
    aims = is_first_turn && sources > 0u;
    if (is_first_turn) arrive();
    is_first_turn = false;
  } while (aims);
}

void main() {
  if (begin_packet()) {
    begin_log();
    step_counts = uvec2(0u);
    trace_pixels();
    leave();
  }
  add_passes(uvec3(pass_count, refraction_count, hit_count));
  add_counts(ray_count, were_loops_cut());
}
