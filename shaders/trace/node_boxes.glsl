// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// A node's boxes and children, and which of them a packet hits. Kernels for comparisons provide a file of this name
// with their own load_children and meet_children (tools/plain).

// A node without the words of its children, which traversal reads separately.
struct NodeBoxes {
  uvec4 frame;
  uvec4 lo;
  uvec4 hi;
};

NodeBoxes load_boxes(uint index) {
  if (FETCHES_TEXELS == 0u) return NodeBoxes(nodes[index].frame, nodes[index].lo, nodes[index].hi);
  int first = int(NODE_TEXELS * index);
  return NodeBoxes(texelFetch(node_texels, first), texelFetch(node_texels, first + 1),
                   texelFetch(node_texels, first + 2));
}

uvec4 load_children(uint index) {
  if (FETCHES_TEXELS == 0u) return nodes[index].children;
  return texelFetch(node_texels, int(NODE_TEXELS * index + 3u));
}

// Functions that return the words of a node.
vec3 origin_of(NodeBoxes boxes) { return uintBitsToFloat(boxes.frame.xyz); }
vec3 steps_of(NodeBoxes boxes) {
  return uintBitsToFloat(((uvec3(boxes.frame.w) >> uvec3(0u, 8u, 16u)) & 0xFFu) << 23);
}
uint child_count_of(NodeBoxes boxes) { return boxes.frame.w >> 24; }
uvec3 low_planes_of(NodeBoxes boxes) { return boxes.lo.xyz; }
uvec3 high_planes_of(NodeBoxes boxes) { return uvec3(boxes.lo.w, boxes.hi.xy); }

vec4 unpack_bytes(uint word) { return vec4((uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & 0xFFu); }

const float SHIFT_TO_CULL_BY = 1.0 - 4.0 * UNIT_ROUNDOFF;

// Returns the children of a node that a ray of the packet hits, as its family. A box is hit if entry <= exit. Equality
// counts, so that a box at the distance of the hit so far is still visited, because its primitive may have a lower
// number. The difference (origin - ray's origin) is computed first: byte * scale * inverse - origin * inverse would
// lose digits. In tests no hit was hidden for 3.6e5 rays at edges and corners with offsets of 0...1e5 (hard case 28; 5
// % without padding), nor for 1e6 rays through mixed scenes (hard case 38).
uint meet_children(uint node) {
  NodeBoxes boxes = load_boxes(node);
  vec3 origin = origin_of(boxes);
  vec3 scale = steps_of(boxes);
  uvec3 lo = low_planes_of(boxes);
  uvec3 hi = high_planes_of(boxes);
  bvec3 is_backward = lessThan(octant, vec3(0.0));
  uvec3 near = uvec3(is_backward.x ? hi.x : lo.x, is_backward.y ? hi.y : lo.y, is_backward.z ? hi.z : lo.z);
  uvec3 far = uvec3(is_backward.x ? lo.x : hi.x, is_backward.y ? lo.y : hi.y, is_backward.z ? lo.z : hi.z);
  vec4 near_x = unpack_bytes(near.x);
  vec4 near_y = unpack_bytes(near.y);
  vec4 near_z = unpack_bytes(near.z);
  vec4 far_x = unpack_bytes(far.x);
  vec4 far_y = unpack_bytes(far.y);
  vec4 far_z = unpack_bytes(far.z);

  uvec4 met = NONE_MET;
  [[unroll]] for (uint slot = 0u; slot < PACKET_SIZE; ++slot) {
    vec3 inverse = packet[slot].inverse_direction;
    precise vec3 step = scale * inverse;
    precise vec3 near_base = (origin - packet[slot].near_origin) * inverse;
    precise vec3 far_base = (origin - packet[slot].far_origin) * inverse;
    precise vec4 near_t_x = near_x * step.x + near_base.x;
    precise vec4 near_t_y = near_y * step.y + near_base.y;
    precise vec4 near_t_z = near_z * step.z + near_base.z;
    precise vec4 far_t_x = far_x * step.x + far_base.x;
    precise vec4 far_t_y = far_y * step.y + far_base.y;
    precise vec4 far_t_z = far_z * step.z + far_base.z;
    vec4 entry = greater(near_t_x, greater(near_t_y, greater(near_t_z, vec4(packet[slot].tmin))));
    vec4 exit = lesser(far_t_x, lesser(far_t_y, far_t_z));
    // The limit is slightly larger than the remaining distance, because t is rounded when the shift is added.
    precise float limit = limits[slot] - SHIFT_TO_CULL_BY * shifts[slot];
    // In an instance the shift may be smaller than the remaining distance.
    if (has(FEATURE_INSTANCES)) limit = in_level(slot, limit + 4.0 * UNIT_ROUNDOFF * limits[slot]);
    met = add_met(met, lessThanEqual(entry, lesser(exit, vec4(limit))), entry);
  }

  return family_of(node, child_count_of(boxes), met);
}
