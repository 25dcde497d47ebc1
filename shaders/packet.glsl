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

// Takes the crossing if it is nearer, or as near and of a lower number: the hit does not depend on the tree.
void keep_nearest(uint slot, Crossing crossing, uint primitive, uint order, bool asks_for_any) {
  precise float t = crossing.t + shifts[slot];
  if (crossing.t > packet[slot].tmin && (t < limits[slot] || (t == limits[slot] && order < found[slot].order))) {
    found[slot] = Hit(t, crossing.u, crossing.v, crossing.part, primitive, order);
    limits[slot] = asks_for_any ? -1.0 : t;
  }
}
