// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Replaces packet_shapes.glsl and packet_triangles.glsl in kernels for all crossings: crossings of a packet's rays are
// counted or, with LISTS_CROSSINGS, listed in the order of the tree. Limits are never lowered. A primitive that the
// tree references twice is crossed twice, with the same bits; the host drops the second crossing.

layout(constant_id = CONSTANT_LISTS_CROSSINGS) const uint LISTS_CROSSINGS = 0u;

// The following variables are set by the entry point, which also resets the counts. For each ray they are: the number
// of crossings so far; the first record and the size of its list; the factor from t here to t in units of the given
// direction; and the interval of this t in which crossings count.
uint crossing_counts[PACKET_SIZE];
uint first_places[PACKET_SIZE];
uint rooms[PACKET_SIZE];
float units[PACKET_SIZE];
float given_tmins[PACKET_SIZE];
float given_tmaxs[PACKET_SIZE];

// If the units differ from the given ones by at most this factor, nothing overflows or underflows where a glance is
// certain.
const float PLAIN_UNITS = 1048576.0;  // 2^20

void take_crossing(uint slot, Crossing crossing, uint primitive, uint order, uint leaves) {
  precise float t = in_world(slot, crossing.t) + shifts[slot];
  precise float given_t = t * units[slot];
  bool counts = crossing.t > packet[slot].tmin && t < limits[slot] && given_t > given_tmins[slot] &&
                given_t < given_tmaxs[slot];
  if (LISTS_CROSSINGS != 0u && counts && crossing_counts[slot] < rooms[slot]) {
    hits[first_places[slot] + crossing_counts[slot]] =
        HitRecord(uvec4(floatBitsToUint(t), order, floatBitsToUint(vec2(crossing.u, crossing.v))),
                  uvec4(primitive, crossing.part, leaves, 0u));
  }
  crossing_counts[slot] += counts ? 1u : 0u;
}

#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                                        \
  void intersect_packet_with_##PREFIX(Primitive p, uint index, bool asks_for_any) {                         \
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {                                           \
      Inside ends = ends_of_##PREFIX(packet[slot], p);                                                      \
      take_crossing(slot, Crossing(ends.entry, 0.0, 0.0, ends.entry_part), index, order_of(p), 0u);         \
      take_crossing(slot, Crossing(ends.exit, 0.0, 0.0, ends.exit_part), index, order_of(p), 1u);           \
    }                                                                                                       \
  }
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                          \
  void intersect_packet_with_##PREFIX(Primitive p, uint index, bool asks_for_any) {               \
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {                                 \
      take_crossing(slot, intersect_##PREFIX(packet[slot], p), index, order_of(p), 0u);           \
    }                                                                                             \
  }
#include "promin/kinds/primitives.def"

// Returns the rounding error of a product of numbers up to 2. The result is exact if it is at least 2^-100 (Dekker, "A
// Floating-Point Technique for Extending the Available Precision", 1971).
float product_error(float a, float b, float product) {
  precise float split_a = 4097.0 * a;
  precise float a_high = split_a - (split_a - a);
  precise float a_low = a - a_high;
  precise float split_b = 4097.0 * b;
  precise float b_high = split_b - (split_b - b);
  precise float b_low = b - b_high;
  precise float error = ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
  return error;
}

// Returns whether the area over an edge, to.x * from.y - to.y * from.x, is positive. The result is exact: if the two
// products round to the same number, their rounding errors decide, and if the ray hits the edge, leads_up decides. All
// triangles therefore agree about the positions of the mesh's corners in the plane. If a ray moves across an edge, it
// leaves one triangle exactly when it enters the other. Without exactness there could be one crossing too many at a
// corner between slivers.
bool has_positive_area(vec2 from, vec2 to) {
  // Scaling by a power of two is exact and keeps the sign.
  precise vec2 a = from * power_of_two_inverse(max(abs(from.x), abs(from.y)));
  precise vec2 b = to * power_of_two_inverse(max(abs(to.x), abs(to.y)));
  precise float added = b.x * a.y;
  precise float taken = b.y * a.x;
  float added_error = product_error(b.x, a.y, added);
  float taken_error = product_error(b.y, a.x, taken);
  bool is_tie = added == taken && added_error == taken_error;
  bool is_more = added > taken || (added == taken && added_error > taken_error);
  return is_tie ? leads_up(from, to) : is_more;
}

bool is_crossed(ShearedTriangle sheared) {
  bool side = has_positive_area(sheared.b, sheared.c);
  // If all three corners coincide in the plane, each lies on the same side of the others.
  bool is_point = sheared.a == sheared.b && sheared.b == sheared.c;
  return has_positive_area(sheared.c, sheared.a) == side && has_positive_area(sheared.a, sheared.b) == side && !is_point;
}

// Returns the triangle for cross_triangle. If the triangle is seen edge-on, its areas may be too small for weights. Any
// weights are then good enough, because the point is moved back to the ray along the longest side.
ShearedTriangle with_weights(ShearedTriangle sheared) {
  bool has_area = abs(sheared.determinant) >= SMALLEST_NORMAL;
  sheared.areas = has_area ? sheared.areas : vec3(1.0);
  sheared.determinant = has_area ? sheared.determinant : 3.0;
  sheared.may_be_met = true;
  return sheared;
}

// Only few rays of a packet hit a triangle whose box they hit. The code first tests whether each ray may hit it, and
// then computes the hits one after the other.
void intersect_packet_with_triangle(Primitive p, uint index, bool asks_for_any) {
  ShearedTriangle sheared[PACKET_SIZE];
  bool may_be_crossed[PACKET_SIZE];
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    sheared[slot] = shear_triangle(packet[slot], p);
    may_be_crossed[slot] = sheared[slot].least >= 0.0 && limits[slot] >= 0.0;
  }
  bool may_another_be_crossed;
  do {
    uint next = 0u;
    bool is_found = may_be_crossed[0];
    ShearedTriangle of_next = sheared[0];
    float shear_z = packet[0].shear.z;
    float tmin = packet[0].tmin;
    [[unroll]] for (uint slot = 1u; slot < PACKET_SIZE; ++slot) {
      if (is_found || !may_be_crossed[slot]) continue;
      next = slot;
      is_found = true;
      of_next = sheared[slot];
      shear_z = packet[slot].shear.z;
      tmin = packet[slot].tmin;
    }
    Crossing crossing = cross_triangle(with_weights(of_next), shear_z, tmin);
    if (!is_found || !is_crossed(of_next)) crossing = NO_CROSSING;
    may_another_be_crossed = false;
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      if (slot == next) {
        if (has(FEATURE_INSTANCES) && is_in_instance) crossing.part = inside_part;
        take_crossing(slot, crossing, index, number_of(p), 0u);
        may_be_crossed[slot] = false;
      }
      may_another_be_crossed = may_another_be_crossed || may_be_crossed[slot];
    }
  } while (may_another_be_crossed);
}

// Counts the crossings if a glance is certain for every ray. Returns true if it is not certain; the triangle then needs
// a second look by intersect_packet_with_triangle. A glance cannot write a list.
bool glance_at_triangle(Primitive p, uint index) {
  bool needs_second_look = false;
  bool is_sure[PACKET_SIZE];
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    ShearedTriangle sheared = shear_triangle(packet[slot], p);
    Glance glance = glance_at(sheared, packet[slot].shear.z, packet[slot].tmin, in_level(slot, limits[slot]));
    bool may_be_crossed = sheared.least >= 0.0 && limits[slot] >= 0.0;
    precise float inverse_limit = 1.0 / PLAIN_UNITS;
    bool is_plain = shifts[slot] == 0.0 && units[slot] <= PLAIN_UNITS && units[slot] >= inverse_limit;
    is_sure[slot] = LISTS_CROSSINGS == 0u && may_be_crossed && glance.is_met && is_plain;
    needs_second_look = needs_second_look || (may_be_crossed && !is_sure[slot] && !(glance.is_missed && is_plain));
  }
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    crossing_counts[slot] += is_sure[slot] && !needs_second_look ? 1u : 0u;
  }
  return needs_second_look;
}

// With ALL_ASK_FOR_ANY, nothing calls this function.
bool may_meet_triangle(Primitive p) { return true; }
