// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Intersects a packet with triangles. Kernels for comparisons provide a file of this name with these functions
// (tools/plain).

// Only few rays of a packet hit a triangle whose box they hit. The code first tests whether each ray may hit it, and
// then computes the hits one after the other.
void intersect_packet_with_triangle(Primitive p, uint index, bool asks_for_any) {
  ShearedTriangle sheared[PACKET_SIZE];
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    sheared[slot] = shear_triangle(packet[slot], p);
    sheared[slot].may_be_met = sheared[slot].may_be_met && limits[slot] >= 0.0;
  }
  bool may_another_be_met;
  do {
    uint next = 0u;
    ShearedTriangle of_next = sheared[0];
    float shear_z = packet[0].shear.z;
    float tmin = packet[0].tmin;
    vec3 direction = packet[0].direction;
    float limit = limits[0];
    float shift = shifts[0];
    float unit = 1.0;
    if (has(FEATURE_INSTANCES)) {
      unit = to_world[0];
      world_direction = upper_rays[0].direction;
    }
    [[unroll]] for (uint slot = 1u; slot < PACKET_SIZE; ++slot) {
      if (of_next.may_be_met || !sheared[slot].may_be_met) continue;
      next = slot;
      of_next = sheared[slot];
      shear_z = packet[slot].shear.z;
      tmin = packet[slot].tmin;
      direction = packet[slot].direction;
      limit = limits[slot];
      shift = shifts[slot];
      if (has(FEATURE_INSTANCES)) {
        unit = to_world[slot];
        world_direction = upper_rays[slot].direction;
      }
    }
    Crossing crossing = cross_triangle(of_next, shear_z, tmin);
    if (MAY_BE_CUT_OUT != 0u) {
      precise float t = crossing.t + shift;
      if (has(FEATURE_INSTANCES)) {
        precise float scaled = crossing.t * unit + shift;
        t = scaled;
      }
      bool may_be_kept = crossing.t > tmin && t <= limit;
      // This t is relative to the ray's own origin.
      Crossing whole = Crossing(t, crossing.u, crossing.v, crossing.part);
      if (has(FEATURE_GLASS) && is_skipped(t, p, dot3(triangle_normal(p), direction) > 0.0)) crossing = NO_CROSSING;
      if (has(FEATURE_INSTANCES) && is_in_instance) whole.part = inside_part;
      if (may_be_kept && is_cut_out(direction, p, index, whole, is_on_open_edge(of_next))) crossing = NO_CROSSING;
    }
    may_another_be_met = false;
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      if (slot == next) {
        if (has(FEATURE_INSTANCES) && is_in_instance) crossing.part = inside_part;
        keep_nearest(slot, crossing, index, number_of(p), asks_for_any);
        sheared[slot].may_be_met = false;
      }
      may_another_be_met = may_another_be_met || sheared[slot].may_be_met;
    }
  } while (may_another_be_met);
}

// With ALL_ASK_FOR_ANY, tests the triangle by a glance, which is certain for most rays. Returns true if it is not
// certain for a ray; the triangle then needs a second look by intersect_packet_with_triangle.
bool glance_at_triangle(Primitive p, uint index) {
  bool needs_second_look = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    ShearedTriangle sheared = shear_triangle(packet[slot], p);
    Glance glance = glance_at(sheared, packet[slot].shear.z, packet[slot].tmin, in_level(slot, limits[slot]));
    bool may_be_met = sheared.may_be_met && limits[slot] >= 0.0;
    // The limit of a ray with a moved origin is not exact, so its glance is not certain.
    bool is_met = may_be_met && glance.is_met && shifts[slot] == 0.0;
    // Many rays in instances have a moved origin. Their interval is exact if it has no ends.
    bool is_unlimited = limits[slot] == INFINITY && packet[slot].tmin == 0.0;
    if (has(FEATURE_INSTANCES)) is_met = is_met || (may_be_met && glance.is_met && is_unlimited);
    if (has(FEATURE_HOLES) && is_met && may_have_holes(index)) is_met = false;
    needs_second_look = needs_second_look || (may_be_met && !is_met && !glance.is_missed);
    if (is_met) {
      found[slot].primitive = index;
      found[slot].order = number_of(p);
      limits[slot] = -1.0;
    }
  }
  return needs_second_look;
}

// Returns whether a ray of the packet may hit the triangle, by a glance that keeps no hit.
bool may_meet_triangle(Primitive p) {
  bool may_be_met = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    ShearedTriangle sheared = shear_triangle(packet[slot], p);
    Glance glance = glance_at(sheared, packet[slot].shear.z, packet[slot].tmin, limits[slot]);
    bool is_missed = glance.is_missed && shifts[slot] == 0.0;
    may_be_met = may_be_met || (sheared.may_be_met && limits[slot] >= 0.0 && !is_missed);
  }
  return may_be_met;
}
