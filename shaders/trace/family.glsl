// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The family of a node: the children that remain to be visited, in one word. The upper bits are the node's index. Below
// are the number of remaining children minus one, and the places in the node of the first three of them, the nearest
// first. The last of four is not stored, because it is the one that the others are not. With ALL_ASK_FOR_ANY the lowest
// bits instead have one bit for each remaining child, and these are visited in the order of places: rays without a hit,
// which are most, visit all children that they hit in any order.
const uint FAMILY_NODE_SHIFT = 8u;
const uint FAMILY_OTHERS_SHIFT = 6u;
const uint FAMILY_THIRD_SHIFT = 4u;
const uint FAMILY_SECOND_SHIFT = 2u;  // the first place is in the lowest bits
const uint FAMILY_PLACE_MASK = 3u;    // mask of a place, and of the number of other children
const uint FAMILY_NODE_MASK = MAX_NODES << FAMILY_NODE_SHIFT;
const uint FAMILY_CHILDREN_MASK = (1u << NODE_WIDTH) - 1u;  // mask of the children if ALL_ASK_FOR_ANY
const uint NO_FAMILY = 0xFFFFFFFFu;

uint node_of_family(uint family) { return family >> FAMILY_NODE_SHIFT; }

uint component_of(uvec4 v, uint i) {
  uvec2 half_of_v = (i & 2u) == 0u ? v.xy : v.zw;
  return (i & 1u) == 0u ? half_of_v.x : half_of_v.y;
}

uint component_of_lowest_bit(uvec4 v, uint mask) {
  return (mask & 1u) != 0u ? v.x : ((mask & 2u) != 0u ? v.y : ((mask & 4u) != 0u ? v.z : v.w));
}

// Returns the next child of a node's family.
uint next_of_family(uint family, uvec4 children) {
  if (ALL_ASK_FOR_ANY != 0u) return component_of_lowest_bit(children, family);
  return component_of(children, family & FAMILY_PLACE_MASK);
}

// Returns a family without its next child. After the last child it returns NO_FAMILY.
uint without_next(uint family) {
  if (ALL_ASK_FOR_ANY != 0u) {
    uint left = family & (family - 1u);
    return (left & FAMILY_CHILDREN_MASK) == 0u ? NO_FAMILY : left;
  }
  uint others = (family >> FAMILY_OTHERS_SHIFT) & FAMILY_PLACE_MASK;
  uint last = (family ^ (family >> FAMILY_SECOND_SHIFT) ^ (family >> FAMILY_THIRD_SHIFT)) & FAMILY_PLACE_MASK;
  uint places = (family >> FAMILY_SECOND_SHIFT) & ((1u << FAMILY_THIRD_SHIFT) - 1u);
  uint left =
      (family & FAMILY_NODE_MASK) | ((others - 1u) << FAMILY_OTHERS_SHIFT) | (last << FAMILY_THIRD_SHIFT) | places;
  return others == 0u ? NO_FAMILY : left;
}

uvec4 sorted(uvec4 k) {
  uvec4 pairs = uvec4(min(k.x, k.y), max(k.x, k.y), min(k.z, k.w), max(k.z, k.w));
  uvec4 ends = uvec4(min(pairs.xy, pairs.zw), max(pairs.xy, pairs.zw));
  return uvec4(ends.x, min(ends.y, ends.z), max(ends.y, ends.z), ends.w);
}

const uint NOT_MET = 0xFFFFFFFFu;

uvec4 key_where(bvec4 condition, uvec4 keys) {
  return uvec4(condition.x ? keys.x : NOT_MET, condition.y ? keys.y : NOT_MET, condition.z ? keys.z : NOT_MET,
               condition.w ? keys.w : NOT_MET);
}

// The children that are hit. For each child there are the bits of the first ray's entry distance, or NOT_MET. The bits
// have the same order as the distances, because no distance is negative. With ALL_ASK_FOR_ANY, x has a bit for each
// child.
const uvec4 NONE_MET = uvec4(ALL_ASK_FOR_ANY != 0u ? 0u : NOT_MET);

uvec4 add_met(uvec4 met, bvec4 are_met, vec4 entries) {
  uint mask = met.x;
  if (are_met.x) mask |= 1u;
  if (are_met.y) mask |= 2u;
  if (are_met.z) mask |= 4u;
  if (are_met.w) mask |= 8u;
  uvec4 first = min(met, key_where(are_met, floatBitsToUint(entries)));
  // The code has no branch, because glslang 12 fails on some branches.
  return ALL_ASK_FOR_ANY != 0u ? uvec4(mask) : first;
}

// Returns the family of the children that are hit among the first `count`.
uint family_of(uint node, uint count, uvec4 met) {
  if (ALL_ASK_FOR_ANY != 0u) {
    uint mask = met.x & ((1u << count) - 1u);
    return mask == 0u ? NO_FAMILY : (node << FAMILY_NODE_SHIFT) | mask;
  }
  bvec4 is_met = lessThan(uvec4(0u, 1u, 2u, 3u), uvec4(count));
  is_met = bvec4(is_met.x && met.x != NOT_MET, is_met.y && met.y != NOT_MET, is_met.z && met.z != NOT_MET,
                 is_met.w && met.w != NOT_MET);
  uvec4 keys = sorted(key_where(is_met, (met & ~FAMILY_PLACE_MASK) | uvec4(0u, 1u, 2u, 3u)));
  uint others = uint(keys.y != NOT_MET) + uint(keys.z != NOT_MET) + uint(keys.w != NOT_MET);
  uvec4 places = keys & FAMILY_PLACE_MASK;
  uint family = (node << FAMILY_NODE_SHIFT) | (others << FAMILY_OTHERS_SHIFT) | (places.z << FAMILY_THIRD_SHIFT) |
                (places.y << FAMILY_SECOND_SHIFT) | places.x;
  return keys.x == NOT_MET ? NO_FAMILY : family;
}
