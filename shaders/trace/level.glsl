// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The level of the tree on which a ray is (docs/instances.md). On the upper level the ray is in the world. On the lower
// level it is in the space of an instance's mesh. Needs FEATURE_INSTANCES. change_level.glsl changes the level.

bool is_in_instance = false;  // whether the packet is in an instance
float inside_radius = 0.0;    // the mesh's max-norm radius around its origin, in its own space
uint inside_part = 0u;        // Hit::part of the instance's hits
uint inside_order = 0u;       // number of the instance's first primitive
uint inside_hash = 0u;        // hash of the instance's object, with FEATURE_GLASS

Ray upper_rays[PACKET_SIZE];     // the rays on the upper level
float unmoved_tmins[PACKET_SIZE];  // tmin of the rays before their origins were moved
float to_world[PACKET_SIZE];     // factor from t on this level to t in the world, a power of two
float to_level[PACKET_SIZE];     // its inverse
vec3 world_direction = vec3(0.0);  // for is_cut_out: the direction of its ray on the upper level

// On the upper level an accepted hit lies within 53 u S of the surface of its instance, where S also includes the
// instance's distance and size. With the rounding of the box test and its divisions (make_ray.glsl), boxes must grow by
// 80 u S.
const float UPPER_PADDING = 80.0 * UNIT_ROUNDOFF;

// Returns center and max-norm radius of everything on this level.
vec4 level_bounds() {
  vec4 bounds = VIEW.tree_bounds;
  if (has(FEATURE_INSTANCES)) bounds = is_in_instance ? vec4(0.0, 0.0, 0.0, inside_radius) : bounds;
  return bounds;
}

// Return a t of this level in the units of the world, and the reverse.
float in_world(uint slot, float t) {
  float result = t;
  if (has(FEATURE_INSTANCES)) {
    precise float scaled = t * to_world[slot];
    result = scaled;
  }
  return result;
}
float in_level(uint slot, float t) {
  float result = t;
  if (has(FEATURE_INSTANCES)) {
    precise float scaled = t * to_level[slot];
    result = scaled;
  }
  return result;
}

// Returns the number of a primitive in the scene.
uint number_of(Primitive p) {
  uint number = order_of(p);
  if (has(FEATURE_INSTANCES)) number += is_in_instance ? inside_order : 0u;
  return number;
}
