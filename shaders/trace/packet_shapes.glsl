// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Intersects a packet with shapes; there is a function for each kind except triangles (packet_triangles.glsl). Kernels
// for all crossings use packet_crossings.glsl in place of both.

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                      \
  void intersect_packet_with_##PREFIX(Primitive p, uint index, bool asks_for_any) {       \
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {                         \
      Crossing crossing = not_skipped(slot, intersect_##PREFIX(ray_past(slot, p), p), p); \
      keep_nearest(slot, crossing, index, order_of(p), asks_for_any);                     \
    }                                                                                     \
  }
#include "promin/kinds/primitives.def"
