// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The buffer of shading: surfaces, materials, lights and vertices.

// These are views of one buffer, because four storage buffers per stage are all that Vulkan guarantees. Each view
// starts at a multiple of its own stride (VIEW.first_index).
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Surfaces { SurfaceRecord surfaces[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Lights { LightRecord lights[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Vertices { vec4 vertices[]; };
layout(set = 0, binding = BINDING_SHADING_TEXELS) uniform usamplerBuffer shading_texels;

vec4 shading_vector(uint texel) { return uintBitsToFloat(texelFetch(shading_texels, int(texel))); }

SurfaceRecord load_surface(uint index) {
  if (FETCHES_TEXELS == 0u) return surfaces[index];
  return SurfaceRecord(texelFetch(shading_texels, int(index)));
}

MaterialRecord load_material(uint index) {
  if (FETCHES_TEXELS == 0u) return materials[index];
  uint first = MATERIAL_TEXELS * index;
  return MaterialRecord(shading_vector(first), shading_vector(first + 1u), shading_vector(first + 2u),
                        shading_vector(first + 3u), shading_vector(first + 4u));
}

LightRecord load_light(uint index) {
  if (FETCHES_TEXELS == 0u) return lights[index];
  uint first = LIGHT_TEXELS * index;
  return LightRecord(shading_vector(first), shading_vector(first + 1u), shading_vector(first + 2u),
                     shading_vector(first + 3u), texelFetch(shading_texels, int(first + 4u)));
}

vec3 load_vertex(uint index) {
  if (FETCHES_TEXELS == 0u) return vertices[index].xyz;
  return shading_vector(index).xyz;
}
