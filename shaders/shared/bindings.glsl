// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The bindings of every pipeline. An entry point adds its own buffers, one of them with a Dispatch `dispatch` at its
// head, before it includes the other files.

layout(constant_id = CONSTANT_FEATURES) const uint FEATURES = 0xFFFFFFFFu;
layout(constant_id = CONSTANT_MORE_FEATURES) const uint MORE_FEATURES = 0xFFFFFFFFu;
// The number of entries of the traversal stack: one for each node above the deepest node. It is known after the tree is
// built.
layout(constant_id = CONSTANT_STACK_SIZE) const uint STACK_SIZE = 96u;
// Number of rays that an invocation traces together (packet.glsl).
layout(constant_id = CONSTANT_PACKET_SIZE) const uint PACKET_SIZE = 1u;
// The form of traversal, which suits the driver (DeviceProfile); hits have the same bits for every form. STEPS_TOGETHER
// is the number of node steps that all lanes take before the lanes that have reached leaves test them. With 0 each lane
// steps until it reaches a leaf.
layout(constant_id = CONSTANT_STEPS_TOGETHER) const uint STEPS_TOGETHER = 0u;
// True if solids wait until no lane can continue without them.
layout(constant_id = CONSTANT_WAITS_WITH_SOLIDS) const uint WAITS_WITH_SOLIDS = 0u;
// True if triangles that a ray may hit wait too, in scenes whose textures have holes.
layout(constant_id = CONSTANT_WAITS_WITH_HOLES) const uint WAITS_WITH_HOLES = 0u;
// True if all of the kernel's rays are any-hit rays.
layout(constant_id = CONSTANT_ALL_ASK_FOR_ANY) const uint ALL_ASK_FOR_ANY = 0u;

// A constant that is 1 if the pipeline has the feature FEATURE_*, and otherwise 0.
#define FEATURE_BIT(FEATURE) ((((FEATURE) < 32u ? FEATURES : MORE_FEATURES) >> ((FEATURE) & 31u)) & 1u)

// This is a macro, so that the value of code that depends on it is known before functions are inlined
// (engine/device/spirv.h).
#define has(FEATURE) (FEATURE_BIT(FEATURE) != 0u)

// The numbers of kinds in the pipeline: kinds of primitives in the tree, of unbounded primitives, of lights, and of
// material models.
const uint TREE_KIND_COUNT = 0u
#define PROMIN_TREE_PRIMITIVE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) +FEATURE_BIT(BIT)
#include "promin/kinds/primitives.def"
    ;
const uint UNBOUNDED_KIND_COUNT = 0u
#define PROMIN_UNBOUNDED(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) +FEATURE_BIT(BIT)
#include "promin/kinds/primitives.def"
    ;
const uint LIGHT_KIND_COUNT = 0u
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME) +FEATURE_BIT(BIT)
#include "promin/kinds/lights.def"
    ;
const uint MATERIAL_KIND_COUNT = 0u
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) +FEATURE_BIT(BIT)
#include "promin/kinds/materials.def"
    ;
// True if mirror rays that leave the scene may see something other than the background.
const bool SEES_ENVIRONMENT = (FEATURE_BIT(FEATURE_METALLIC_ROUGHNESS) | FEATURE_BIT(FEATURE_SKY)) != 0u;

// VIEW holds the constants that all dispatches of a view share. CAMERA is the same block, for reading the camera. A
// dispatch has one workgroup in z, so both are element 0. If a branch depends only on uniforms, lavapipe makes them
// constants and compiles the kernel again for each of their values (lvp_inline_uniforms.c). Rays that all start at the
// eye or all have the direction of view cause such branches. The camera is therefore read at an index that depends on
// the workgroup, which lavapipe does not inline. Reading the whole block this way would take 2 % more instructions.
layout(std140, set = 0, binding = BINDING_VIEW) uniform ViewBlock { ViewConstants views[1]; };
#define VIEW views[0]
#define CAMERA views[gl_WorkGroupID.z]

// Nodes and primitives are bound twice: as storage buffers, which work on every device for every scene, and as texel
// buffers of the same memory. Lavapipe loads storage buffers word by word, but a texel in one step.
layout(constant_id = CONSTANT_FETCHES_TEXELS) const uint FETCHES_TEXELS = 0u;
layout(std430, set = 0, binding = BINDING_NODES) readonly buffer Nodes { Node nodes[]; };
layout(std430, set = 0, binding = BINDING_PRIMITIVES) readonly buffer Primitives { Primitive primitives[]; };
layout(set = 0, binding = BINDING_NODE_TEXELS) uniform usamplerBuffer node_texels;
layout(set = 0, binding = BINDING_PRIMITIVE_TEXELS) uniform usamplerBuffer primitive_texels;

Primitive load_primitive(uint index) {
  if (FETCHES_TEXELS == 0u) return primitives[index];
  int first = int(PRIMITIVE_TEXELS * index);
  return Primitive(uintBitsToFloat(texelFetch(primitive_texels, first)),
                   uintBitsToFloat(texelFetch(primitive_texels, first + 1)), texelFetch(primitive_texels, first + 2));
}

uint load_primitive_kind(uint index) {
  if (FETCHES_TEXELS == 0u) return primitives[index].c.z;
  return texelFetch(primitive_texels, int(PRIMITIVE_TEXELS * index + 2u)).z;
}

// The following functions return the last words of a Primitive (layout.h).
uint kind_of(Primitive p) { return p.c.z; }
uint order_of(Primitive p) { return p.c.y; }
uint object_hash_of(Primitive p) { return p.c.w & 0xFFFFu; }
uint primitive_hash_of(Primitive p) { return p.c.w >> 16; }

// The following functions read the word of a child.
bool is_inner(uint child) { return (child & CHILD_IS_LEAF) == 0u; }
uint first_of_leaf(uint child) { return child & CHILD_FIRST_MASK; }
uint count_of_leaf(uint child) { return ((child >> CHILD_COUNT_SHIFT) & CHILD_COUNT_MASK) + 1u; }
