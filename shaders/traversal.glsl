// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// One traversal for every ray: primary, mirror and shadow. No recursion; the stack has the size that the tree needs.

// Takes the crossing if it is nearer, or as near and of a lower number: the hit does not depend on the tree.
void keep_nearest(Ray ray, Crossing crossing, uint primitive, uint order, inout Hit hit) {
  if (crossing.t > ray.tmin && (crossing.t < hit.t || (crossing.t == hit.t && order < hit.order))) {
    hit = Hit(crossing.t, crossing.u, crossing.v, crossing.part, primitive, order);
  }
}

vec4 unpack_bytes(uint word) { return vec4((uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & 0xFFu); }

// The four children of a node as a ray meets them.
struct Encounter {
  vec4 entry;  // t; infinite where the box is missed
  uvec4 child;
};

// A box is met if entry <= exit; <=, so that one at the distance of the hit so far is still opened: its primitive may
// have a lower number. (origin - ray's origin) comes first, never byte * scale * inverse - origin * inverse, which
// cancels. No hit hidden in 3.6e5 rays at edges and corners, offset 0...1e5 (hard case 28; 5 % without
// padding), nor in 1e6 through mixed scenes (hard case 38).
Encounter meet_children(Ray ray, Node node, float t_limit) {
  vec3 origin = uintBitsToFloat(node.frame.xyz);
  uvec3 exponents = (uvec3(node.frame.w) >> uvec3(0u, 8u, 16u)) & 0xFFu;
  precise vec3 step = uintBitsToFloat(exponents << 23) * ray.inverse_direction;
  precise vec3 near_base = (origin - ray.near_origin) * ray.inverse_direction;
  precise vec3 far_base = (origin - ray.far_origin) * ray.inverse_direction;
  uvec3 lo = node.lo.xyz;
  uvec3 hi = uvec3(node.lo.w, node.hi.xy);
  bvec3 is_backward = lessThan(ray.inverse_direction, vec3(0.0));
  uvec3 near = uvec3(is_backward.x ? hi.x : lo.x, is_backward.y ? hi.y : lo.y, is_backward.z ? hi.z : lo.z);
  uvec3 far = uvec3(is_backward.x ? lo.x : hi.x, is_backward.y ? lo.y : hi.y, is_backward.z ? lo.z : hi.z);
  precise vec4 near_x = unpack_bytes(near.x) * step.x + near_base.x;
  precise vec4 near_y = unpack_bytes(near.y) * step.y + near_base.y;
  precise vec4 near_z = unpack_bytes(near.z) * step.z + near_base.z;
  precise vec4 far_x = unpack_bytes(far.x) * step.x + far_base.x;
  precise vec4 far_y = unpack_bytes(far.y) * step.y + far_base.y;
  precise vec4 far_z = unpack_bytes(far.z) * step.z + far_base.z;
  vec4 entry = max(max(near_x, near_y), max(near_z, vec4(ray.tmin)));
  precise vec4 exit = min(min(far_x, far_y), far_z) * BOX_WIDENING;
  exit = min(exit, vec4(t_limit));
  for (uint i = 0u; i < NODE_WIDTH; ++i) {
    bool is_met = entry[i] <= exit[i] && node.children[i] != CHILD_ABSENT;
    entry[i] = is_met ? entry[i] : INFINITY;
  }
  return Encounter(entry, node.children);
}

// The nearer of two to the front.
void sort_pair(inout Encounter e, uint a, uint b) {
  bool is_swapped = e.entry[b] < e.entry[a];
  vec2 entry = is_swapped ? vec2(e.entry[b], e.entry[a]) : vec2(e.entry[a], e.entry[b]);
  uvec2 child = is_swapped ? uvec2(e.child[b], e.child[a]) : uvec2(e.child[a], e.child[b]);
  e.entry[a] = entry.x;
  e.entry[b] = entry.y;
  e.child[a] = child.x;
  e.child[b] = child.y;
}

void sort_by_entry(inout Encounter e) {
  sort_pair(e, 0u, 1u);
  sort_pair(e, 2u, 3u);
  sort_pair(e, 0u, 2u);
  sort_pair(e, 1u, 3u);
  sort_pair(e, 1u, 2u);
}

// What this invocation's rays took: x = node steps, y = primitive tests.
uvec2 step_counts;

void count_steps(uint nodes, uint tests) {
  if (has(FEATURE_STEP_COUNTS)) step_counts += uvec2(nodes, tests);
}

// The primitives of one kind at the head of [i, end): leaves hold them sorted by kind.
#define INTERSECT_RUN(KIND, FEATURE, INTERSECT)                          \
  while (i < end && is_kind(load_primitive_kind(i), KIND, FEATURE)) {         \
    Primitive p = load_primitive(i);                                     \
    keep_nearest(ray, INTERSECT(ray, p), i, p.c.y, hit);                 \
    ++i;                                                                 \
  }

void intersect_leaf(Ray ray, uint child, inout Hit hit) {
  uint i = child & CHILD_FIRST_MASK;
  uint end = i + ((child >> CHILD_COUNT_SHIFT) & 15u) + 1u;
  count_steps(0u, end - i);
  INTERSECT_RUN(KIND_TRIANGLE, FEATURE_TRIANGLES, intersect_triangle)
  INTERSECT_RUN(KIND_SPHERE, FEATURE_SPHERES, intersect_sphere)
  INTERSECT_RUN(KIND_CYLINDER, FEATURE_CYLINDERS, intersect_cylinder)
  INTERSECT_RUN(KIND_CONE, FEATURE_CONES, intersect_cone)
}

// What is left to visit: each inner node on the way down leaves its farther children here.
uint stack[STACK_SIZE];
float stack_entry[STACK_SIZE];
uint stack_top;
const uint DONE = 0xFFFFFFFFu;  // has CHILD_IS_LEAF

uint pop_child(float t_limit) {
  while (stack_top > 0u) {
    --stack_top;
    if (stack_entry[stack_top] <= t_limit) return stack[stack_top];
  }
  return DONE;
}

// The nearest hit, or with `any_hit` some hit, if there is one: then `primitive` is not NO_PRIMITIVE.
Hit trace(Ray ray, bool any_hit) {
  Hit hit = Hit(ray.tmax, 0.0, 0.0, PART_SIDE, NO_PRIMITIVE, 0u);
  if (has(FEATURE_PLANES)) {
    for (uint i = dispatch.counts.x; i < dispatch.counts.x + dispatch.counts.y; ++i) {
      Primitive p = load_primitive(i);
      keep_nearest(ray, intersect_plane(ray, p), i, p.c.y, hit);
    }
  }
  if ((FEATURES & SOLID_FEATURES) == 0u) return hit;

  stack_top = 0u;
  uint current = ray.tmin < ray.tmax && !(any_hit && hit.primitive != NO_PRIMITIVE) ? 0u : DONE;
  // Loops rather than branches around the two halves: CPU drivers execute both sides of a branch under a mask, but
  // leave a loop as soon as no lane is in it.
  while (current != DONE) {
    while ((current & CHILD_IS_LEAF) == 0u) {
      count_steps(1u, 0u);
      Encounter e = meet_children(ray, load_node(current), hit.t);
      sort_by_entry(e);
      for (uint i = NODE_WIDTH - 1u; i > 0u; --i) {
        if (e.entry[i] < INFINITY) {
          stack[stack_top] = e.child[i];
          stack_entry[stack_top] = e.entry[i];
          ++stack_top;
        }
      }
      current = e.entry[0] < INFINITY ? e.child[0] : pop_child(hit.t);
    }
    if (current == DONE) break;
    intersect_leaf(ray, current, hit);
    if (any_hit && hit.primitive != NO_PRIMITIVE) return hit;
    current = pop_child(hit.t);
  }
  return hit;
}
