// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// cast.glsl for nearest hits without intersections: each ray is tested against the boxes of every node. What it tells
// instead of a hit is which of the last node's children it meets, a bit each, in the place of u; t counts all that it
// meets.

uint children_of(uint family) {
  if (family == NO_FAMILY) return 0u;
  uint others = (family >> FAMILY_OTHERS_SHIFT) & FAMILY_PLACE_MASK;
  if (others == 3u) return 15u;
  uint children = 1u << (family & FAMILY_PLACE_MASK);
  if (others >= 1u) children |= 1u << ((family >> FAMILY_SECOND_SHIFT) & FAMILY_PLACE_MASK);
  if (others >= 2u) children |= 1u << ((family >> FAMILY_THIRD_SHIFT) & FAMILY_PLACE_MASK);
  return children;
}

void test_every_box(bool asks_for_any) {
  shifts[0] = 0.0;
  limits[0] = packet[0].tmin < packet[0].tmax ? packet[0].tmax : -1.0;
  octant = packet[0].inverse_direction;
  uint children = 0u;
  uint count = 0u;
  // A scene of boxes has as many nodes as its first plane's index says (tools/reporting/box_section.cpp).
  for (uint i = 0u; i < first_unbounded(); ++i) {
    children = children_of(meet_children(i));
    count += uint(bitCount(children));
  }
  found[0] = Hit(float(count) + 1.0, uintBitsToFloat(children), 0.0, PART_SIDE, 0u, 0u);
}

#define trace_packet test_every_box
#include "shaders/cast.glsl"
