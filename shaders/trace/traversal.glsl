// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// One traversal for all rays: primary, mirror and shadow rays. There is no recursion; the stack has the size that the
// tree needs. The hit of a ray depends neither on the packet nor on the tree. `asks_for_any`: the packet's rays are
// any-hit rays. With ALL_ASK_FOR_ANY it is true at compile time.
//
// Loops have the form do { if (goes_on) { ... } } while (goes_on). When all lanes have left, CPU drivers still execute
// the code after a loop's exit once for no lane; with the condition at the top that would be the whole body. Without
// the branch, older versions of lavapipe overwrite variables of lanes that have left with results of later turns, whose
// loads return 0 for them; variables changed inside a branch keep their values.

// True if the solids of a leaf wait until no lane can continue without them. If all primitives are solids, no solid
// waits.
const uint SOLIDS_WAIT = WAITS_WITH_SOLIDS * FEATURE_BIT(FEATURE_TRIANGLES) * uint(TREE_KIND_COUNT > 1u);

// True if a triangle may need a second look, which waits until no lane can continue without it. Any-hit rays glance at
// triangles first. If textures have holes, older versions of lavapipe would execute the lookup for all lanes at each
// triangle.
const uint LOOKS_TWICE = ALL_ASK_FOR_ANY | (WAITS_WITH_HOLES & FEATURE_BIT(FEATURE_HOLES));

// The primitives of the current leaf that are left to test. enter_leaf and the functions that intersect primitives set
// it.
struct Leaf {
  uint next;
  uint end;
  bool needs_second_look;  // whether the triangle just before `next` needs a second look; with LOOKS_TWICE
  bool has_solids_next;    // whether `next` and all primitives behind it are solids; with SOLIDS_WAIT
};
Leaf leaf;

// Returns whether the lane delays work that CPU drivers would otherwise execute for all lanes after each leaf of one
// lane.
bool waits() {
  return (LOOKS_TWICE != 0u && leaf.needs_second_look) || (SOLIDS_WAIT != 0u && leaf.has_solids_next);
}

// The position of the packet in the tree. take_child and enter_family set it.
struct Descent {
  uint family;  // family of the current node
  uint stack_top;
};
Descent descent;
uint stack[STACK_SIZE + 1u];  // the families of the nodes above, and one entry that is not kept

// Special values in place of a child, with CHILD_IS_LEAF set.
const uint DONE = 0xFFFFFFFFu;
const uint IN_LEAF = 0xFFFFFFFEu;  // the lane is in the leaf that it has entered

// The upper level, while the ray is in an instance (FEATURE_INSTANCES): its family, and the top of its stack.
uint upper_family = 0u;
uint upper_stack_top = 0u;

// Returns the index of the first entry of the stack that belongs to the current level.
uint bottom_of_level() {
  uint bottom = 0u;
  if (has(FEATURE_INSTANCES)) bottom = upper_stack_top;
  return bottom;
}

bool is_instance(uint child) { return (child & CHILD_INSTANCE_MASK) == CHILD_IS_INSTANCE; }

// Returns the next remaining child, or DONE. Without `takes` nothing changes. The function has no branches, because CPU
// drivers execute branches for all lanes.
uint take_child(bool takes) {
  bool has_child = takes && descent.family != NO_FAMILY;
  uint node = has_child ? node_of_family(descent.family) : 0u;
  uint child = next_of_family(descent.family, load_children(node));
  uint left = without_next(descent.family);
  bool pops = has_child && left == NO_FAMILY && descent.stack_top > bottom_of_level();
  descent.stack_top -= pops ? 1u : 0u;
  uint above = stack[descent.stack_top];
  descent.family = has_child ? (pops ? above : left) : descent.family;
  return has_child ? child : DONE;
}

// Stores the old family and enters a new one. The old family is always stored, even if it is not kept: LLVM makes a
// conditional store a branch for each lane, which processors cannot predict.
void enter_family(uint met) {
  bool enters = met != NO_FAMILY;
  stack[descent.stack_top] = descent.family;
  descent.stack_top += enters && descent.family != NO_FAMILY ? 1u : 0u;
  descent.family = enters ? met : descent.family;
}

// Takes a step from a node to the next child. Lanes that are not at a node also execute it, but do not move.
uint step_together(uint current) {
  bool steps = is_inner(current);
  count_steps(steps ? 1u : 0u, 0u);
  uint met = meet_children(steps ? current : 0u);
  enter_family(steps ? met : NO_FAMILY);
  uint child = take_child(steps);
  return steps ? child : current;
}

void enter_leaf(uint child) {
  leaf.next = first_of_leaf(child);
  leaf.end = leaf.next + count_of_leaf(child);
  count_steps(0u, leaf.end - leaf.next);
}

// Returns whether the next primitive has this kind. If the tree contains only this kind, nothing is fetched.
bool is_next_in_leaf(uint kind) {
  return leaf.next < leaf.end && (TREE_KIND_COUNT == 1u || load_primitive_kind(leaf.next) == kind);
}

// Intersects the next triangles, up to one that needs a second look.
void intersect_triangles(bool asks_for_any) {
  bool is_next = is_next_in_leaf(KIND_TRIANGLE);
  do {
    if (is_next) {
      Primitive p = load_primitive(leaf.next);
      if (ALL_ASK_FOR_ANY != 0u) {
        leaf.needs_second_look = glance_at_triangle(p, leaf.next);
      } else if (LOOKS_TWICE != 0u) {
        leaf.needs_second_look = may_meet_triangle(p);
      } else {
        intersect_packet_with_triangle(p, leaf.next, asks_for_any);
      }
      ++leaf.next;
      is_next = !leaf.needs_second_look && is_next_in_leaf(KIND_TRIANGLE);
    }
  } while (is_next);
}

// Intersects the next closed shapes of a kind.
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)                        \
  void intersect_each_##PREFIX(bool asks_for_any) {                                         \
    bool is_next = is_next_in_leaf(NUMBER);                                                 \
    do {                                                                                    \
      if (is_next) {                                                                        \
        intersect_packet_with_##PREFIX(load_primitive(leaf.next), leaf.next, asks_for_any); \
        ++leaf.next;                                                                        \
        is_next = is_next_in_leaf(NUMBER);                                                  \
      }                                                                                     \
    } while (is_next);                                                                      \
  }
#include "promin/kinds/primitives.def"

// Intersects the next closed shapes, kind by kind, which is their order in leaves.
void intersect_solids(bool asks_for_any) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (has(FEATURE_##FEATURE)) intersect_each_##PREFIX(asks_for_any);
#include "promin/kinds/primitives.def"
}

// Intersects the remaining primitives of a leaf, up to primitives that wait. A triangle that needs a second look waits
// until no lane has another triangle to glance at. Solids may wait too.
void intersect_leaf(bool asks_for_any) {
  if (has(FEATURE_TRIANGLES)) intersect_triangles(asks_for_any);
  if (leaf.needs_second_look) return;
  if (SOLIDS_WAIT != 0u) {
    leaf.has_solids_next = leaf.next < leaf.end;
  } else {
    intersect_solids(asks_for_any);
  }
}

// Intersects the unbounded primitives, which follow the primitives of the tree.
void intersect_unbounded(bool asks_for_any) {
  uint index = first_unbounded();
  do {
    if (index < end_unbounded()) {
      if (has(FEATURE_SHADOW_CATCHERS)) {
        if (passes_catchers && is_catcher(index)) {
          ++index;
          continue;
        }
      }
      Primitive p = load_primitive(index);
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  if (kind_of(p) == NUMBER) intersect_packet_with_##PREFIX(p, index, asks_for_any);
#include "promin/kinds/primitives.def"
      ++index;
    }
  } while (index < end_unbounded());
}

// Descends from an inner node to a leaf.
uint step_down(uint current) {
  do {
    if (is_inner(current)) {
      count_steps(1u, 0u);
      enter_family(meet_children(current));
      current = take_child(true);
    }
  } while (is_inner(current));
  return current;
}

// Moves to the next leaf and intersects it. With STEPS_TOGETHER, lanes that have not reached a leaf skip it. Returns
// the next child, IN_LEAF if the lane waits, or DONE.
uint go_through_leaf(uint current, bool asks_for_any) {
  if (STEPS_TOGETHER == 0u) {
    current = step_down(current);
  } else {
    for (uint i = 0u; i < STEPS_TOGETHER; ++i) current = step_together(current);
  }
  if (is_inner(current) || current == DONE) return current;
  if (has(FEATURE_INSTANCES)) {
    if (is_instance(current)) return current;
  }
  if (current != IN_LEAF) enter_leaf(current);
  intersect_leaf(asks_for_any);
  if (waits()) return IN_LEAF;
  return asks_for_any && !any_takes_part() ? DONE : take_child(true);
}

// Intersects the waiting primitives of the current leaf.
void end_waiting(bool asks_for_any) {
  if (LOOKS_TWICE != 0u && leaf.needs_second_look) {
    intersect_packet_with_triangle(load_primitive(leaf.next - 1u), leaf.next - 1u, asks_for_any);
    leaf.needs_second_look = false;
  }
  if (SOLIDS_WAIT != 0u && leaf.has_solids_next) {
    intersect_solids(asks_for_any);
    leaf.has_solids_next = false;
  }
}

// Traces the active rays of the packet through the tree. All of them are in one octant.
void descend(bool asks_for_any) {
  descent = Descent(NO_FAMILY, 0u);
  leaf.needs_second_look = false;
  leaf.has_solids_next = false;
  uint current = any_takes_part() ? 0u : DONE;
  bool has_waited;
  do {
    bool goes_on = current != DONE;
    do {
      if (goes_on) {
        current = go_through_leaf(current, asks_for_any);
        goes_on = current != DONE && !waits();
      }
    } while (goes_on);
    has_waited = waits();
    if (has_waited) end_waiting(asks_for_any);
  } while (has_waited);
}

#include "trace/change_level.glsl"

void descend_levels(bool asks_for_any) {
  if (has(FEATURE_INSTANCES)) {
    descend_two_levels(asks_for_any);
  } else {
    descend(asks_for_any);
  }
}

// Traces one octant after the other: first the octant of the first ray, then the octant of the first remaining ray.
void descend_by_octants(bool asks_for_any) {
  float waiting[PACKET_SIZE];
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) waiting[slot] = limits[slot];
  bool are_some_left;
  do {
    bool is_chosen = false;
    are_some_left = false;
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      vec3 inverse = packet[slot].inverse_direction;
      bool waits = waiting[slot] >= 0.0;
      octant = waits && !is_chosen ? inverse : octant;
      is_chosen = is_chosen || waits;
      bool joins = waits && all(equal(lessThan(inverse, vec3(0.0)), lessThan(octant, vec3(0.0))));
      limits[slot] = joins ? waiting[slot] : -1.0;
      waiting[slot] = joins ? -1.0 : waiting[slot];
      are_some_left = are_some_left || waiting[slot] >= 0.0;
    }
    descend_levels(asks_for_any);
  } while (are_some_left);
}

void descend_as_they_are(bool asks_for_any) {
  if (PACKET_SIZE == 1u) {
    octant = packet[0].inverse_direction;
    descend_levels(asks_for_any);
  } else {
    descend_by_octants(asks_for_any);
  }
}

// Traces rays that start far away, with origins moved near the tree.
void descend_from_nearby(bool asks_for_any) {
  vec3 origins[PACKET_SIZE];
  float tmins[PACKET_SIZE];
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    origins[slot] = packet[slot].origin;
    tmins[slot] = packet[slot].tmin;
  }
  bool is_any_far = false;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) is_any_far = is_any_far || is_far_away(packet[slot]);
  // After each step, a thousandth of the distance remains.
  for (uint i = 0u; i < 4u && is_any_far; ++i) {
    is_any_far = false;
    [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
      precise float sum = shifts[slot] + shift_to_tree(packet[slot]);
      if (!(sum > shifts[slot] && sum < packet[slot].tmax)) continue;
      Ray moved = moved_along(packet[slot], shift_to_tree(packet[slot]));
      if (!(distance_to_tree(moved) < distance_to_tree(packet[slot]))) continue;
      packet[slot] = moved;
      packet[slot].tmin = shifted_tmin(tmins[slot], sum);
      shifts[slot] = sum;
      is_any_far = true;
    }
  }
  descend_as_they_are(asks_for_any);
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    packet[slot].origin = origins[slot];
    packet[slot].tmin = tmins[slot];
  }
}

// Finds hits for the rays in `packet` and stores them in `found`: the nearest hits, or any hits with `asks_for_any`. On
// a miss `primitive` is NO_PRIMITIVE. With ALL_ASK_FOR_ANY only `primitive` and `order` are set.
void trace_packet(bool asks_for_any) {
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    shifts[slot] = 0.0;
    if (has(FEATURE_INSTANCES)) {
      unmoved_tmins[slot] = packet[slot].tmin;
      to_world[slot] = 1.0;
      to_level[slot] = 1.0;
    }
    found[slot] = Hit(packet[slot].tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
    limits[slot] = packet[slot].tmin < packet[slot].tmax ? packet[slot].tmax : -1.0;
  }
  if (UNBOUNDED_KIND_COUNT > 0u) intersect_unbounded(asks_for_any);
  if (TREE_KIND_COUNT == 0u) return;
  descend_from_nearby(asks_for_any);
}

// Traces a single ray, for kernels with packets of one.
Hit trace(Ray ray, bool asks_for_any) {
  packet[0] = ray;
  trace_packet(asks_for_any);
  return found[0];
}
