// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shading (docs/model.md, "Light") of a point that a ray hit.

// A clear coat as the eye sees it (KHR_materials_clearcoat). Its reflection replaces the fraction `weight` of the light
// from below.
struct Coat {
  float weight;
  float roughness;
  float share;  // fraction of the light from all directions that a coat of weight 1 reflects
  vec3 normal;  // the coat's own normal, without the normals of the material below
};

// A sheen as the eye sees it (KHR_materials_sheen).
struct Sheen {
  vec3 color;
  float roughness;
  float share;  // fraction of the light from all directions that a sheen of colour 1 reflects; a value above 1 counts
                // as 1
};

// Reflection and transmission of a ray at glass (tree.glsl). Needs FEATURE_GLASS or FEATURE_FRESNEL.
struct Glass {
  vec3 mirror;       // Phong's weight of the mirror ray
  vec3 through;      // weight of the ray beyond the surface; 0 without one
  vec3 direction;    // unit direction of the ray beyond the surface
  uvec2 beyond;      // the media that contain this ray
  float bend;        // index of refraction on this side divided by the index beyond
  float roughness;   // roughness with which this ray sees the environment, or NO_ENVIRONMENT
  float share;       // fraction of the light that is not reflected and passes through
  uint object;       // hash of the object, with SKIPS_EXIT if the ray leaves it
};

// A thin film on a surface (KHR_materials_iridescence).
struct ThinFilm {
  vec4 layer;  // x = share; y = index of refraction; z = thickness in nanometres; w = how much less it is where its
               // texture is 0
  vec3 metal;  // the metal's reflectance at normal incidence under the film
};

// An anisotropic highlight (KHR_materials_anisotropy).
struct Anisotropy {
  float strength;
  vec2 alphas;  // alphas along the grain and across it; 0 if the point has no grain
  vec3 along;   // unit direction of the grain, perpendicular to the normal
  vec3 bent_normal;
};

// The data of a hit that the light loop and the mirror ray need.
struct ShadingPoint {
  vec3 position;
  vec3 geometric_normal;  // unit, faces the incoming ray
  vec3 normal;            // the interpolated normal or the geometric one; faces the incoming ray
  float lift;
  vec3 shadow_position;  // origin of shadow rays, before the lift
  vec3 color;            // vertex colour
  MaterialRecord material;
  vec2 lobe_shares;  // with FEATURE_METALLIC_ROUGHNESS
  float occlusion;   // with FEATURE_TEXTURES: the fraction of the environment's light that arrives
  float curvature;   // with FEATURE_TEXTURES: change of the normal per length along the surface
  Coat coat;         // with FEATURE_COATS
  Sheen sheen;       // with FEATURE_SHEENS
  Glass glass;       // with FEATURE_GLASS or FEATURE_FRESNEL
  vec4 scattering;   // with FEATURE_DIFFUSE_TRANSMISSION: xyz = colour of the light that is scattered to the other
                     // side; w = its fraction of all scattered light
  ThinFilm thin_film;   // with FEATURE_IRIDESCENCE
  Anisotropy anisotropy;  // with FEATURE_ANISOTROPY
};

#include "shade/glass.glsl"

// True if the reflection and transmission of some faces depend on the angle.
const bool HAS_FACES = (FEATURE_BIT(FEATURE_GLASS) | FEATURE_BIT(FEATURE_FRESNEL)) != 0u;

#include "shade/materials.glsl"
#include "shade/textures.glsl"
#include "shade/texture_slots.glsl"
#include "shade/cutouts.glsl"

bool is_extended(MaterialRecord material) { return slot_number(material.d.x) != 0u; }
ExtensionRecord extension_of(MaterialRecord material) {
  return load_extension(VIEW.first_lookup.w + slot_number(material.d.x) - 1u);
}

// Lifts the point onto the curved surface that the vertex normals suggest, so that the coarse polygon does not shadow
// points that shading treats as lit (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II ch. 4).
vec3 lift_to_curve(vec3 position, vec3 corner, vec3 normal) {
  precise float height = min(0.0, dot3(position - corner, normal));
  precise vec3 projected = position - height * normal;
  return projected;
}

// Returns the change of the normals along the triangle's edges, divided by the distance. It is positive for a convex
// surface.
float curvature_of(Primitive p, vec3 n0, vec3 n1, vec3 n2) {
  precise vec3 e0 = corner1(p) - corner0(p);
  precise vec3 e1 = corner2(p) - corner1(p);
  precise vec3 e2 = corner0(p) - corner2(p);
  precise float sum = dot3(n1 - n0, e0) / max(dot3(e0, e0), SMALLEST_NORMAL) +
                      dot3(n2 - n1, e1) / max(dot3(e1, e1), SMALLEST_NORMAL) +
                      dot3(n0 - n2, e2) / max(dot3(e2, e2), SMALLEST_NORMAL);
  precise float mean = sum * (1.0 / 3.0);
  return mean;
}

// The part of the hit that is shaded, with FEATURE_INSTANCES. make_shading_point sets it.
uint shaded_part = PART_SIDE;

// Returns a normal of a vertex in the world.
vec3 load_vertex_normal(uint vertex) {
  vec3 normal = load_vertex(VIEW.first_index.z + vertex);
  if (is_instance_part(shaded_part)) {
    normal = to_world_normal(load_instance_map(shaded_part - FIRST_INSTANCE_PART), normal);
  }
  return normal;
}

void apply_vertex_normals(inout ShadingPoint point, Primitive p, uvec3 corners, vec3 weights, bool is_flipped) {
  vec3 n0 = load_vertex_normal(corners.x);
  vec3 n1 = load_vertex_normal(corners.y);
  vec3 n2 = load_vertex_normal(corners.z);
  // The side of the geometric normal determines on which side the interpolated normal is used. The sign of the
  // interpolated normal follows the winding.
  float side = is_flipped ? -1.0 : 1.0;
  precise vec3 interpolated = (weights.x * n0 + weights.y * n1 + weights.z * n2) * side;
  vec3 normal = normalize3(interpolated);
  if (max_abs(normal) == 0.0) return;
  point.normal = normal;
  vec3 position = point.position;
  if (is_instance_part(shaded_part)) {
    // The corners are relative to the origin of the instance's mesh.
    precise vec3 from_origin = weights.x * corner0(p) + weights.y * corner1(p) + weights.z * corner2(p);
    position = from_origin;
  }
  precise vec3 lifted = weights.x * lift_to_curve(position, corner0(p), n0 * side) +
                        weights.y * lift_to_curve(position, corner1(p), n1 * side) +
                        weights.z * lift_to_curve(position, corner2(p), n2 * side);
  point.shadow_position = lifted;
  if (is_instance_part(shaded_part)) {
    precise vec3 moved = point.position + (lifted - position);
    point.shadow_position = moved;
  }
  if (has(FEATURE_TEXTURES)) {
    precise float curvature = side * curvature_of(p, n0, n1, n2);
    point.curvature = curvature;
  }
}

// Returns the tangent's component perpendicular to the normal. On the back of a surface all three axes are reversed.
vec3 axis_across(vec3 normal, vec4 tangent, float side) {
  precise vec3 t = tangent.xyz * side;
  precise vec3 along = t - dot3(t, normal) * normal;
  return normalize3(along);
}

// Returns the normal, rotated by the texel of a normal texture. `tangent` and its bitangent span the plane of the
// texture.
vec3 turned_normal(vec3 normal, vec3 texel, float scale, vec4 tangent, float side, vec3 direction) {
  precise vec2 scaled = (2.0 * texel.xy - 1.0) * scale;
  precise float z = 2.0 * texel.z - 1.0;
  vec3 axis = axis_across(normal, tangent, side);
  precise vec3 across = tangent.w * side * cross3(normal, axis);
  precise vec3 sum = scaled.x * axis + scaled.y * across + z * normal;
  vec3 turned = normalize3(sum);
  if (max_abs(axis) == 0.0 || max_abs(turned) == 0.0) return normal;
  // A normal that points away from the eye is rotated until it is perpendicular to the view.
  precise float cosine = -dot3(turned, direction);
  precise vec3 bent = turned - (LEAST_COSINE - cosine) * direction;
  return cosine < LEAST_COSINE ? normalize3(bent) : turned;
}

// Returns the tangent of the triangle's own texture coordinates. It is used if the mesh has no tangents.
vec4 tangent_of(Primitive p, vec2 a, vec2 b, vec2 c) {
  precise vec3 e1 = corner1(p) - corner0(p);
  precise vec3 e2 = corner2(p) - corner0(p);
  precise vec2 d1 = b - a;
  precise vec2 d2 = c - a;
  precise float area = d1.x * d2.y - d1.y * d2.x;
  float sign_of_area = area < 0.0 ? -1.0 : 1.0;
  precise vec3 tangent = sign_of_area * (d2.y * e1 - d1.y * e2);
  // Images have their first row at v = 0, so the bitangent points in the direction of decreasing v.
  return vec4(normalize3(tangent), -sign_of_area);
}

// Returns the interpolated tangents of the mesh if there are any, otherwise the triangle's own tangent.
vec4 tangent_at(uvec4 corners, vec3 weights, Primitive p, CornerUvs uvs, uint slot) {
  if ((corners.w & SURFACE_HAS_TANGENTS) != 0u) {
    precise vec4 sum = weights.x * load_vertex4(VIEW.first_texture.y + corners.x) +
                       weights.y * load_vertex4(VIEW.first_texture.y + corners.y) +
                       weights.z * load_vertex4(VIEW.first_texture.y + corners.z);
    vec4 tangent = vec4(sum.xyz, sum.w < 0.0 ? -1.0 : 1.0);
    if (is_instance_part(shaded_part)) {
      InstanceLook look = load_instance_look(shaded_part);
      precise float handedness = tangent.w * handedness_of(look);
      tangent = vec4(to_world_direction(look, tangent.xyz), handedness);
    }
    return tangent;
  }
  bool is_second = slot != 0u && has_flag(load_slot(slot), TEXTURE_UV_SET);
  vec4 own = is_second ? tangent_of(p, uvs.a.zw, uvs.b.zw, uvs.c.zw) : tangent_of(p, uvs.a.xy, uvs.b.xy, uvs.c.xy);
  // A mirrored instance keeps the order of corners, so its winding is reversed.
  if (is_instance_part(shaded_part)) {
    precise float handedness = own.w * handedness_of(load_instance_look(shaded_part));
    own.w = handedness;
  }
  return own;
}

// Returns the normal from a normal texture. `number` is the number of its slot, and `texel` its value.
vec3 textured_normal(vec3 normal, uint number, vec3 texel, float scale, Primitive p, uvec4 corners, vec3 weights,
                     CornerUvs uvs, bool is_flipped, vec3 direction) {
  if (number == 0u) return normal;
  return turned_normal(normal, texel, scale, tangent_at(corners, weights, p, uvs, number), is_flipped ? -1.0 : 1.0,
                       direction);
}

// Returns the dielectric's reflectance at normal and at grazing incidence (KHR_materials_specular).
vec4 textured_reflectance(ExtensionRecord record) {
  precise vec3 at_normal = record.reflectance.xyz * shown[SPECULAR_COLOR_SLOT].xyz;
  precise float factor = record.reflectance.w * shown[SPECULAR_SLOT].w;
  precise vec3 reduced = min(at_normal, vec3(1.0)) * factor;
  return vec4(reduced, factor);
}

void put_slot_numbers_of(ExtensionRecord record) {
  slot_numbers[COAT_SLOT] = record.coat_slots.x;
  slot_numbers[COAT_ROUGHNESS_SLOT] = record.coat_slots.y;
  slot_numbers[COAT_NORMAL_SLOT] = record.coat_slots.z;
  slot_numbers[SHEEN_COLOR_SLOT] = record.slots.x;
  slot_numbers[SHEEN_ROUGHNESS_SLOT] = record.slots.y;
  slot_numbers[SPECULAR_SLOT] = record.slots.z;
  slot_numbers[SPECULAR_COLOR_SLOT] = record.slots.w;
}

// The places of the following slots depend on the features.
void put_slot_numbers_of_rare(ExtensionRecord record) {
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
    slot_numbers[SCATTERING_SLOT] = record.rare_slots.x;
    slot_numbers[SCATTERING_COLOR_SLOT] = record.rare_slots.y;
  }
  if (has(FEATURE_IRIDESCENCE)) {
    slot_numbers[IRIDESCENCE_SLOT] = record.rare_slots.z;
    slot_numbers[IRIDESCENCE_THICKNESS_SLOT] = record.rare_slots.w;
  }
  if (has(FEATURE_ANISOTROPY)) slot_numbers[ANISOTROPY_SLOT] = record.anisotropy_slot.x;
}

// Sets the strength and the direction of an anisotropic highlight, if texture coordinates give a tangent.
void put_anisotropy(inout ShadingPoint point, ExtensionRecord record, Primitive p, uvec4 corners, vec3 weights,
               CornerUvs uvs, bool is_flipped) {
  uint number = record.anisotropy_slot.x;
  vec4 tangent = tangent_at(corners, weights, p, uvs, number);
  float side = is_flipped ? -1.0 : 1.0;
  vec3 axis = axis_across(point.normal, tangent, side);
  precise vec3 across = tangent.w * side * cross3(point.normal, axis);
  precise vec2 painted = 2.0 * shown[ANISOTROPY_SLOT].xy - 1.0;
  vec2 direction = number == 0u ? vec2(1.0, 0.0) : painted;
  precise vec2 turned = vec2(record.anisotropy.y * direction.x - record.anisotropy.z * direction.y,
                             record.anisotropy.z * direction.x + record.anisotropy.y * direction.y);
  precise vec3 sum = turned.x * axis + turned.y * across;
  vec3 along = normalize3(sum);
  precise float strength = record.anisotropy.x * shown[ANISOTROPY_SLOT].z;
  Anisotropy grain = point.anisotropy;
  grain.strength = max_abs(along) == 0.0 ? 0.0 : strength;
  grain.along = along;
  point.anisotropy = grain;
}

void apply_textures(inout ShadingPoint point, Primitive p, uvec4 corners, vec3 weights, vec3 wound_normal,
                    bool is_flipped, vec3 direction, float cone_width) {
  CornerUvs uvs = load_corner_uvs(corners.xyz);
  TexturePlace place = texture_place(p, uvs, weights, dot3(wound_normal, direction), cone_width);
  // Whole structs are copied, because glslang crashes if nested members are written individually.
  MaterialRecord material = point.material;
  bool is_phong = has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG;
  bool is_metallic_roughness = has(FEATURE_METALLIC_ROUGHNESS) && model_of(point) == MATERIAL_METALLIC_ROUGHNESS;
  bool has_extension = HAS_EXTENSIONS && is_metallic_roughness && is_extended(material);
  uint normal = slot_number(is_phong ? material.b.w : material.d.z);
  normal = is_phong || is_metallic_roughness ? normal : 0u;
  [[unroll]] for (uint i = 0u; i < SLOT_COUNT; ++i) slot_numbers[i] = 0u;
  slot_numbers[BASE_SLOT] = slot_number(material.cover.z);
  slot_numbers[EMISSIVE_SLOT] = slot_number(material.cover.w);
  if (is_phong) slot_numbers[SURFACE_SLOT] = slot_number(material.d.w);
  if (is_metallic_roughness) {
    slot_numbers[SURFACE_SLOT] = slot_number(material.d.y);
    slot_numbers[OCCLUSION_SLOT] = slot_number(material.d.w);
  }
  slot_numbers[NORMAL_SLOT] = normal;
  if (has_extension) put_slot_numbers_of(extension_of(material));
  uint glass = glass_number(material);
  if (has(FEATURE_GLASS)) slot_numbers[TRANSMISSION_SLOT] = glass == 0u ? 0u : load_glass(glass).bits.y;
  if (RARE_FEATURES != 0u && has_extension) put_slot_numbers_of_rare(extension_of(material));
  look_up_slots(place);

  vec4 base = shown[BASE_SLOT];
  precise vec3 color = material.a.xyz * base.xyz;
  precise float alpha = material.cover.x * base.w;
  precise vec3 emissive = material.emissive.xyz * shown[EMISSIVE_SLOT].xyz;
  material.a = vec4(color, material.a.w);
  material.cover = vec4(alpha, material.cover.yzw);
  material.emissive = vec4(emissive, material.emissive.w);
  vec4 surface = shown[SURFACE_SLOT];
  if (is_phong) {
    precise vec3 diffuse = material.b.xyz * base.xyz;
    precise vec3 specular = material.c.xyz * surface.xyz;
    precise vec3 reflection = material.d.xyz * surface.xyz;
    material.b = vec4(diffuse, material.b.w);
    material.c = vec4(specular, material.c.w);
    material.d = vec4(reflection, material.d.w);
  }
  point.normal = textured_normal(point.normal, normal, shown[NORMAL_SLOT].xyz, is_phong ? 1.0 : material.c.y, p,
                                 corners, weights, uvs, is_flipped, direction);
  if (is_metallic_roughness) {
    precise vec2 factors = vec2(material.c.x, material.a.w) * surface.yz;
    precise float left = 1.0 + material.c.z * (shown[OCCLUSION_SLOT].x - 1.0);
    material.c = vec4(factors.x, material.c.yzw);
    material.a = vec4(material.a.xyz, factors.y);
    point.occlusion = left;
  }
  if (has_extension) {
    ExtensionRecord record = extension_of(material);
    if (has(FEATURE_COATS)) {
      Coat coat = point.coat;
      precise float weight = coat.weight * shown[COAT_SLOT].x;
      precise float roughness = coat.roughness * shown[COAT_ROUGHNESS_SLOT].y;
      coat.weight = weight;
      coat.roughness = roughness;
      coat.normal = textured_normal(coat.normal, record.coat_slots.z, shown[COAT_NORMAL_SLOT].xyz, record.coat.z, p,
                                    corners, weights, uvs, is_flipped, direction);
      point.coat = coat;
    }
    if (has(FEATURE_SHEENS)) {
      Sheen sheen = point.sheen;
      precise vec3 sheen_color = sheen.color * shown[SHEEN_COLOR_SLOT].xyz;
      precise float roughness = sheen.roughness * shown[SHEEN_ROUGHNESS_SLOT].w;
      sheen.color = sheen_color;
      sheen.roughness = roughness;
      point.sheen = sheen;
    }
    if (has(FEATURE_DIFFUSE_TRANSMISSION)) {
      precise vec4 scattering = point.scattering * vec4(shown[SCATTERING_COLOR_SLOT].xyz, shown[SCATTERING_SLOT].w);
      point.scattering = scattering;
    }
    if (has(FEATURE_IRIDESCENCE)) {
      ThinFilm film = point.thin_film;
      precise float share = film.layer.x * shown[IRIDESCENCE_SLOT].x;
      precise float thickness = film.layer.z + film.layer.w * (shown[IRIDESCENCE_THICKNESS_SLOT].y - 1.0);
      film.layer = vec4(share, film.layer.y, thickness, 0.0);
      point.thin_film = film;
    }
    if (has(FEATURE_ANISOTROPY)) put_anisotropy(point, record, p, corners, weights, uvs, is_flipped);
    if (has(FEATURE_SPECULAR_TEXTURES) && (record.slots.z | record.slots.w) != 0u) {
      material.b = textured_reflectance(record);
    }
  }
  if (has(FEATURE_GLASS)) {
    Glass seen_glass = point.glass;
    precise float share = seen_glass.share * shown[TRANSMISSION_SLOT].x;
    seen_glass.share = share;
    point.glass = seen_glass;
  }
  point.material = material;
}

// Sets the material's coat and sheen without their textures. The coat's weight is then its factor.
void put_bare_layers(inout ShadingPoint point) {
  Coat coat = Coat(0.0, 0.0, 0.0, point.normal);
  Sheen sheen = Sheen(vec3(0.0), 0.0, 0.0);
  if (model_of(point) == MATERIAL_METALLIC_ROUGHNESS && is_extended(point.material)) {
    ExtensionRecord record = extension_of(point.material);
    coat.weight = record.coat.x;
    coat.roughness = record.coat.y;
    sheen.color = record.sheen.xyz;
    sheen.roughness = record.sheen.w;
  }
  point.coat = coat;
  point.sheen = sheen;
}

// Sets the rare properties of the material without their textures.
void put_bare_rarities(inout ShadingPoint point) {
  vec4 scattering = vec4(0.0);
  ThinFilm film = ThinFilm(vec4(0.0), vec3(0.0));
  if (model_of(point) == MATERIAL_METALLIC_ROUGHNESS && is_extended(point.material)) {
    ExtensionRecord record = extension_of(point.material);
    scattering = record.scattering;
    film.layer = record.thin_film;
  }
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) point.scattering = scattering;
  if (has(FEATURE_IRIDESCENCE)) point.thin_film = film;
  if (has(FEATURE_ANISOTROPY)) point.anisotropy = Anisotropy(0.0, vec2(0.0), vec3(0.0), vec3(0.0));
}

// Returns the coat as the eye sees it, with Schlick's factor for an index of refraction of 1.5.
Coat seen_coat(Coat coat, vec3 direction) {
  float cosine = clamp(-dot3(coat.normal, direction), 0.0, 1.0);
  precise float p = 1.0 - cosine;
  precise float p2 = p * p;
  precise float weight = coat.weight * (0.04 + 0.96 * (p2 * p2 * p));
  return Coat(weight, coat.roughness, load_lobe_shares(cosine, coat.roughness).x, coat.normal);
}

Sheen seen_sheen(Sheen sheen, float cosine) {
  return Sheen(sheen.color, sheen.roughness, load_sheen_share(max(cosine, LEAST_COSINE), sheen.roughness));
}

// Sets the roughness that surfaces have after a diffuse one (scatter.glsl).
void roughen(inout ShadingPoint point) {
  if (!has(FEATURE_METALLIC_ROUGHNESS) || model_of(point) != MATERIAL_METALLIC_ROUGHNESS) return;
  MaterialRecord material = point.material;
  material.c.x = max(material.c.x, least_roughness);
  point.material = material;
  Coat coat = point.coat;
  coat.roughness = max(coat.roughness, least_roughness);
  if (has(FEATURE_COATS)) point.coat = coat;
}

#include "shade/faces.glsl"

// Makes the shading point of a hit. `direction` is the ray's unit direction, `cone_width` the width of its pixel's cone
// at the hit, `media` the media that contain the ray, and `color` the colour of light with which it is refracted. The
// point is an out parameter and not returned: for a call whose result is assigned, glslang 12 to 15 propagate `precise`
// from the struct's eighth member to the eighth member of every argument, and crash if one of these has fewer
// (propagateNoContraction.cpp).
void make_shading_point(Ray ray, vec3 direction, Hit hit, float cone_width, uvec2 media, uint color,
                        out ShadingPoint point) {
  Primitive p = load_primitive_of(hit.primitive, hit.part);
  SurfaceRecord record = load_surface_of(hit.primitive, hit.part);
  SurfacePoint surface = surface_point(ray, p, hit);
  if (has(FEATURE_INSTANCES)) shaded_part = hit.part;
  if (is_instance_part(hit.part)) p = place_about_origin(p, load_instance_look(hit.part));
  bool is_flipped = dot3(surface.normal, ray.direction) > 0.0;
  point.position = surface.position;
  point.geometric_normal = is_flipped ? -surface.normal : surface.normal;
  point.normal = point.geometric_normal;
  point.lift = surface.lift;
  point.shadow_position = surface.position;
  point.color = vec3(1.0);
  point.curvature = 0.0;
  point.material = material_of(record);
  precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
  if (has(FEATURE_SMOOTH_NORMALS) && (record.corners_material.w & SURFACE_IS_SMOOTH) != 0u) {
    apply_vertex_normals(point, p, record.corners_material.xyz, weights, is_flipped);
  }
  if (has(FEATURE_VERTEX_COLORS) && (record.corners_material.w & SURFACE_IS_COLORED) != 0u) {
    vec4 color = load_vertex_color(record.corners_material.xyz, weights);
    point.color = color.xyz;
    if (has(FEATURE_HOLES)) {
      MaterialRecord material = point.material;
      precise float alpha = material.cover.x * color.w;
      material.cover = vec4(alpha, material.cover.yzw);
      point.material = material;
    }
  }
  point.lobe_shares = vec2(1.0, 0.0);
  point.occlusion = 1.0;
  if (HAS_LAYERS) put_bare_layers(point);
  if (RARE_FEATURES != 0u) put_bare_rarities(point);
  if (HAS_FACES) put_bare_glass(point, direction, media, object_hash_of(p) | (is_flipped ? SKIPS_EXIT : 0u));
  if (has(FEATURE_TEXTURES) && (record.corners_material.w & SURFACE_HAS_UVS) != 0u) {
    apply_textures(point, p, record.corners_material, weights, surface.normal, is_flipped, direction, cone_width);
  }
  if (has(FEATURE_SCATTERING)) roughen(point);
  float cosine = -dot3(point.normal, direction);
  if (has(FEATURE_ANISOTROPY)) stretch(point, direction);
  if (HAS_FACES) cosine = meet_face(point, direction, media, color, is_flipped);
  if (has(FEATURE_METALLIC_ROUGHNESS)) point.lobe_shares = load_lobe_shares(cosine, point.material.c.x);
  if (has(FEATURE_IRIDESCENCE)) put_film(point, cosine);
  if (has(FEATURE_COATS)) point.coat = seen_coat(point.coat, direction);
  if (has(FEATURE_SHEENS)) point.sheen = seen_sheen(point.sheen, -dot3(point.normal, direction));
  if (has(FEATURE_GLASS) && has(FEATURE_METALLIC_ROUGHNESS)) let_through(point);
  if (has(FEATURE_RAY_LOG)) {
    log_surface(point.position, point.lift, surface.normal, point.normal,
                record.corners_material.w & SURFACE_MATERIAL_MASK);
  }
}

// Returns the unblocked contribution of a light source.
vec3 unshadowed_contribution(ShadingPoint point, vec3 to_eye, LightRecord light, LightSample sampled) {
  vec3 to_light = normalize3(sampled.direction);
  precise float cosine = dot3(point.normal, to_light);
  // A coat has its own normal, so it may be lit if the material is not.
  bool is_lit = has(FEATURE_COATS) ? cosine > 0.0 || dot3(point.coat.normal, to_light) > 0.0 : cosine > 0.0;
  if (has(FEATURE_DIFFUSE_TRANSMISSION) && scatters_through(point)) is_lit = true;
  if (!(is_lit && sampled.strength > 0.0)) return vec3(0.0);

  precise vec3 contribution = contribution_of(point, to_eye, to_light, max(cosine, 0.0), light);
  contribution *= sampled.strength;
  return contribution;
}

// Returns the light of a point without that of a source, if the point catches shadows: it is added again if nothing
// blocks the source. So unshadowed points have no noise.
vec3 without_caught(ShadingPoint point, vec3 contribution, vec3 seen) {
  precise vec3 rest = seen - contribution;
  return catches_shadows(point) ? rest : seen;
}

// Returns the origin of the shadow rays to sources in front of the surface, and to sources behind it.
vec3 shadow_origin(ShadingPoint point) {
  return lift_off(point.shadow_position, point.geometric_normal, point.lift);
}
vec3 shadow_origin_behind(ShadingPoint point) {
  return lift_off(point.position, -point.geometric_normal, point.lift);
}

// Returns the density per solid angle with which choose_from_lobe() chooses a direction (Heitz, "Sampling the GGX
// Distribution of Visible Normals", JCGT 7(4), 2018).
float density_of_lobe(vec3 normal, float alpha, vec3 to_eye, vec3 direction) {
  precise vec3 sum = to_eye + direction;
  float size = length3(sum);
  if (size < LEAST_HALF_VECTOR) return 0.0;
  precise vec3 h = sum / size;
  float v = max(dot3(normal, to_eye), LEAST_COSINE);
  precise float root = sqrt(alpha * alpha + (1.0 - alpha * alpha) * v * v);
  precise float density = density_of(normal, h, alpha) * 0.5 / (v + root);
  return density;
}

// Returns the normal of a facet that the eye sees, for a point of the unit square (Dupuy and Benyoub, "Sampling Visible
// GGX Normals with Spherical Caps", 2023). `across` and `along` are the directions of the two alphas.
vec3 choose_facet(vec3 across, vec3 along, vec3 normal, vec2 alphas, vec3 to_eye, vec2 u) {
  precise vec3 stretched = vec3(alphas.x * dot3(to_eye, across), alphas.y * dot3(to_eye, along),
                                max(dot3(to_eye, normal), LEAST_COSINE));
  vec3 wide = normalize3(stretched);
  vec3 disc = point_on_disc(u);
  precise float z = (1.0 - disc.z) * (1.0 + wide.z) - wide.z;
  precise vec2 aside = disc.xy * sqrt(max((1.0 - z) * (1.0 + z), 0.0) / disc.z);
  precise vec3 standard = vec3(alphas * (aside + wide.xy), max(z + wide.z, 0.0));
  vec3 local = normalize3(standard);
  precise vec3 h = local.x * across + (local.y * along + local.z * normal);
  return h;
}

// Returns a direction in which a lobe reflects light to the eye, by visible normals.
vec3 choose_from_lobe(vec3 normal, float alpha, vec3 to_eye, vec2 u) {
  vec3 across;
  vec3 along;
  make_frame(normal, across, along);
  vec3 h = choose_facet(across, along, normal, vec2(alpha), to_eye, u);
  precise vec3 direction = 2.0 * dot3(to_eye, h) * h - to_eye;
  return normalize3(direction);
}

#include "shade/sky_light.glsl"
#include "shade/emitters.glsl"

// Returns the point of sample_u of a light. A lobe that is narrower than a round light reflects an image of it,
// which light sampling alone would see in few samples of large weight. Half of the samples then choose a direction from
// the lobe. The strength is 1 / density of the mixture (Veach and Guibas, 1995: the balance heuristic), and 0 if the
// direction misses the light.
LightSample sample_light_or_lobe_at(ShadingPoint point, vec3 to_eye, LightRecord light, vec2 u) {
  if (!has(FEATURE_METALLIC_ROUGHNESS) || model_of(point) != MATERIAL_METALLIC_ROUGHNESS || !is_round(light)) {
    sample_u = u;
    return sample_light_at(light, point.position);
  }
  bool has_coat = is_coated(point);
  float roughness = has_coat ? point.coat.roughness : point.material.c.x;
  vec3 normal = has_coat ? point.coat.normal : point.normal;
  precise float alpha = max(roughness * roughness, LEAST_ALPHA);
  RoundLight seen = round_light(light, point.position);
  precise float alpha2 = alpha * alpha;
  bool is_mixed = alpha2 < seen.cap;
  bool is_of_lobe = is_mixed && u.x > 0.5;
  precise float x = is_mixed ? 2.0 * u.x - (is_of_lobe ? 1.0 : 0.0) : u.x;
  sample_u = vec2(x, u.y);
  ConeSample cone = sample_cone(seen.axis, seen.cap);
  if (is_of_lobe) {
    cone.direction = choose_from_lobe(normal, alpha, to_eye, sample_u);
    precise vec3 apart = cone.direction - seen.axis;
    precise float below = 0.5 * dot3(apart, apart);
    cone.below = below;
  }
  LightSample sampled = point_of_round(light, seen, cone);
  if (is_mixed) {
    precise float share = 6.28318531 * seen.cap * density_of_lobe(normal, alpha, to_eye, cone.direction);
    precise float strength = sampled.strength * 2.0 / (1.0 + share);
    sampled.strength = cone.below <= seen.cap ? strength : 0.0;
  }
  return sampled;
}

// Sets the light of an element. It is an out parameter and not returned, because glslang 12 never ends if a cycle passes
// through the result of a call (propagateNoContraction.cpp): the element comes from the source that it replaces.
void take_light(uint index, out LightRecord light) { light = load_light(VIEW.first_index.y + index); }

// Returns a point of a source as sample_light() does. If the source is the environment or has emissive surfaces, its
// powers are set to the radiance of the direction. If it is one of many lights, it becomes this light.
LightSample sample_light_or_lobe(ShadingPoint point, vec3 to_eye, inout LightRecord light) {
  if (has(FEATURE_SKY_LIGHT)) {
    lobe_share = 1.0;
    coat_share = 1.0;
    if (is_of_sky(light)) return sample_sky(point, to_eye, light);
  }
  if (TABLE_FEATURES != 0u) {
    uvec2 bits = sample_pair_bits();
    vec2 u = unit_square_point(bits);
    float chance = 1.0;
    if (ARE_LAMPS_RECTANGLES && has_table(light)) {
      // The rest of a lobe is that of the mirror ray.
      sky_shares(point);
      return sample_rectangle_source(light, bits, point.position);
    }
    if (!ARE_LAMPS_RECTANGLES && has_table(light)) {
      Emitter emitter = choose_emitter(light, bits, u);
      bool is_light = has(FEATURE_CHOSEN_LIGHTS) && emitter.part == EMITTER_IS_LIGHT;
      if (has(FEATURE_EMITTERS) && !is_light) {
        // The rest of a lobe is that of the mirror ray.
        sky_shares(point);
        return sample_emitter(emitter, u, point.position, point.geometric_normal, light);
      }
      take_light(emitter.index, light);
      chance = emitter.chance;
    }
    LightSample sampled = sample_light_or_lobe_at(point, to_eye, light, u);
    precise float strength = sampled.strength / chance;
    sampled.strength = strength;
    return sampled;
  }
  return sample_light_or_lobe_at(point, to_eye, light, sample_pair_point());
}

// With FEATURE_SAMPLED_LIGHT, returns the shadow ray to the chosen point of a light. For a light without size it has
// the same bits as shadow_ray(origin, light).
Ray sampled_shadow_ray(ShadingPoint point, vec3 origin, LightRecord light, LightSample sampled) {
  precise vec3 to_point = sampled.direction + (point.position - origin);
  precise vec3 to_place = light.position.xyz - origin;
  bool has_size = is_round(light) || (FLAT_KINDS != 0u && is_flat(light)) || has_table(light);
  vec3 to_source = has_size ? to_point : to_place;
  return make_ray(origin, sampled.tmax < INFINITY ? to_source : sampled.direction, 0.0, sampled.tmax);
}

Ray shadow_ray(ShadingPoint point, LightRecord light, LightSample sampled) {
  if (has(FEATURE_SAMPLED_LIGHT)) {
    bool is_behind = has(FEATURE_DIFFUSE_TRANSMISSION) && lies_behind(point, sampled.direction);
    vec3 origin = is_behind ? shadow_origin_behind(point) : shadow_origin(point);
    return sampled_shadow_ray(point, origin, light, sampled);
  }
  if (has(FEATURE_DIFFUSE_TRANSMISSION) && lies_behind(point, sampled.direction)) {
    return shadow_ray(shadow_origin_behind(point), light);
  }
  return shadow_ray(shadow_origin(point), light);
}
