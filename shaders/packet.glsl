// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The rays that an invocation traces together, PACKET_SIZE of them: they share the fetching and unpacking of nodes and
// primitives and the stack, and each is tested on its own. It pays on CPU drivers, for rays that run side by side. A
// ray's place in the packet is its slot.

// What is asked, by the entry point. descend_from_nearby lends the rays other origins and gives theirs back.
Ray packet[PACKET_SIZE];
// What is answered: the nearest hit so far. trace_packet empties it, keep_nearest and glance_at_triangle fill it.
Hit found[PACKET_SIZE];
// The t that a hit may have at most; negative for a ray that takes no part. By the same, and descend_by_octants leaves
// out the rays whose turn it is not.
float limits[PACKET_SIZE];
// By how much the origin is moved along the ray: what intersections call t is so much less. By descend_from_nearby.
float shifts[PACKET_SIZE];
// Inverse direction of one of the rays that take part: all have its signs. By who calls descend.
vec3 octant;

// How the packet's rays see. By the entry point; shadow rays see backs, and textures at their finest level.
bool passes_backs = false;  // with FEATURE_ONE_SIDED
float sight_width = 0.0;    // of a ray's cone where it begins, with FEATURE_HOLES,
float sight_spread = 0.0;   // and how much it grows at a distance of 1
// Where rays pass through surfaces (PASSES): what a ray has passed counts no more, which is all that is nearer than
// this, and at this t what has no higher order. By the entry point.
const uint PASSES = FEATURE_BIT(FEATURE_BLENDING) | FEATURE_BIT(FEATURE_GLASS);
float passed_t[PACKET_SIZE];
uint passed_order[PACKET_SIZE];

// With FEATURE_GLASS: a refracted ray begins a little before the face that it comes through, so that it meets what
// touches that (tree.glsl). Up to here, in its units, it meets no face of that object which it crosses in the same
// sense: the object's hash (object_hash_of), with SKIPS_EXIT where it leaves.
const uint SKIPS_EXIT = 0x10000u;
float skipped_until = -1.0;
uint skipped_object = 0u;
bool is_skipped(float t, Primitive p, bool leaves) {
  return t <= skipped_until && (object_hash_of(p) | (leaves ? SKIPS_EXIT : 0u)) == skipped_object;
}

// The ray from its beginning on.
void forget_passed(uint slot) {
  passed_t[slot] = -1.0;
  passed_order[slot] = 0u;
}

// The ray from behind what it has met on; the same ray, so that it meets all else at the same t as before.
void pass(uint slot, float t, uint order) {
  passed_t[slot] = t;
  passed_order[slot] = order;
  // What lies at the same t is not passed yet.
  packet[slot].tmin = t > 0.0 ? uintBitsToFloat(floatBitsToUint(t) - 1u) : 0.0;
}

// Whether there is nothing of a triangle where a ray of this direction crosses it: a hole in its texture, its back
// where that is not shown, or of what is seen through an edge that is a neighbour's (cutouts.glsl; cast.comp has rays
// that see geometry alone).
const uint MAY_BE_CUT_OUT =
    FEATURE_BIT(FEATURE_HOLES) | FEATURE_BIT(FEATURE_ONE_SIDED) | PASSES;
bool is_cut_out(vec3 direction, Primitive p, uint index, Crossing crossing, bool is_on_open_edge);
bool may_have_holes(uint index);

// What the invocation's rays took: x = node steps, y = primitive tests. The entry point sets it to zero.
uvec2 step_counts;

void count_steps(uint nodes, uint tests) {
  if (has(FEATURE_STEP_COUNTS)) step_counts += uvec2(nodes, tests);
}

bool any_takes_part() {
  bool result = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) result = result || limits[slot] >= 0.0;
  return result;
}

// A ray as a solid takes it: of the surfaces of one that it has passed the next is sought.
Ray ray_past(uint slot, Primitive p) {
  Ray ray = packet[slot];
  if (PASSES != 0u && order_of(p) <= passed_order[slot] && passed_t[slot] > 0.0) {
    ray.tmin = shifts[slot] > 0.0 ? shifted_tmin(passed_t[slot], shifts[slot]) : passed_t[slot];
  }
  // Where the way in is skipped too.
  if (has(FEATURE_GLASS) && skipped_until > 0.0 && object_hash_of(p) == skipped_object) {
    ray.tmin = max(ray.tmin, shifts[slot] > 0.0 ? shifted_tmin(skipped_until, shifts[slot]) : skipped_until);
  }
  return ray;
}

// A solid's crossing, unless it is skipped. What ray_past lets through nearer than that is a way out.
Crossing not_skipped(uint slot, Crossing crossing, Primitive p) {
  if (!has(FEATURE_GLASS)) return crossing;
  precise float t = crossing.t + shifts[slot];
  if (is_skipped(t, p, true)) return NO_CROSSING;
  return crossing;
}

// Takes the crossing if it is nearer, or as near and of a lower number: the hit does not depend on the tree.
void keep_nearest(uint slot, Crossing crossing, uint primitive, uint order, bool asks_for_any) {
  precise float t = crossing.t + shifts[slot];
  if (PASSES != 0u) {
    if (t < passed_t[slot] || (t == passed_t[slot] && order <= passed_order[slot])) return;
  }
  if (crossing.t > packet[slot].tmin && (t < limits[slot] || (t == limits[slot] && order < found[slot].order))) {
    found[slot] = Hit(t, crossing.u, crossing.v, crossing.part, primitive, order);
    limits[slot] = asks_for_any ? -1.0 : t;
  }
}
