// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// cast.glsl without a tree: each ray is tested against every primitive, so that nothing but the tests takes time and
// no box hides what they answer. For a scene of one kind of primitive.

void test_every_primitive(bool any_hit) {
  shifts[0] = 0.0;
  found[0] = Hit(packet[0].tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
  limits[0] = packet[0].tmin < packet[0].tmax ? packet[0].tmax : -1.0;
  if (has(FEATURE_PLANES)) intersect_unbounded(any_hit);
  if (TREE_KIND_COUNT == 0u) return;
  leaf_next = 0u;
  leaf_end = first_plane();
  INTERSECT_RUN(KIND_TRIANGLE, FEATURE_TRIANGLES, intersect_triangle, any_hit)
  intersect_solids(any_hit);
}

#define trace_packet test_every_primitive
#include "shaders/cast.glsl"
