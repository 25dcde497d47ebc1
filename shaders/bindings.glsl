// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What every pipeline is bound to. An entry point adds its own buffers, one of them with a Dispatch `dispatch` at its
// head, before it includes the rest.

layout(constant_id = CONSTANT_FEATURES) const uint FEATURES = 0xFFFFFFFFu;
// Entries that the traversal stack needs: one for each node above the deepest, known when the tree is built.
layout(constant_id = CONSTANT_STACK_SIZE) const uint STACK_SIZE = 96u;
// Rays that an invocation traces together (traversal.glsl).
layout(constant_id = CONSTANT_PACKET_SIZE) const uint PACKET_SIZE = 1u;
// All of the kernel's rays ask for any hit.
layout(constant_id = CONSTANT_ANY_HIT) const uint ANY_HIT = 0u;

bool has(uint feature) { return (FEATURES & feature) != 0u; }

const uint SOLID_FEATURES = FEATURE_TRIANGLES | FEATURE_SPHERES | FEATURE_CYLINDERS | FEATURE_CONES;

// Whether a primitive of the tree is of this kind; without a test where the scene has no other.
bool is_kind(uint kind, uint wanted, uint feature) {
  if ((FEATURES & SOLID_FEATURES) == feature) return true;
  return has(feature) && kind == wanted;
}

layout(std140, set = 0, binding = BINDING_FRAME) uniform FrameBlock { Frame frame; };

// Nodes and primitives come as storage buffers, which every device has for any scene, and as texel buffers of the same
// memory: lavapipe gathers a load from a storage buffer word by word, a texel at once.
layout(constant_id = CONSTANT_FETCHES_TEXELS) const uint FETCHES_TEXELS = 0u;
layout(std430, set = 0, binding = BINDING_NODES) readonly buffer Nodes { Node nodes[]; };
layout(std430, set = 0, binding = BINDING_PRIMITIVES) readonly buffer Primitives { Primitive primitives[]; };
layout(set = 0, binding = BINDING_NODE_TEXELS) uniform usamplerBuffer node_texels;
layout(set = 0, binding = BINDING_PRIMITIVE_TEXELS) uniform usamplerBuffer primitive_texels;

// A node but for its children, which traversal reads on their own.
struct NodeBoxes {
  uvec4 frame;
  uvec4 lo;
  uvec4 hi;
};

NodeBoxes load_boxes(uint index) {
  if (FETCHES_TEXELS == 0u) return NodeBoxes(nodes[index].frame, nodes[index].lo, nodes[index].hi);
  int first = int(4u * index);
  return NodeBoxes(texelFetch(node_texels, first), texelFetch(node_texels, first + 1),
                   texelFetch(node_texels, first + 2));
}

uvec4 load_children(uint index) {
  if (FETCHES_TEXELS == 0u) return nodes[index].children;
  return texelFetch(node_texels, int(4u * index + 3u));
}

Primitive load_primitive(uint index) {
  if (FETCHES_TEXELS == 0u) return primitives[index];
  int first = int(3u * index);
  return Primitive(uintBitsToFloat(texelFetch(primitive_texels, first)),
                   uintBitsToFloat(texelFetch(primitive_texels, first + 1)), texelFetch(primitive_texels, first + 2));
}

uint load_primitive_kind(uint index) {
  if (FETCHES_TEXELS == 0u) return primitives[index].c.z;
  return texelFetch(primitive_texels, int(3u * index + 2u)).z;
}
