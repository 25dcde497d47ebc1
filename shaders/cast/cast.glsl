// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Casts rays and writes records; a lane casts PACKET_SIZE consecutive rays. This is the body of cast.comp; variants
// differ only in the files that they include before it.

const uint LANES = BLOCK_SIZE * BLOCK_SIZE;
layout(local_size_x = LANES) in;

// Returns the factor from t in units of the traced direction to t in units of the given direction. The factor is a
// power of two.
float units_of(RayRecord request) { return power_of_two_inverse(max_abs(request.direction_tmax.xyz)); }

HitRecord record_of(RayRecord request, Ray ray, Hit hit) {
  uint steps = min(step_counts.x, 0xFFFFu) | (min(step_counts.y, 0xFFFFu) << 16);
  HitRecord miss = HitRecord(uvec4(floatBitsToUint(INFINITY), NO_ORDER, 0u, 0u), uvec4(0u, 0u, 0u, steps));
  if (hit.primitive == NO_PRIMITIVE) return miss;
  // The record of an any-hit ray has no position.
  if (ALL_ASK_FOR_ANY != 0u) return HitRecord(uvec4(0u, hit.order, 0u, 0u), uvec4(0u, 0u, 0u, steps));
  precise float t = hit.t * units_of(request);
  if (!(t > max(request.origin_tmin.w, 0.0) && t < request.direction_tmax.w)) return miss;
  vec3 normal = surface_point(ray, load_primitive(hit.primitive), hit).normal;
  return HitRecord(uvec4(floatBitsToUint(t), hit.order, floatBitsToUint(vec2(hit.u, hit.v))),
                   uvec4(floatBitsToUint(normal), steps));
}

void main() {
  uint first = first_ray() + PACKET_SIZE * (group_number() * LANES + gl_LocalInvocationIndex);
  if (first >= end_ray()) return;
  RayRecord requests[PACKET_SIZE];
  uint indices[PACKET_SIZE];
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    // A lane with fewer rays than the packet casts the last ray again.
    indices[i] = min(first + i, end_ray() - 1u);
    requests[i] = load_ray(indices[i]);
    packet[i] = make_ray(requests[i].origin_tmin.xyz, requests[i].direction_tmax.xyz, requests[i].origin_tmin.w,
                         requests[i].direction_tmax.w);
    // A larger t would not be finite in units of the given direction.
    float farthest = LARGEST_FLOAT * power_of_two_inverse(units_of(requests[i]));
    packet[i].tmax = packet[i].tmax < farthest ? packet[i].tmax : farthest;
  }
  step_counts = uvec2(0u);
  trace_packet(ALL_ASK_FOR_ANY != 0u);
  [[unroll]] for (uint i = 0u; i < PACKET_SIZE; ++i) {
    HitRecord record = record_of(requests[i], packet[i], found[i]);
    // A CPU driver executes stores word by word and lane by lane, so any-hit rays store only what is needed.
    if (ALL_ASK_FOR_ANY != 0u && !has(FEATURE_STEP_COUNTS)) {
      hits[indices[i]].a.xy = record.a.xy;
    } else {
      hits[indices[i]] = record;
    }
  }
  if (were_loops_cut()) dispatch.outcome.x = 1u;
}
