// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Instances: meshes that several objects share (docs/instances.md). A hit in an instance has the index of the
// instance's record, plus FIRST_INSTANCE_PART, as Hit::part. The functions here convert the mesh's own space to the
// world. R converts a direction to the mesh's space, E converts back, and c is the position of the mesh's origin.

struct InstanceMap {
  vec3 r0;  // rows of R
  vec3 r1;
  vec3 r2;
  vec3 origin;  // c
};

// The words of the second record of an instance (layout.h).
struct InstanceLook {
  vec3 e0;  // rows of E
  vec3 e1;
  vec3 e2;
  uint material;
  uint bits;
};

bool is_instance_part(uint part) { return has(FEATURE_INSTANCES) && part >= FIRST_INSTANCE_PART; }

uvec4 load_node_words(uint node, uint word) {
  uvec4 words;
  if (FETCHES_TEXELS == 0u) {
    words = word == 0u ? nodes[node].frame
                       : (word == 1u ? nodes[node].lo : (word == 2u ? nodes[node].hi : nodes[node].children));
  } else {
    words = texelFetch(node_texels, int(NODE_TEXELS * node + word));
  }
  return words;
}

InstanceMap load_instance_map(uint record) {
  vec4 r0 = uintBitsToFloat(load_node_words(record, 0u));
  vec4 r1 = uintBitsToFloat(load_node_words(record, 1u));
  vec4 r2 = uintBitsToFloat(load_node_words(record, 2u));
  return InstanceMap(r0.xyz, r1.xyz, r2.xyz, vec3(r0.w, r1.w, r2.w));
}

InstanceLook load_instance_look(uint part) {
  uint record = part - FIRST_INSTANCE_PART + 1u;
  uvec4 a = load_node_words(record, 0u);
  uvec4 b = load_node_words(record, 1u);
  uvec4 c = load_node_words(record, 2u);
  return InstanceLook(uintBitsToFloat(a.xyz), uintBitsToFloat(b.xyz), uintBitsToFloat(c.xyz), a.w, b.w);
}

vec3 times_rows(vec3 row0, vec3 row1, vec3 row2, vec3 v) {
  return vec3(dot3(row0, v), dot3(row1, v), dot3(row2, v));
}

// Returns the product of a row vector and a matrix: the transform of normals from the mesh's space to the world, if the
// matrix is R.
vec3 times_columns(vec3 row0, vec3 row1, vec3 row2, vec3 v) {
  precise vec3 sum = v.x * row0 + (v.y * row1 + v.z * row2);
  return sum;
}

vec3 to_world_normal(InstanceMap map, vec3 normal) {
  return normalize3(times_columns(map.r0, map.r1, map.r2, normal));
}

vec3 to_world_direction(InstanceLook look, vec3 v) { return times_rows(look.e0, look.e1, look.e2, v); }

// Returns -1 for a mirrored instance, otherwise 1.
float handedness_of(InstanceLook look) { return (look.bits & INSTANCE_IS_MIRRORED) != 0u ? -1.0 : 1.0; }

// Returns a triangle with its corners in the world, relative to the position of the mesh's origin.
Primitive place_about_origin(Primitive p, InstanceLook look) {
  vec3 a = to_world_direction(look, corner0(p));
  vec3 b = to_world_direction(look, corner1(p));
  vec3 c = to_world_direction(look, corner2(p));
  return Primitive(vec4(a, b.x), vec4(b.yz, c.xy), uvec4(floatBitsToUint(c.z), p.c.yzw));
}

// Returns the surface of a hit in an instance. The lift covers the rounding of the point on the mesh, of its place in
// the world, and of the map. Let N be the unit normal in the world, n = R^T N_o and h = 1 / |n|. Then the lift is
// h lift_o + u (|N| . (7 |E| |p| + 3 |c|) + 5 h |N_o| . |R| |P - c|).
SurfacePoint instance_surface(Primitive p, Hit hit) {
  InstanceMap map = load_instance_map(hit.part - FIRST_INSTANCE_PART);
  InstanceLook look = load_instance_look(hit.part);
  precise vec3 edge1 = corner1(p) - corner0(p);
  precise vec3 edge2 = corner2(p) - corner0(p);
  float size = max(max_abs(edge1), max_abs(edge2));
  precise vec3 own = corner0(p) + (hit.u * edge1 + hit.v * edge2);
  vec3 own_normal = triangle_normal(p);
  vec3 along = times_columns(map.r0, map.r1, map.r2, own_normal);
  vec3 normal = normalize3(along);
  precise float h = 1.0 / max(dot3(normal, along), SMALLEST_NORMAL);
  vec3 from_origin = to_world_direction(look, own);
  precise vec3 position = map.origin + from_origin;
  vec3 moved = times_rows(abs(look.e0), abs(look.e1), abs(look.e2), abs(own));
  vec3 back = times_rows(abs(map.r0), abs(map.r1), abs(map.r2), abs(from_origin));
  precise float own_lift = 8.0 * (max_abs(own) + size) + 5.0 * dot3(abs(own_normal), back);
  precise float lift =
      UNIT_ROUNDOFF * (h * own_lift + dot3(abs(normal), 7.0 * moved + 3.0 * abs(map.origin)));
  return SurfacePoint(position, normal, lift);
}

// Returns the normal of a triangle of an instance in the world.
vec3 instance_normal(Primitive p, uint part) {
  return to_world_normal(load_instance_map(part - FIRST_INSTANCE_PART), triangle_normal(p));
}

// Returns the primitive of a hit with this part. Its object is the hit's object.
Primitive load_primitive_of(uint index, uint part) {
  Primitive p = load_primitive(index);
  if (is_instance_part(part)) {
    p.c.w = (p.c.w & 0xFFFF0000u) | (load_instance_look(part).bits & INSTANCE_HASH_MASK);
  }
  return p;
}
