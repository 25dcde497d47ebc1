// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// node_boxes.glsl for nodes whose boxes are fp32 planes as they are instead of bytes: two of layout.h's nodes stand
// for one (tools/reporting/full_boxes.h). Of the first, frame = lower x of the four children, lo = lower y, hi = lower
// z, children = upper x; of the second upper y, upper z, the children as they were, and how many there are.

uvec4 load_children(uint node) {
  if (FETCHES_TEXELS == 0u) return nodes[2u * node + 1u].hi;
  return texelFetch(node_texels, int(8u * node + 6u));
}

vec4 load_planes(uint index, uint place) {
  if (FETCHES_TEXELS != 0u) return uintBitsToFloat(texelFetch(node_texels, int(8u * index + place)));
  uint node = 2u * index + (place >> 2);
  uint part = place & 3u;
  if (part == 0u) return uintBitsToFloat(nodes[node].frame);
  if (part == 1u) return uintBitsToFloat(nodes[node].lo);
  return uintBitsToFloat(part == 2u ? nodes[node].hi : nodes[node].children);
}

uint load_child_count(uint index) {
  if (FETCHES_TEXELS == 0u) return nodes[2u * index + 1u].children.x;
  return texelFetch(node_texels, int(8u * index + 7u)).x;
}

// Of one axis, the t of four planes.
vec4 slab(vec4 planes, float origin, float inverse) {
#ifdef CANCELLING
  // What far from the world's origin is the difference of two large numbers.
  precise vec4 t = planes * inverse - origin * inverse;
#else
  precise vec4 t = (planes - origin) * inverse;
#endif
  return t;
}

uint meet_children(uint node) {
  vec4 lo_x = load_planes(node, 0u);
  vec4 lo_y = load_planes(node, 1u);
  vec4 lo_z = load_planes(node, 2u);
  vec4 hi_x = load_planes(node, 3u);
  vec4 hi_y = load_planes(node, 4u);
  vec4 hi_z = load_planes(node, 5u);
  bvec3 is_backward = lessThan(octant, vec3(0.0));
  vec4 near_x = is_backward.x ? hi_x : lo_x;
  vec4 near_y = is_backward.y ? hi_y : lo_y;
  vec4 near_z = is_backward.z ? hi_z : lo_z;
  vec4 far_x = is_backward.x ? lo_x : hi_x;
  vec4 far_y = is_backward.y ? lo_y : hi_y;
  vec4 far_z = is_backward.z ? lo_z : hi_z;

  uvec4 met = NONE_MET;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    vec3 inverse = packet[slot].inverse_direction;
    vec3 near_origin = packet[slot].near_origin;
    vec3 far_origin = packet[slot].far_origin;
    vec4 entry = greater(
        slab(near_x, near_origin.x, inverse.x),
        greater(slab(near_y, near_origin.y, inverse.y),
                greater(slab(near_z, near_origin.z, inverse.z), vec4(packet[slot].tmin))));
    vec4 exit = lesser(slab(far_x, far_origin.x, inverse.x),
                       lesser(slab(far_y, far_origin.y, inverse.y), slab(far_z, far_origin.z, inverse.z)));
    met = add_met(met, lessThanEqual(entry, lesser(exit, vec4(limits[slot]))), entry);
  }

  return family_of(node, load_child_count(node), met);
}
