// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// What every pipeline is bound to. An entry point adds its own buffers, one of them with a Dispatch `dispatch` at its
// head, before it includes the rest.

layout(constant_id = CONSTANT_FEATURES) const uint FEATURES = 0xFFFFFFFFu;
// Entries that the traversal stack needs: the tree's depth, known when it is built.
layout(constant_id = CONSTANT_STACK_SIZE) const uint STACK_SIZE = 96u;

bool has(uint feature) { return (FEATURES & feature) != 0u; }

const uint SOLID_FEATURES = FEATURE_TRIANGLES | FEATURE_SPHERES | FEATURE_CYLINDERS | FEATURE_CONES;

// Whether a primitive of the tree is of this kind; without a test where the scene has no other.
bool is_kind(uint kind, uint wanted, uint feature) {
  if ((FEATURES & SOLID_FEATURES) == feature) return true;
  return has(feature) && kind == wanted;
}

layout(std140, set = 0, binding = BINDING_FRAME) uniform FrameBlock { Frame frame; };
layout(std430, set = 0, binding = BINDING_NODES) readonly buffer Nodes { Node nodes[]; };
layout(std430, set = 0, binding = BINDING_PRIMITIVES) readonly buffer Primitives { Primitive primitives[]; };
