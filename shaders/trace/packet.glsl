// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The PACKET_SIZE rays that an invocation traces together. They share the stack and the fetching and unpacking of nodes
// and primitives, but each ray is tested separately. This is faster on CPU drivers for neighbouring rays. A ray's index
// in the packet is its slot.

// The rays, set by the entry point. descend_from_nearby temporarily changes their origins.
Ray packet[PACKET_SIZE];
// The results of the rays: the nearest hit so far. trace_packet resets it; keep_nearest and glance_at_triangle set it.
Hit found[PACKET_SIZE];
// The largest t of a hit; negative for a ray that is not traced. The same functions set it, and descend_by_octants
// excludes the rays of other octants with it.
float limits[PACKET_SIZE];
// The distance by which the origin is moved along the ray. In intersections, t is smaller by this distance.
// descend_from_nearby sets it.
float shifts[PACKET_SIZE];
// The inverse direction of one of the traced rays. All traced rays have the same signs. The callers of descend set it.
vec3 octant;

// The visibility of surfaces for the packet's rays, set by the entry point. Rays to light also hit the backs of
// surfaces, use the finest level of textures, and pass planes that catch shadows.
bool passes_backs = false;  // with FEATURE_ONE_SIDED: whether rays ignore backs that are not shown
bool passes_catchers = false;  // with FEATURE_SHADOW_CATCHERS: whether rays ignore planes that catch shadows
float sight_width = 0.0;    // width of a ray's cone at its origin, with FEATURE_HOLES
float sight_spread = 0.0;   // growth of this width per distance
// State of rays that pass through surfaces (PASSES). Hits with a smaller t have been passed and do not count. Neither
// do hits at this t whose order is not higher. The entry point sets it.
const uint PASSES = FEATURE_BIT(FEATURE_BLENDING) | FEATURE_BIT(FEATURE_GLASS);
float passed_t[PACKET_SIZE];
uint passed_order[PACKET_SIZE];

// State with FEATURE_GLASS: a refracted ray starts slightly before the face that it passes through, so that it hits
// objects that touch the face (tree.glsl). Up to this t it skips faces of the object that it crosses in the same
// direction. The object is given by its hash (object_hash_of), with SKIPS_EXIT if the ray leaves it.
const uint SKIPS_EXIT = 0x10000u;
float skipped_until = -1.0;
uint skipped_object = 0u;
bool is_skipped(float t, Primitive p, bool leaves) {
  uint object = has(FEATURE_INSTANCES) && is_in_instance ? inside_hash : object_hash_of(p);
  return t <= skipped_until && (object | (leaves ? SKIPS_EXIT : 0u)) == skipped_object;
}

// Resets the state of a ray to its start.
void forget_passed(uint slot) {
  passed_t[slot] = -1.0;
  passed_order[slot] = 0u;
}

// Continues the ray behind its hit. It stays the same ray, so it hits everything else at the same t as before.
void pass(uint slot, float t, uint order) {
  passed_t[slot] = t;
  passed_order[slot] = order;
  // Other surfaces at the same t have not been passed yet, so tmin is slightly smaller than t.
  packet[slot].tmin = t > 0.0 ? uintBitsToFloat(floatBitsToUint(t) - 1u) : 0.0;
}

// Returns whether a triangle is absent for a ray of this direction. It is absent at a hole in its texture, and on its
// back if the back is not shown. For surfaces that are seen through, it is also absent at an edge that belongs to a
// neighbour (cutouts.glsl). Rays of cast.comp only see geometry.
const uint MAY_BE_CUT_OUT =
    FEATURE_BIT(FEATURE_HOLES) | FEATURE_BIT(FEATURE_ONE_SIDED) | PASSES;
bool is_cut_out(vec3 direction, Primitive p, uint index, Crossing crossing, bool is_on_open_edge);
bool may_have_holes(uint index);
// Returns whether an unbounded primitive catches shadows (Unlit::catches_shadows).
bool is_catcher(uint index);

// Counts of the invocation: x = node steps, y = primitive tests. The entry point sets them to 0.
uvec2 step_counts;

void count_steps(uint nodes, uint tests) {
  if (has(FEATURE_STEP_COUNTS)) step_counts += uvec2(nodes, tests);
}

bool any_takes_part() {
  bool result = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) result = result || limits[slot] >= 0.0;
  return result;
}

// Returns the ray for intersecting a solid: after passing one of the solid's surfaces it searches for the next.
Ray ray_past(uint slot, Primitive p) {
  Ray ray = packet[slot];
  if (PASSES != 0u && order_of(p) <= passed_order[slot] && passed_t[slot] > 0.0) {
    ray.tmin = shifts[slot] > 0.0 ? shifted_tmin(passed_t[slot], shifts[slot]) : passed_t[slot];
  }
  // The solid's entry is skipped too.
  if (has(FEATURE_GLASS) && skipped_until > 0.0 && object_hash_of(p) == skipped_object) {
    ray.tmin = max(ray.tmin, shifts[slot] > 0.0 ? shifted_tmin(skipped_until, shifts[slot]) : skipped_until);
  }
  return ray;
}

// Returns a solid's crossing, or NO_CROSSING if it is skipped. Nearer crossings of ray_past are exits.
Crossing not_skipped(uint slot, Crossing crossing, Primitive p) {
  if (!has(FEATURE_GLASS)) return crossing;
  precise float t = crossing.t + shifts[slot];
  if (is_skipped(t, p, true)) return NO_CROSSING;
  return crossing;
}

// Stores the crossing if it is nearer than the hit so far, or equally near with a lower number. The hit therefore does
// not depend on the tree.
void keep_nearest(uint slot, Crossing crossing, uint primitive, uint order, bool asks_for_any) {
  precise float t = in_world(slot, crossing.t) + shifts[slot];
  if (has(FEATURE_INSTANCES)) {
    // In an instance the ray's own tmin is only a lower bound.
    if (!(t > unmoved_tmins[slot])) return;
  }
  if (PASSES != 0u) {
    if (t < passed_t[slot] || (t == passed_t[slot] && order <= passed_order[slot])) return;
  }
  if (crossing.t > packet[slot].tmin && (t < limits[slot] || (t == limits[slot] && order < found[slot].order))) {
    found[slot] = Hit(t, crossing.u, crossing.v, crossing.part, primitive, order);
    limits[slot] = asks_for_any ? -1.0 : t;
  } else if (has(FEATURE_INSTANCES)) {
    // If the scene has too many primitives, those of an instance have the same number.
    bool is_tie = t == limits[slot] && order == found[slot].order && primitive < found[slot].primitive;
    if (crossing.t > packet[slot].tmin && is_tie && found[slot].primitive != NO_PRIMITIVE) {
      found[slot] = Hit(t, crossing.u, crossing.v, crossing.part, primitive, order);
    }
  }
}
