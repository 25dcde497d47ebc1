// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Traversal of two levels (docs/instances.md): the upper level has instances in place of some leaves. Rays that reach
// an instance continue in the space of its mesh. Both levels are in one buffer, so lanes on different levels take steps
// together. The rays of a packet have one octant on the upper level, but may have several in the instance, which is
// then entered once for each of them.

// The number of leaves after which lanes that have reached an instance or its end change the level, even if others
// have not.
const uint LEAVES_PER_LEVEL = 8u;

// The shifts of the rays on the upper level. start_levels sets them.
float upper_shifts[PACKET_SIZE];
// The limits of the rays that have not been in the instance yet and wait while others of the packet are there, and the
// limits of those that have been there and wait for the others. They are negative for all other rays.
float suspended[PACKET_SIZE];
float finished[PACKET_SIZE];
uint entered = 0u;  // the instance's child word

// Lanes are idle on a node while they wait for the change of their level.
bool is_in_tree(uint current) { return current != DONE && !is_instance(current); }

void start_levels() {
  is_in_instance = false;
  upper_family = NO_FAMILY;
  upper_stack_top = 0u;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    upper_rays[slot] = packet[slot];
    upper_shifts[slot] = shifts[slot];
    suspended[slot] = -1.0;
    finished[slot] = -1.0;
    to_world[slot] = 1.0;
    to_level[slot] = 1.0;
  }
}

void return_to_world() {
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    packet[slot] = upper_rays[slot];
    shifts[slot] = upper_shifts[slot];
    to_world[slot] = 1.0;
    to_level[slot] = 1.0;
  }
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    if (PACKET_SIZE == 1u || limits[slot] >= 0.0) octant = packet[slot].inverse_direction;
  }
}

// Sets a ray of the packet. The ray is an out parameter and not returned, because the ray on one level depends on the
// ray on the other: glslang 12 never ends if such a cycle passes through the result of a call
// (propagateNoContraction.cpp).
void make_level_ray(vec3 origin, vec3 direction, float tmin, out Ray ray) {
  ray = make_ray(origin, direction, tmin, INFINITY);
}

// Puts a ray of the packet into the space of the instance's mesh. If the ray starts farther from the mesh's origin than
// four radii, its origin is first moved near the instance, as in descend_from_nearby, because the error of R v grows
// with v. The same ray always gives the same bits.
void put_in_instance(uint slot, InstanceMap map, float radius) {
  vec3 along = upper_rays[slot].direction;
  precise vec3 from_instance = upper_rays[slot].origin - map.origin;
  precise float distance = max_abs(from_instance) - 4.0 * radius;
  precise float wanted = 0.999 * distance / max_abs(along);
  float shift = distance > 0.0 ? uintBitsToFloat(floatBitsToUint(wanted) & 0xFFFFF000u) : 0.0;
  vec3 upper = uintBitsToFloat(floatBitsToUint(along) & 0xFFFFF000u);
  precise vec3 near = (from_instance + shift * upper) + shift * (along - upper);
  precise float sum = upper_shifts[slot] + shift;
  vec3 direction = times_rows(map.r0, map.r1, map.r2, along);
  // keep_nearest compares the t in the world with the exact tmin.
  precise float earliest = (unmoved_tmins[slot] - sum) - 4.0 * UNIT_ROUNDOFF * (unmoved_tmins[slot] + sum);
  float tmin = sum > 0.0 ? max(earliest, 0.0) : unmoved_tmins[slot];
  Ray ray;
  make_level_ray(times_rows(map.r0, map.r1, map.r2, near), direction, tmin, ray);
  packet[slot] = ray;
  shifts[slot] = sum;
  to_world[slot] = power_of_two_inverse(max_abs(direction));
  to_level[slot] = power_of_two_inverse(to_world[slot]);
}

// Lets the active rays enter an instance. A ray waits if its octant differs from that of the first.
uint enter_instance(uint child) {
  uint record = child & CHILD_INSTANCE_INDEX;
  InstanceMap map = load_instance_map(record);
  uvec4 last = load_node_words(record, 3u);
  is_in_instance = true;
  inside_radius = uintBitsToFloat(last.x);
  inside_order = last.z;
  inside_part = record + FIRST_INSTANCE_PART;
  if (has(FEATURE_GLASS)) inside_hash = load_instance_look(inside_part).bits & INSTANCE_HASH_MASK;
  bool is_chosen = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    put_in_instance(slot, map, uintBitsToFloat(last.w));
    vec3 inverse = packet[slot].inverse_direction;
    bool is_active = PACKET_SIZE == 1u || limits[slot] >= 0.0;
    octant = is_active && !is_chosen ? inverse : octant;
    is_chosen = is_chosen || is_active;
    bool joins = is_active && all(equal(lessThan(inverse, vec3(0.0)), lessThan(octant, vec3(0.0))));
    if (PACKET_SIZE > 1u) {
      suspended[slot] = is_active && !joins ? limits[slot] : -1.0;
      limits[slot] = joins ? limits[slot] : -1.0;
    }
  }
  entered = child;
  upper_family = descent.family;
  upper_stack_top = descent.stack_top;
  descent.family = NO_FAMILY;
  return last.y;
}

// Lets the rays leave an instance. Returns the instance again if other rays of the packet wait for it, otherwise the
// next child.
uint leave_instance(bool asks_for_any) {
  is_in_instance = false;
  descent = Descent(upper_family, upper_stack_top);
  upper_stack_top = 0u;
  bool is_any_suspended = false;
  if (PACKET_SIZE > 1u) {
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      is_any_suspended = is_any_suspended || suspended[slot] >= 0.0;
    }
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      finished[slot] = limits[slot] >= 0.0 ? limits[slot] : finished[slot];
      limits[slot] = is_any_suspended ? suspended[slot] : finished[slot];
      finished[slot] = is_any_suspended ? finished[slot] : -1.0;
      suspended[slot] = -1.0;
    }
  }
  uint next = entered;
  if (!is_any_suspended) next = asks_for_any && !any_takes_part() ? DONE : take_child(true);
  return next;
}

// Changes the level of rays that have reached an instance, or the end of one.
uint change_level(uint current, bool asks_for_any) {
  bool leaves = is_in_instance && current == DONE;
  if (leaves) current = leave_instance(asks_for_any);
  if (is_instance(current)) {
    current = enter_instance(current);
  } else if (leaves) {
    return_to_world();
  }
  return current;
}

void descend_two_levels(bool asks_for_any) {
  descent = Descent(NO_FAMILY, 0u);
  leaf.needs_second_look = false;
  leaf.has_solids_next = false;
  start_levels();
  uint current = any_takes_part() ? 0u : DONE;
  bool is_alive;
  do {
    uint leaves = 0u;
    bool goes_on = is_in_tree(current);
    do {
      if (goes_on) {
        current = go_through_leaf(current, asks_for_any);
        ++leaves;
        goes_on = is_in_tree(current) && !waits() && leaves < LEAVES_PER_LEVEL;
      }
    } while (goes_on);
    if (waits()) end_waiting(asks_for_any);
    current = change_level(current, asks_for_any);
    is_alive = current != DONE || is_in_instance;
  } while (is_alive);
}
