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

// Each ray against a primitive.
#define INTERSECT_PACKET(INTERSECT, PRIMITIVE, INDEX, ASKS_FOR_ANY)                                                  \
  [[unroll]] for (uint each = 0u; each < PACKET_SIZE; ++each) {                                                      \
    keep_nearest(each, INTERSECT(packet[each], PRIMITIVE), INDEX, order_of(PRIMITIVE), ASKS_FOR_ANY);                \
  }

// What is left of the leaf at hand.
uint leaf_next;
uint leaf_end;
// Its triangle just before that is to be looked at again.
bool needs_second_look;

bool is_next_in_leaf(uint kind, uint feature) {
  return leaf_next < leaf_end && is_kind(load_primitive_kind(leaf_next), kind, feature);
}

// The primitives of one kind that come next: leaves hold them sorted by kind.
#define INTERSECT_RUN(KIND, FEATURE, INTERSECT, ASKS_FOR_ANY)                     \
  while (is_next_in_leaf(KIND, FEATURE)) {                                        \
    Primitive next_of_run = load_primitive(leaf_next);                            \
    INTERSECT_PACKET(INTERSECT, next_of_run, leaf_next, ASKS_FOR_ANY)             \
    ++leaf_next;                                                                  \
  }

// A kernel to compare with may bring triangles of its own (tools/plain).
#ifdef OTHER_TRIANGLES
void intersect_packet_with_triangle(Primitive p, uint i, bool any_hit) {
  INTERSECT_PACKET(intersect_triangle, p, i, any_hit)
}
void glance_at_triangle(Primitive p, uint i) { intersect_packet_with_triangle(p, i, true); }
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
        keep_nearest(ray, crossing, i, order_of(p), any_hit);
        sheared[ray].may_be_met = false;
      }
      may_another_be_met = may_another_be_met || sheared[ray].may_be_met;
    }
  } while (may_another_be_met);
}

// The same for rays that ask for any hit, with ANY_HIT: most are told by a glance. Where one is not, the second look
// waits until no lane has another triangle to glance at, as CPU drivers would execute it after every one.
void glance_at_triangle(Primitive p, uint i) {
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    ShearedTriangle sheared = shear_triangle(packet[ray], p);
    Glance glance = glance_at(sheared, packet[ray].shear.z, packet[ray].tmin, limits[ray]);
    bool may_be_met = sheared.may_be_met && limits[ray] >= 0.0;
    // The limit of a ray that has moved along itself is not told to the last bit.
    bool is_met = may_be_met && glance.is_met && shifts[ray] == 0.0;
    needs_second_look = needs_second_look || (may_be_met && !is_met && !glance.is_missed);
    if (is_met) {
      found[ray].primitive = i;
      found[ray].order = order_of(p);
      limits[ray] = -1.0;
    }
  }
}
#endif

// The closed shapes that come next, kind by kind.
void intersect_solids(bool any_hit) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  INTERSECT_RUN(NUMBER, FEATURE_##FEATURE, intersect_##PREFIX, any_hit)
#include "promin/kinds/primitives.def"
}

void enter_leaf(uint child) {
  leaf_next = first_of_leaf(child);
  leaf_end = leaf_next + count_of_leaf(child);
  count_steps(0u, leaf_end - leaf_next);
}

// What is left of a leaf, up to a triangle that needs a second look.
void intersect_leaf(bool any_hit) {
  while (!needs_second_look && is_next_in_leaf(KIND_TRIANGLE, FEATURE_TRIANGLES)) {
    Primitive p = load_primitive(leaf_next);
    if (ANY_HIT != 0u) {
      glance_at_triangle(p, leaf_next);
    } else {
      intersect_packet_with_triangle(p, leaf_next, any_hit);
    }
    ++leaf_next;
  }
  if (needs_second_look) return;
  intersect_solids(any_hit);
}

// What has no box lies behind the tree's primitives.
void intersect_unbounded(bool any_hit) {
  for (uint i = first_plane(); i < end_plane(); ++i) {
    Primitive p = load_primitive(i);
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (kind_of(p) == NUMBER) {                                            \
    INTERSECT_PACKET(intersect_##PREFIX, p, i, any_hit)                  \
  }
#include "promin/kinds/primitives.def"
  }
}

// The family of a node: those of its children that are left to visit, the nearest first. The node's index in the upper
// 24 bits; how many there are, less one, in the two bits below; then which, in two bits each, the next one lowest. Of
// four the last is not told: it is the one that the others are not.
// With ANY_HIT a bit for each of the four instead, visited as they come: rays that find no hit, as most do, visit all
// that they meet in any order.
const uint NO_FAMILY = 0xFFFFFFFFu;
// Instead of a child; they have CHILD_IS_LEAF.
const uint DONE = 0xFFFFFFFFu;
const uint IN_LEAF = 0xFFFFFFFEu;  // the one that was entered

uint family;
uint stack[STACK_SIZE];  // the families of the nodes above
uint stack_top;

uint component_of(uvec4 v, uint i) {
  uvec2 half_of_v = (i & 2u) == 0u ? v.xy : v.zw;
  return (i & 1u) == 0u ? half_of_v.x : half_of_v.y;
}

uint component_of_lowest_bit(uvec4 v, uint mask) {
  return (mask & 1u) != 0u ? v.x : ((mask & 2u) != 0u ? v.y : ((mask & 4u) != 0u ? v.z : v.w));
}

// A family without the child that is next; NO_FAMILY after the last.
uint without_next(uint members) {
  if (ANY_HIT != 0u) {
    uint left = members & (members - 1u);
    return (left & 15u) == 0u ? NO_FAMILY : left;
  }
  uint others = (members >> 6) & 3u;
  uint last = (members ^ (members >> 2) ^ (members >> 4)) & 3u;
  uint left = (members & 0xFFFFFF00u) | ((others - 1u) << 6) | (last << 4) | ((members >> 2) & 15u);
  return others == 0u ? NO_FAMILY : left;
}

// The next child that is left, or DONE.
uint take_child() {
  if (family == NO_FAMILY) return DONE;
  uvec4 children = load_children(family >> 8);
  uint child = ANY_HIT != 0u ? component_of_lowest_bit(children, family) : component_of(children, family & 3u);
  family = without_next(family);
  if (family == NO_FAMILY && stack_top > 0u) {
    --stack_top;
    family = stack[stack_top];
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

const uint NOT_MET = 0xFFFFFFFFu;
const float SHIFT_TO_CULL_BY = 1.0 - 4.0 * UNIT_ROUNDOFF;

uvec4 key_where(bvec4 condition, uvec4 keys) {
  return uvec4(condition.x ? keys.x : NOT_MET, condition.y ? keys.y : NOT_MET, condition.z ? keys.z : NOT_MET,
               condition.w ? keys.w : NOT_MET);
}

// Which children are met: of each the bits of where a ray comes in first, which are in their order as none is negative,
// or NOT_MET. With ANY_HIT x has a bit for each.
const uvec4 NONE_MET = uvec4(ANY_HIT != 0u ? 0u : NOT_MET);

uvec4 add_met(uvec4 met, bvec4 are_met, vec4 entries) {
  uint mask = met.x;
  if (are_met.x) mask |= 1u;
  if (are_met.y) mask |= 2u;
  if (are_met.z) mask |= 4u;
  if (are_met.w) mask |= 8u;
  uvec4 first = min(met, key_where(are_met, floatBitsToUint(entries)));
  // No branch: glslang 12 fails over some.
  return ANY_HIT != 0u ? uvec4(mask) : first;
}

// Of the first `count` children those that are met.
uint family_of(uint index, uint count, uvec4 met) {
  if (ANY_HIT != 0u) {
    uint mask = met.x & ((1u << count) - 1u);
    return mask == 0u ? NO_FAMILY : (index << 8) | mask;
  }
  bvec4 is_met = lessThan(uvec4(0u, 1u, 2u, 3u), uvec4(count));
  is_met = bvec4(is_met.x && met.x != NOT_MET, is_met.y && met.y != NOT_MET, is_met.z && met.z != NOT_MET,
                 is_met.w && met.w != NOT_MET);
  uvec4 keys = sorted(key_where(is_met, (met & ~3u) | uvec4(0u, 1u, 2u, 3u)));
  uint others = uint(keys.y != NOT_MET) + uint(keys.z != NOT_MET) + uint(keys.w != NOT_MET);
  uint members = (index << 8) | (others << 6) | ((keys.z & 3u) << 4) | ((keys.y & 3u) << 2) | (keys.x & 3u);
  return keys.x == NOT_MET ? NO_FAMILY : members;
}

// A kernel to compare with may bring boxes of its own (tools/plain).
#ifndef OTHER_BOXES
// The children of a node that a ray of the packet meets, as its family. A box is met if entry <= exit; <=, so that one
// at the distance of the hit so far is still opened: its primitive may have a lower number. (origin - ray's origin)
// comes first, never byte * scale * inverse - origin * inverse, which cancels. No hit hidden in 3.6e5 rays at edges and
// corners, offset 0...1e5 (hard case 28; 5 % without padding), nor in 1e6 through mixed scenes (hard case 38).
uint meet_children(uint index) {
  NodeBoxes node = load_boxes(index);
  vec3 origin = origin_of(node);
  vec3 scale = steps_of(node);
  uvec3 lo = low_planes_of(node);
  uvec3 hi = high_planes_of(node);
  bvec3 is_backward = lessThan(octant, vec3(0.0));
  uvec3 near = uvec3(is_backward.x ? hi.x : lo.x, is_backward.y ? hi.y : lo.y, is_backward.z ? hi.z : lo.z);
  uvec3 far = uvec3(is_backward.x ? lo.x : hi.x, is_backward.y ? lo.y : hi.y, is_backward.z ? lo.z : hi.z);
  vec4 near_x = unpack_bytes(near.x);
  vec4 near_y = unpack_bytes(near.y);
  vec4 near_z = unpack_bytes(near.z);
  vec4 far_x = unpack_bytes(far.x);
  vec4 far_y = unpack_bytes(far.y);
  vec4 far_z = unpack_bytes(far.z);

  uvec4 met = NONE_MET;
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
    vec4 exit = lesser(far_t_x, lesser(far_t_y, far_t_z));
    // A little more than what is left, as t is rounded when the shift comes to it.
    precise float limit = limits[ray] - SHIFT_TO_CULL_BY * shifts[ray];
    met = add_met(met, lessThanEqual(entry, lesser(exit, vec4(limit))), entry);
  }

  return family_of(index, child_count_of(node), met);
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
  needs_second_look = false;
  uint current = any_takes_part() ? 0u : DONE;
  // Loops rather than branches around the parts: CPU drivers execute both sides of a branch under a mask, but leave a
  // loop as soon as no lane is in it.
  for (;;) {
    while (current != DONE && !needs_second_look) {
      while (is_inner(current)) {
        count_steps(1u, 0u);
        enter_family(meet_children(current));
        current = take_child();
      }
      if (current == DONE) break;
      if (current != IN_LEAF) enter_leaf(current);
      intersect_leaf(any_hit);
      current = IN_LEAF;
      if (needs_second_look) break;
      current = any_hit && !any_takes_part() ? DONE : take_child();
    }
    if (ANY_HIT == 0u || !needs_second_look) break;
    intersect_packet_with_triangle(load_primitive(leaf_next - 1u), leaf_next - 1u, any_hit);
    needs_second_look = false;
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
// NO_PRIMITIVE. With ANY_HIT only that and `order` are told.
void trace_packet(bool any_hit) {
  [[unroll]] for (uint ray = 0u; ray < PACKET_SIZE; ++ray) {
    shifts[ray] = 0.0;
    found[ray] = Hit(packet[ray].tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
    limits[ray] = packet[ray].tmin < packet[ray].tmax ? packet[ray].tmax : -1.0;
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (has(FEATURE_##FEATURE)) intersect_unbounded(any_hit);
#include "promin/kinds/primitives.def"
  if (TREE_KIND_COUNT == 0u) return;
  descend_from_nearby(any_hit);
}

// A single ray; for kernels with packets of one.
Hit trace(Ray ray, bool any_hit) {
  packet[0] = ray;
  trace_packet(any_hit);
  return found[0];
}
