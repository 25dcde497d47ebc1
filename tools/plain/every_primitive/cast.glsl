// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// cast.glsl without a tree: each ray is tested against every primitive, so that nothing but the tests takes time and
// no box hides what they answer. For a scene of one kind of primitive.

void test_every_primitive(bool asks_for_any) {
  shifts[0] = 0.0;
  found[0] = Hit(packet[0].tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
  limits[0] = packet[0].tmin < packet[0].tmax ? packet[0].tmax : -1.0;
  if (UNBOUNDED_KIND_COUNT > 0u) intersect_unbounded(asks_for_any);
  if (TREE_KIND_COUNT == 0u) return;
  leaf = Leaf(0u, first_unbounded(), false, false);
  while (has(FEATURE_TRIANGLES) && is_next_in_leaf(KIND_TRIANGLE)) {
    Primitive p = load_primitive(leaf.next);
    keep_nearest(0u, intersect_triangle(packet[0], p), leaf.next, order_of(p), asks_for_any);
    ++leaf.next;
  }
  intersect_solids(asks_for_any);
}

#define trace_packet test_every_primitive
#include "shaders/cast.glsl"
