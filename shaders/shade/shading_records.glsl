// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The buffer of shading: surfaces, materials, lights and vertices.

// These blocks are views of one buffer, because Vulkan guarantees only four storage buffers per stage. Each view starts
// at a multiple of its own stride (VIEW.first_index).
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Surfaces { SurfaceRecord surfaces[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Materials { MaterialRecord materials[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Extensions { ExtensionRecord extensions[]; };
layout(std430, set = 0, binding = BINDING_SHADING) readonly buffer Glasses { GlassRecord glasses[]; };
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
                        shading_vector(first + 3u), shading_vector(first + 4u), shading_vector(first + 5u));
}

#include "shade/instance_surfaces.glsl"

uint flags_of(MaterialRecord material) { return floatBitsToUint(material.emissive.w); }

ExtensionRecord load_extension(uint index) {
  if (FETCHES_TEXELS == 0u) return extensions[index];
  uint first = EXTENSION_TEXELS * index;
  return ExtensionRecord(shading_vector(first), texelFetch(shading_texels, int(first + 1u)),
                         shading_vector(first + 2u), shading_vector(first + 3u),
                         texelFetch(shading_texels, int(first + 4u)), shading_vector(first + 5u),
                         shading_vector(first + 6u), shading_vector(first + 7u),
                         texelFetch(shading_texels, int(first + 8u)), texelFetch(shading_texels, int(first + 9u)));
}

// Returns the record of a glass. `number` counts from 1.
GlassRecord load_glass(uint number) {
  uint index = VIEW.first_glass.x + max(number, 1u) - 1u;
  if (FETCHES_TEXELS == 0u) return glasses[index];
  uint first = GLASS_TEXELS * index;
  return GlassRecord(shading_vector(first), shading_vector(first + 1u), shading_vector(first + 2u),
                     texelFetch(shading_texels, int(first + 3u)));
}

LightRecord load_light(uint index) {
  if (FETCHES_TEXELS == 0u) return lights[index];
  uint first = LIGHT_TEXELS * index;
  return LightRecord(shading_vector(first), shading_vector(first + 1u), shading_vector(first + 2u),
                     shading_vector(first + 3u), texelFetch(shading_texels, int(first + 4u)));
}

vec4 load_vertex4(uint index) {
  if (FETCHES_TEXELS == 0u) return vertices[index];
  return shading_vector(index);
}

vec3 load_vertex(uint index) { return load_vertex4(index).xyz; }

// Returns the vertex colour, interpolated between a triangle's corners.
vec4 load_vertex_color(uvec3 corners, vec3 weights) {
  precise vec4 color = weights.x * load_vertex4(VIEW.first_index.w + corners.x) +
                       weights.y * load_vertex4(VIEW.first_index.w + corners.y) +
                       weights.z * load_vertex4(VIEW.first_index.w + corners.z);
  return color;
}

// Returns two numbers for a roughness and an angle with this cosine. They come from a table that starts at texel
// `table` (engine/device_scene/lobe_table.h). A texel has the four entries of a cell. Each entry is a word with x in
// its lower half.
vec2 load_shares(uint table, float cosine, float roughness) {
  precise float x = float(LOBE_TABLE_SIDE - 1u) * sqrt(clamp(cosine, 0.0, 1.0));
  precise float y = float(LOBE_TABLE_SIDE - 1u) * clamp(roughness, 0.0, 1.0);
  vec2 cell = min(floor(vec2(x, y)), vec2(float(LOBE_TABLE_SIDE - 2u)));
  uint index = table + uint(cell.y) * (LOBE_TABLE_SIDE - 1u) + uint(cell.x);
  uvec4 words = FETCHES_TEXELS == 0u ? surfaces[index].corners_material : texelFetch(shading_texels, int(index));
  precise vec4 firsts = vec4(words & 0xFFFFu);
  precise vec4 seconds = vec4(words >> 16);
  precise float fx = x - cell.x;
  precise float fy = y - cell.y;
  precise vec2 low = vec2(firsts.x + fx * (firsts.y - firsts.x), seconds.x + fx * (seconds.y - seconds.x));
  precise vec2 high = vec2(firsts.z + fx * (firsts.w - firsts.z), seconds.z + fx * (seconds.w - seconds.z));
  precise vec2 result = (low + fy * (high - low)) * (1.0 / 65535.0);
  return result;
}

// Returns the shares of a lobe of this roughness: how it reflects light from all directions to an eye at an angle with
// this cosine. x = E1, the fraction reflected with a reflectance of 1; y = B, the fraction that Schlick's factor adds.
vec2 load_lobe_shares(float cosine, float roughness) { return load_shares(VIEW.first_lookup.x, cosine, roughness); }

// Returns the fraction of light from all directions that a sheen of colour 1 reflects to the eye. The table of sheens
// follows the table of lobes.
float load_sheen_share(float cosine, float roughness) {
  uint table = VIEW.first_lookup.x + (LOBE_TABLE_SIDE - 1u) * (LOBE_TABLE_SIDE - 1u);
  precise float share = LARGEST_SHEEN_SHARE * load_shares(table, cosine, roughness).x;
  return share;
}
