// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// One traversal for every ray: primary, mirror and shadow. No recursion; the stack has the size that the tree needs.
// An invocation traces PACKET_SIZE rays together: they share the fetching and unpacking of nodes and primitives and the
// stack, and each is tested on its own. It pays on CPU drivers, for rays that run side by side. What a ray hits depends
// neither on the packet nor on the tree.

Ray packet[PACKET_SIZE];
Hit found[PACKET_SIZE];     // the nearest so far
float limits[PACKET_SIZE];  // t that a hit may have at most; negative for a ray that takes no part
float shifts[PACKET_SIZE];  // of the origin along the ray: what intersections call t is so much less
vec3 octant;                // inverse direction of one of those that do: all have its signs

// What this invocation's rays took: x = node steps, y = primitive tests.
uvec2 step_counts;

void count_steps(uint nodes, uint tests) {
  if (has(FEATURE_STEP_COUNTS)) step_counts += uvec2(nodes, tests);
}

// Takes the crossing if it is nearer, or as near and of a lower number: the hit does not depend on the tree.
void keep_nearest(uint ray, Crossing crossing, uint primitive, uint order, bool any_hit) {
  precise float t = crossing.t + shifts[ray];
  if (crossing.t > packet[ray].tmin && (t < limits[ray] || (t == limits[ray] && order < found[ray].order))) {
    found[ray] = Hit(t, crossing.u, crossing.v, crossing.part, primitive, order);
    limits[ray] = any_hit ? -1.0 : t;
  }
}

// Each ray against the primitive `p` at index `i`.
#define INTERSECT_PACKET(INTERSECT)                                  \
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {         \
    keep_nearest(ray, INTERSECT(packet[ray], p), i, p.c.y, any_hit); \
  }

// The primitives of one kind at the head of [i, end): leaves hold them sorted by kind.
#define INTERSECT_RUN(KIND, FEATURE, INTERSECT)                       \
  while (i < end && is_kind(load_primitive_kind(i), KIND, FEATURE)) { \
    Primitive p = load_primitive(i);                                  \
    INTERSECT_PACKET(INTERSECT)                                       \
    ++i;                                                              \
  }

// A kernel to compare with may bring triangles of its own (tools/plain).
#ifdef OTHER_TRIANGLES
void intersect_packet_with_triangle(Primitive p, uint i, bool any_hit) { INTERSECT_PACKET(intersect_triangle) }
#else
// Few of a packet's rays meet a triangle whose box they meet: first whether they may, then where, one after the other.
void intersect_packet_with_triangle(Primitive p, uint i, bool any_hit) {
  ShearedTriangle sheared[PACKET_SIZE];
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    sheared[ray] = shear_triangle(packet[ray], p);
    sheared[ray].may_be_met = sheared[ray].may_be_met && limits[ray] >= 0.0;
  }
  bool may_another_be_met;
  do {
    uint next = 0u;
    ShearedTriangle of_next = sheared[0];
    float shear_z = packet[0].shear.z;
    float tmin = packet[0].tmin;
    [[unroll]] for (uint ray = 1u; ray < PACKET_SIZE; ++ray) {
      if (of_next.may_be_met || !sheared[ray].may_be_met) continue;
      next = ray;
      of_next = sheared[ray];
      shear_z = packet[ray].shear.z;
      tmin = packet[ray].tmin;
    }
    Crossing crossing = cross_triangle(of_next, shear_z, tmin);
    may_another_be_met = false;
    [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
      if (ray == next) {
        keep_nearest(ray, crossing, i, p.c.y, any_hit);
        sheared[ray].may_be_met = false;
      }
      may_another_be_met = may_another_be_met || sheared[ray].may_be_met;
    }
  } while (may_another_be_met);
}
#endif

void intersect_leaf(uint child, bool any_hit) {
  uint i = child & CHILD_FIRST_MASK;
  uint end = i + ((child >> CHILD_COUNT_SHIFT) & 15u) + 1u;
  count_steps(0u, end - i);
  while (i < end && is_kind(load_primitive_kind(i), KIND_TRIANGLE, FEATURE_TRIANGLES)) {
    intersect_packet_with_triangle(load_primitive(i), i, any_hit);
    ++i;
  }
  INTERSECT_RUN(KIND_SPHERE, FEATURE_SPHERES, intersect_sphere)
  INTERSECT_RUN(KIND_CYLINDER, FEATURE_CYLINDERS, intersect_cylinder)
  INTERSECT_RUN(KIND_CONE, FEATURE_CONES, intersect_cone)
}

void intersect_planes(bool any_hit) {
  for (uint i = dispatch.counts.x; i < dispatch.counts.x + dispatch.counts.y; ++i) {
    Primitive p = load_primitive(i);
    INTERSECT_PACKET(intersect_plane)
  }
}

// The family of a node: those of its children that are left to visit, the nearest first. The node's index in the upper
// 24 bits; how many there are, less one, in the two bits below; then which, in two bits each, the next one lowest. Of
// four the last is not told: it is the one that the others are not.
const uint NO_FAMILY = 0xFFFFFFFFu;
const uint DONE = 0xFFFFFFFFu;  // instead of a child; has CHILD_IS_LEAF

uint family;
uint stack[STACK_SIZE];  // the families of the nodes above
uint stack_top;

uint component_of(uvec4 v, uint i) {
  uvec2 half_of_v = (i & 2u) == 0u ? v.xy : v.zw;
  return (i & 1u) == 0u ? half_of_v.x : half_of_v.y;
}

// The nearest child that is left, or DONE.
uint take_child() {
  bool is_none = family == NO_FAMILY;
  uint child = is_none ? DONE : component_of(load_children(family >> 8), family & 3u);
  uint others = (family >> 6) & 3u;
  uint last = (family ^ (family >> 2) ^ (family >> 4)) & 3u;
  bool is_last = others == 0u;
  family = is_none ? NO_FAMILY
                   : ((family & 0xFFFFFF00u) | ((others - 1u) << 6) | (last << 4) | ((family >> 2) & 15u));
  if (is_last && !is_none) {
    family = NO_FAMILY;
    if (stack_top > 0u) {
      --stack_top;
      family = stack[stack_top];
    }
  }
  return child;
}

void enter_family(uint met) {
  if (met == NO_FAMILY) return;
  if (family != NO_FAMILY) {
    stack[stack_top] = family;
    ++stack_top;
  }
  family = met;
}

uvec4 sorted(uvec4 k) {
  uvec4 pairs = uvec4(min(k.x, k.y), max(k.x, k.y), min(k.z, k.w), max(k.z, k.w));
  uvec4 ends = uvec4(min(pairs.xy, pairs.zw), max(pairs.xy, pairs.zw));
  return uvec4(ends.x, min(ends.y, ends.z), max(ends.y, ends.z), ends.w);
}

vec4 unpack_bytes(uint word) { return vec4((uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & 0xFFu); }

// Of each pair the greater and the lesser; the second where either is a NaN, which comes of 0 * infinity in scenes
// beyond 10^18: what a NaN should bound is then bounded by tmin or the hit so far alone. GLSL's max and min take three
// instructions each on lavapipe, these one.
vec4 greater(vec4 a, vec4 b) {
  precise vec4 result =
      vec4(a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z, a.w > b.w ? a.w : b.w);
  return result;
}
vec4 lesser(vec4 a, vec4 b) {
  precise vec4 result =
      vec4(a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z, a.w < b.w ? a.w : b.w);
  return result;
}

const uint NOT_MET = 0xFFFFFFFFu;
const float SHIFT_TO_CULL_BY = 1.0 - 4.0 * UNIT_ROUNDOFF;

uvec4 least_where(uvec4 keys, bvec4 condition, uvec4 candidates) {
  return min(keys, uvec4(condition.x ? candidates.x : NOT_MET, condition.y ? candidates.y : NOT_MET,
                         condition.z ? candidates.z : NOT_MET, condition.w ? candidates.w : NOT_MET));
}

// A kernel to compare with may bring boxes of its own (tools/plain).
#ifndef OTHER_BOXES
// The children of a node that a ray of the packet meets, as its family. A box is met if entry <= exit; <=, so that one
// at the distance of the hit so far is still opened: its primitive may have a lower number. (origin - ray's origin)
// comes first, never byte * scale * inverse - origin * inverse, which cancels. No hit hidden in 3.6e5 rays at edges and
// corners, offset 0...1e5 (hard case 28; 5 % without padding), nor in 1e6 through mixed scenes (hard case 38).
uint meet_children(uint index) {
  NodeBoxes node = load_boxes(index);
  vec3 origin = uintBitsToFloat(node.frame.xyz);
  vec3 scale = uintBitsToFloat(((uvec3(node.frame.w) >> uvec3(0u, 8u, 16u)) & 0xFFu) << 23);
  uvec3 lo = node.lo.xyz;
  uvec3 hi = uvec3(node.lo.w, node.hi.xy);
  bvec3 is_backward = lessThan(octant, vec3(0.0));
  uvec3 near = uvec3(is_backward.x ? hi.x : lo.x, is_backward.y ? hi.y : lo.y, is_backward.z ? hi.z : lo.z);
  uvec3 far = uvec3(is_backward.x ? lo.x : hi.x, is_backward.y ? lo.y : hi.y, is_backward.z ? lo.z : hi.z);
  vec4 near_x = unpack_bytes(near.x);
  vec4 near_y = unpack_bytes(near.y);
  vec4 near_z = unpack_bytes(near.z);
  vec4 far_x = unpack_bytes(far.x);
  vec4 far_y = unpack_bytes(far.y);
  vec4 far_z = unpack_bytes(far.z);

  // Where a ray comes in first; no t is negative, so their bits are in their order.
  uvec4 entries = uvec4(NOT_MET);
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    vec3 inverse = packet[ray].inverse_direction;
    precise vec3 step = scale * inverse;
    precise vec3 near_base = (origin - packet[ray].near_origin) * inverse;
    precise vec3 far_base = (origin - packet[ray].far_origin) * inverse;
    precise vec4 near_t_x = near_x * step.x + near_base.x;
    precise vec4 near_t_y = near_y * step.y + near_base.y;
    precise vec4 near_t_z = near_z * step.z + near_base.z;
    precise vec4 far_t_x = far_x * step.x + far_base.x;
    precise vec4 far_t_y = far_y * step.y + far_base.y;
    precise vec4 far_t_z = far_z * step.z + far_base.z;
    vec4 entry = greater(near_t_x, greater(near_t_y, greater(near_t_z, vec4(packet[ray].tmin))));
    precise vec4 exit = lesser(far_t_x, lesser(far_t_y, far_t_z)) * BOX_WIDENING;
    // A little more than what is left, as t is rounded when the shift comes to it.
    precise float limit = limits[ray] - SHIFT_TO_CULL_BY * shifts[ray];
    entries = least_where(entries, lessThanEqual(entry, lesser(exit, vec4(limit))), floatBitsToUint(entry));
  }

  bvec4 is_met = lessThan(uvec4(0u, 1u, 2u, 3u), uvec4(node.frame.w >> 24));
  is_met = bvec4(is_met.x && entries.x != NOT_MET, is_met.y && entries.y != NOT_MET, is_met.z && entries.z != NOT_MET,
                 is_met.w && entries.w != NOT_MET);
  uvec4 keys = sorted(least_where(uvec4(NOT_MET), is_met, (entries & ~3u) | uvec4(0u, 1u, 2u, 3u)));
  if (keys.x == NOT_MET) return NO_FAMILY;
  uint others = uint(keys.y != NOT_MET) + uint(keys.z != NOT_MET) + uint(keys.w != NOT_MET);
  return (index << 8) | (others << 6) | ((keys.z & 3u) << 4) | ((keys.y & 3u) << 2) | (keys.x & 3u);
}
#endif

bool any_takes_part() {
  bool result = false;
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) result = result || limits[ray] >= 0.0;
  return result;
}

// Those of the packet's rays that take part, all in one octant, through the tree.
void descend(bool any_hit) {
  stack_top = 0u;
  family = NO_FAMILY;
  uint current = any_takes_part() ? 0u : DONE;
  // Loops rather than branches around the two halves: CPU drivers execute both sides of a branch under a mask, but
  // leave a loop as soon as no lane is in it.
  while (current != DONE) {
    while ((current & CHILD_IS_LEAF) == 0u) {
      count_steps(1u, 0u);
      enter_family(meet_children(current));
      current = take_child();
    }
    if (current == DONE) break;
    intersect_leaf(current, any_hit);
    if (any_hit && !any_takes_part()) break;
    current = take_child();
  }
}

// One octant after the other: the first ray's, then the first's of those that are left.
void descend_by_octants(bool any_hit) {
  float waiting[PACKET_SIZE];
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) waiting[ray] = limits[ray];
  for (;;) {
    bool is_chosen = false;
    [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
      vec3 inverse = packet[ray].inverse_direction;
      bool waits = waiting[ray] >= 0.0;
      octant = waits && !is_chosen ? inverse : octant;
      is_chosen = is_chosen || waits;
      bool joins = waits && all(equal(lessThan(inverse, vec3(0.0)), lessThan(octant, vec3(0.0))));
      limits[ray] = joins ? waiting[ray] : -1.0;
      waiting[ray] = joins ? -1.0 : waiting[ray];
    }
    if (!is_chosen) break;
    descend(any_hit);
  }
}

void descend_as_they_are(bool any_hit) {
  if (PACKET_SIZE == 1u) {
    octant = packet[0].inverse_direction;
    descend(any_hit);
  } else {
    descend_by_octants(any_hit);
  }
}

// Rays from far away go down the tree from nearby.
void descend_from_nearby(bool any_hit) {
  vec3 origins[PACKET_SIZE];
  float tmins[PACKET_SIZE];
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    origins[ray] = packet[ray].origin;
    tmins[ray] = packet[ray].tmin;
  }
  bool is_any_far = false;
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) is_any_far = is_any_far || is_far_away(packet[ray]);
  // Each time a thousandth of the way is left.
  for (uint i = 0u; i < 4u && is_any_far; ++i) {
    is_any_far = false;
    [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
      precise float sum = shifts[ray] + shift_to_tree(packet[ray]);
      if (!(sum > shifts[ray] && sum < packet[ray].tmax)) continue;
      Ray moved = moved_along(packet[ray], shift_to_tree(packet[ray]));
      if (!(distance_to_tree(moved) < distance_to_tree(packet[ray]))) continue;
      packet[ray] = moved;
      packet[ray].tmin = shifted_tmin(tmins[ray], sum);
      shifts[ray] = sum;
      is_any_far = true;
    }
  }
  descend_as_they_are(any_hit);
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    packet[ray].origin = origins[ray];
    packet[ray].tmin = tmins[ray];
  }
}

// Fills `found` from `packet`: with the nearest hits, or with `any_hit` some hits; where there is none, `primitive` is
// NO_PRIMITIVE.
void trace_packet(bool any_hit) {
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    shifts[ray] = 0.0;
    found[ray] = Hit(packet[ray].tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
    limits[ray] = packet[ray].tmin < packet[ray].tmax ? packet[ray].tmax : -1.0;
  }
  if (has(FEATURE_PLANES)) intersect_planes(any_hit);
  if ((FEATURES & SOLID_FEATURES) == 0u) return;
  descend_from_nearby(any_hit);
}

// A single ray; for kernels with packets of one.
Hit trace(Ray ray, bool any_hit) {
  packet[0] = ray;
  trace_packet(any_hit);
  return found[0];
}
