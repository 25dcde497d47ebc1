// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// This is packet_triangles.glsl without the fast test: the textbook's test alone decides whether a ray hits a
// triangle.

void intersect_packet_with_triangle(Primitive p, uint index, bool asks_for_any) {
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    keep_nearest(slot, intersect_triangle(packet[slot], p), index, order_of(p), asks_for_any);
  }
}

bool glance_at_triangle(Primitive p, uint index) {
  intersect_packet_with_triangle(p, index, true);
  return false;
}

bool may_meet_triangle(Primitive p) { return true; }
