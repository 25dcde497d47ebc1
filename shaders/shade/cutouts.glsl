// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Parts of triangles that rays ignore: holes from the alpha of textures and vertices, and backs that a material does
// not show (docs/model.md, "Alpha and sides"). Holes are tested when a triangle is intersected, for every ray of a
// picture, so that the nearest hit depends neither on the tree nor on how often a triangle is in it.

MaterialRecord material_of(SurfaceRecord surface) {
  return load_material(VIEW.first_index.x + (surface.corners_material.w & SURFACE_MATERIAL_MASK));
}

// Returns whether the material is absent everywhere. Textures and vertices can only reduce alpha.
bool is_all_hole(MaterialRecord material) {
  return (flags_of(material) & MATERIAL_HAS_HOLES) != 0u && material.cover.x < material.cover.y;
}

bool has_holes(MaterialRecord material, SurfaceRecord surface) {
  uint flags = surface.corners_material.w;
  bool may_vary = (flags & (SURFACE_HAS_UVS | SURFACE_IS_COLORED)) != 0u;
  return is_all_hole(material) || (may_vary && (flags_of(material) & MATERIAL_HAS_HOLES) != 0u);
}

bool is_seen_through(MaterialRecord material) {
  return (flags_of(material) & MATERIAL_BLENDS) != 0u || is_clear(material);
}

bool may_have_holes(uint index) {
  SurfaceRecord surface = load_surface_of(index, has(FEATURE_INSTANCES) && is_in_instance ? inside_part : PART_SIDE);
  return has_holes(material_of(surface), surface);
}

bool is_catcher(uint index) {
  return (flags_of(material_of(load_surface_of(index, PART_SIDE))) & MATERIAL_CATCHES_SHADOWS) != 0u;
}

// Returns the alpha of the material, multiplied by the alphas of the vertices and of the texture.
float alpha_at(MaterialRecord material, Primitive p, SurfaceRecord surface, vec3 weights, float facing,
               float cone_width) {
  precise float alpha = material.cover.x;
  if (has(FEATURE_VERTEX_COLORS) && (surface.corners_material.w & SURFACE_IS_COLORED) != 0u) {
    alpha *= load_vertex_color(surface.corners_material.xyz, weights).w;
  }
  uint slot = slot_number(material.cover.z);
  if (has(FEATURE_TEXTURES) && slot != 0u && (surface.corners_material.w & SURFACE_HAS_UVS) != 0u) {
    CornerUvs uvs = load_corner_uvs(surface.corners_material.xyz);
    alpha *= look_up(slot, texture_place(p, uvs, weights, facing, cone_width)).w;
  }
  return alpha;
}

bool is_cut_out(vec3 direction, Primitive p, uint index, Crossing crossing, bool is_on_open_edge) {
  SurfaceRecord surface = load_surface_of(index, crossing.part);
  MaterialRecord material = material_of(surface);
  if (PASSES != 0u && is_on_open_edge && is_seen_through(material)) return true;
  // This cosine is computed in the same way as in shading.
  float facing = dot3(triangle_normal(p), direction);
  if (is_instance_part(crossing.part)) {
    direction = world_direction;
    facing = dot3(instance_normal(p, crossing.part), direction);
    if (has(FEATURE_HOLES)) p = place_about_origin(p, load_instance_look(crossing.part));
  }
  if (has(FEATURE_ONE_SIDED) && passes_backs && facing > 0.0 && (flags_of(material) & MATERIAL_IS_ONE_SIDED) != 0u) {
    return true;
  }
  if (!has(FEATURE_HOLES) || !has_holes(material, surface)) return false;
  if (is_all_hole(material)) return true;
  float size = length3(direction);
  precise float cone_width = sight_width + sight_spread * (crossing.t * size);
  precise vec3 weights = vec3(1.0 - crossing.u - crossing.v, crossing.u, crossing.v);
  precise float cosine = facing / size;
  return alpha_at(material, p, surface, weights, cosine, cone_width) < material.cover.y;
}

// Returns the texel of the texture's finest level at a hit; 1 if there is no texture.
vec4 texel_at_hit(uint slot, Hit hit, Primitive p, SurfaceRecord surface) {
  uvec4 corners = surface.corners_material;
  if (!has(FEATURE_TEXTURES) || slot == 0u || (corners.w & SURFACE_HAS_UVS) == 0u) return vec4(1.0);
  precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  return look_up(slot, texture_place(p, load_corner_uvs(corners.xyz), weights, 1.0, 0.0));
}

// Returns the opacity of a hit: 1 unless its material blends.
float coverage_of_hit(Hit hit, vec3 direction) {
  SurfaceRecord surface = load_surface_of(hit.primitive, hit.part);
  MaterialRecord material = material_of(surface);
  if ((flags_of(material) & MATERIAL_BLENDS) == 0u) return 1.0;
  if (!has(FEATURE_HOLES) || !has_holes(material, surface)) return material.cover.x;
  Primitive p = load_primitive(hit.primitive);
  precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  return clamp(alpha_at(material, p, surface, weights, 1.0, 0.0), 0.0, 1.0);
}

// Returns the fraction of a source's light that remains behind a hit. `arriving` is the fraction that arrives at the
// hit, and `layers` the number of surfaces that the shadow ray has already passed.
float share_behind(Hit hit, vec3 direction, float arriving, uint layers) {
  float coverage = layers < MOST_LAYERS ? coverage_of_hit(hit, direction) : 1.0;
  precise float left = arriving * (1.0 - coverage);
  return left >= LEAST_SHARE_BEHIND ? left : 0.0;
}
