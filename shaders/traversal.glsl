// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// One traversal for every ray: primary, mirror and shadow. No recursion; the stack holds at most one entry a level.

// Takes the crossing if it is nearer, or as near and of a lower number: the hit does not depend on the tree.
void keep_nearest(Ray ray, Crossing crossing, uint primitive, uint order, inout Hit hit) {
  if (crossing.t > ray.tmin && (crossing.t < hit.t || (crossing.t == hit.t && order < hit.order))) {
    hit = Hit(crossing.t, crossing.u, crossing.v, crossing.part, primitive, order);
  }
}

// Entry of a ray into a child's box, as t; the box is met if entry <= exit. An absent child is never met.
// (plane - origin) * inverse, never plane * inverse - origin * inverse, which cancels (numerics.md). No hit hidden in
// 3.6e5 rays at edges and corners, offset 0...1e5 (hard case 28; 5 % without padding), nor in 1e6 through mixed scenes
// (hard case 38).
vec2 child_interval(Ray ray, vec2 x, vec2 y, vec2 z, float t_limit) {
  bvec3 is_backward = lessThan(ray.inverse_direction, vec3(0.0));
  vec3 near = vec3(is_backward.x ? x.y : x.x, is_backward.y ? y.y : y.x, is_backward.z ? z.y : z.x);
  vec3 far = vec3(is_backward.x ? x.x : x.y, is_backward.y ? y.x : y.y, is_backward.z ? z.x : z.y);
  precise vec3 t_near = (near - ray.near_origin) * ray.inverse_direction;
  precise vec3 t_far = (far - ray.far_origin) * ray.inverse_direction;
  float entry = max(max(t_near.x, t_near.y), max(t_near.z, ray.tmin));
  precise float exit = min(min(t_far.x, t_far.y), t_far.z) * BOX_WIDENING;
  return vec2(entry, min(exit, t_limit));
}

// What this invocation's rays took: x = node steps, y = primitive tests.
uvec2 step_counts;

void count_steps(uint nodes, uint tests) {
  if (has(FEATURE_STEP_COUNTS)) step_counts += uvec2(nodes, tests);
}

// The primitives of one kind at the head of [i, end): leaves hold them sorted by kind.
#define INTERSECT_RUN(KIND, FEATURE, INTERSECT)                          \
  while (i < end && is_kind(primitives[i].c.z, KIND, FEATURE)) {         \
    Primitive p = primitives[i];                                         \
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

// What is left to visit: each inner node on the way down leaves at most one child here.
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
      Primitive p = primitives[i];
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
      Node node = nodes[current];
      vec2 left = child_interval(ray, node.x.xy, node.y.xy, node.z.xy, hit.t);
      vec2 right = child_interval(ray, node.x.zw, node.y.zw, node.z.zw, hit.t);
      // <=, so that a box at the distance of the hit so far is still opened: its primitive may have a lower number.
      bool meets_left = left.x <= left.y;
      bool meets_right = right.x <= right.y;
      bool takes_right = meets_right && !(meets_left && left.x <= right.x);
      current = takes_right ? node.children.y : node.children.x;
      if (meets_left && meets_right) {
        stack[stack_top] = takes_right ? node.children.x : node.children.y;
        stack_entry[stack_top] = max(left.x, right.x);
        ++stack_top;
      } else if (!(meets_left || meets_right)) {
        current = pop_child(hit.t);
      }
    }
    if (current == DONE) break;
    intersect_leaf(ray, current, hit);
    if (any_hit && hit.primitive != NO_PRIMITIVE) return hit;
    current = pop_child(hit.t);
  }
  return hit;
}
