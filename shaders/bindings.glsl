// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Everything a pipeline is bound to.

layout(constant_id = CONSTANT_FEATURES) const uint FEATURES = 0xFFFFFFFFu;
// Entries that the traversal stack needs: the tree's depth, known when it is built.
layout(constant_id = CONSTANT_STACK_SIZE) const uint STACK_SIZE = 96u;

bool has(uint feature) { return (FEATURES & feature) != 0u; }

layout(std140, set = 0, binding = BINDING_FRAME) uniform FrameBlock { Frame frame; };
layout(std430, set = 0, binding = BINDING_NODES) readonly buffer Nodes { Node nodes[]; };
layout(std430, set = 0, binding = BINDING_PRIMITIVES) readonly buffer Primitives { Primitive primitives[]; };

// Views of one buffer: four storage buffers a stage are all that Vulkan guarantees. Each view starts at a multiple of
// its own stride (frame.first_index).
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Surfaces { SurfaceRecord surfaces[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Lights { LightRecord lights[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Vertices { vec4 vertices[]; };

// Sums over samples, a pixel each; and rays traced, x = primary, y = shadow, z = reflection, a counter a lane of a
// block: one for all would have every lane queue for it, and a sum over the block would need barriers, for which
// lavapipe 22.3 runs a coroutine a subgroup and leaks it.
layout(std430, set = 0, binding = BINDING_FILM) buffer Film {
  Dispatch dispatch;
  uvec4 ray_counts[BLOCK_SIZE * BLOCK_SIZE];
  vec4 pixels[];
};
