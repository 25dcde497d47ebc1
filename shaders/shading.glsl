// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Shading (docs/model.md, "Light") of a point that a ray hit.

// A clear coat as the eye sees it (KHR_materials_clearcoat): what it reflects covers `weight` of all that is below.
struct Coat {
  float weight;
  float roughness;
  float share;  // of light from all around, what it would reflect if it covered all
  vec3 normal;  // without the normals of the material below
};

// A sheen as the eye sees it (KHR_materials_sheen).
struct Sheen {
  vec3 color;
  float roughness;
  float share;  // of light from all around, what it sends were its colour 1; what is above 1 is not sent
};

// The data of a hit that the light loop and the mirror ray need.
struct ShadingPoint {
  vec3 position;
  vec3 geometric_normal;  // unit; faces the incoming ray
  vec3 normal;            // the interpolated normal or the geometric one; faces the incoming ray
  float lift;
  vec3 shadow_position;  // origin of shadow rays, before the lift
  vec3 color;            // vertex colour
  MaterialRecord material;
  vec2 lobe_shares;  // with FEATURE_METALLIC_ROUGHNESS
  float occlusion;   // with FEATURE_TEXTURES: what is left of the environment's light
  float curvature;   // with FEATURE_TEXTURES: how fast the normal turns along the surface
  Coat coat;         // with FEATURE_COATS
  Sheen sheen;       // with FEATURE_SHEENS
};

#include "materials.glsl"
#include "textures.glsl"
#include "cutouts.glsl"

// Whether materials may have layers above them, and what of them else few have (ExtensionRecord).
const bool HAS_LAYERS = (FEATURE_BIT(FEATURE_COATS) | FEATURE_BIT(FEATURE_SHEENS)) != 0u;
const bool HAS_EXTENSIONS = HAS_LAYERS || has(FEATURE_SPECULAR_TEXTURES);

bool is_extended(MaterialRecord material) { return slot_number(material.d.x) != 0u; }
ExtensionRecord extension_of(MaterialRecord material) {
  return load_extension(VIEW.first_lookup.w + slot_number(material.d.x) - 1u);
}

// Lifts the point onto the curved surface that the vertex normals suggest, so that its own coarse polygon does not
// shadow what is shaded as lit (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II ch. 4).
vec3 lift_to_curve(vec3 position, vec3 corner, vec3 normal) {
  precise float height = min(0.0, dot3(position - corner, normal));
  precise vec3 projected = position - height * normal;
  return projected;
}

// How fast the normals turn along the triangle's edges, per distance; positive where it is convex.
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

void apply_vertex_normals(inout ShadingPoint point, Primitive p, uvec3 corners, vec3 weights, bool is_flipped) {
  vec3 n0 = load_vertex(VIEW.first_index.z + corners.x);
  vec3 n1 = load_vertex(VIEW.first_index.z + corners.y);
  vec3 n2 = load_vertex(VIEW.first_index.z + corners.z);
  // The side of the geometric normal decides which way the interpolated normal faces, so the sign of the latter stays
  // as wound.
  float side = is_flipped ? -1.0 : 1.0;
  precise vec3 interpolated = (weights.x * n0 + weights.y * n1 + weights.z * n2) * side;
  vec3 normal = normalize3(interpolated);
  if (max_abs(normal) == 0.0) return;
  point.normal = normal;
  precise vec3 lifted = weights.x * lift_to_curve(point.position, corner0(p), n0 * side) +
                        weights.y * lift_to_curve(point.position, corner1(p), n1 * side) +
                        weights.z * lift_to_curve(point.position, corner2(p), n2 * side);
  point.shadow_position = lifted;
  if (has(FEATURE_TEXTURES)) {
    precise float curvature = side * curvature_of(p, n0, n1, n2);
    point.curvature = curvature;
  }
}

// The normal, turned by a texture of normals: `tangent` and its bitangent span the plane that the texture is painted on.
vec3 turned_normal(vec3 normal, vec3 texel, float scale, vec4 tangent, float side, vec3 direction) {
  precise vec2 scaled = (2.0 * texel.xy - 1.0) * scale;
  precise float z = 2.0 * texel.z - 1.0;
  // On the back of a surface all three axes turn.
  precise vec3 t = tangent.xyz * side;
  precise vec3 along = t - dot3(t, normal) * normal;
  vec3 axis = normalize3(along);
  precise vec3 across = tangent.w * side * cross3(normal, axis);
  precise vec3 sum = scaled.x * axis + scaled.y * across + z * normal;
  vec3 turned = normalize3(sum);
  if (max_abs(axis) == 0.0 || max_abs(turned) == 0.0) return normal;
  // Where it is turned away from the eye it is bent back until it is seen edge-on.
  precise float cosine = -dot3(turned, direction);
  precise vec3 bent = turned - (LEAST_COSINE - cosine) * direction;
  return cosine < LEAST_COSINE ? normalize3(bent) : turned;
}

// The tangent of the triangle's own texture coordinates, where the mesh has none for its vertices.
vec4 tangent_of(Primitive p, vec2 a, vec2 b, vec2 c) {
  precise vec3 e1 = corner1(p) - corner0(p);
  precise vec3 e2 = corner2(p) - corner0(p);
  precise vec2 d1 = b - a;
  precise vec2 d2 = c - a;
  precise float area = d1.x * d2.y - d1.y * d2.x;
  float sign_of_area = area < 0.0 ? -1.0 : 1.0;
  precise vec3 tangent = sign_of_area * (d2.y * e1 - d1.y * e2);
  // Images have their first row at v = 0, so the bitangent goes up as v goes down.
  return vec4(normalize3(tangent), -sign_of_area);
}

// Where the mesh has tangents they are interpolated, else they are the triangle's own.
vec4 tangent_at(uvec4 corners, vec3 weights, Primitive p, CornerUvs uvs, uint slot) {
  if ((corners.w & SURFACE_HAS_TANGENTS) != 0u) {
    precise vec4 sum = weights.x * load_vertex4(VIEW.first_texture.y + corners.x) +
                       weights.y * load_vertex4(VIEW.first_texture.y + corners.y) +
                       weights.z * load_vertex4(VIEW.first_texture.y + corners.z);
    return vec4(sum.xyz, sum.w < 0.0 ? -1.0 : 1.0);
  }
  bool is_second = has_flag(load_slot(slot), TEXTURE_UV_SET);
  return is_second ? tangent_of(p, uvs.a.zw, uvs.b.zw, uvs.c.zw) : tangent_of(p, uvs.a.xy, uvs.b.xy, uvs.c.xy);
}

// The coat's textures: its factors, and its normal.
void apply_coat_textures(inout Coat coat, ExtensionRecord record, Primitive p, uvec4 corners, vec3 weights,
                         CornerUvs uvs, TexturePlace place, bool is_flipped, vec3 direction) {
  uvec4 slots = record.coat_slots;
  if (slots.x != 0u) {
    precise float weight = coat.weight * look_up(slots.x, place).x;
    coat.weight = weight;
  }
  if (slots.y != 0u) {
    precise float roughness = coat.roughness * look_up(slots.y, place).y;
    coat.roughness = roughness;
  }
  if (slots.z != 0u) {
    coat.normal =
        turned_normal(coat.normal, look_up(slots.z, place).xyz, record.coat.z,
                      tangent_at(corners, weights, p, uvs, slots.z), is_flipped ? -1.0 : 1.0, direction);
  }
}

void apply_sheen_textures(inout Sheen sheen, ExtensionRecord record, TexturePlace place) {
  if (record.slots.x != 0u) {
    precise vec3 color = sheen.color * look_up(record.slots.x, place).xyz;
    sheen.color = color;
  }
  if (record.slots.y != 0u) {
    precise float roughness = sheen.roughness * look_up(record.slots.y, place).w;
    sheen.roughness = roughness;
  }
}

// KHR_materials_specular: the dielectric's reflectance at normal and at grazing incidence.
vec4 textured_reflectance(ExtensionRecord record, TexturePlace place) {
  precise vec3 at_normal = record.reflectance.xyz;
  precise float factor = record.reflectance.w;
  if (record.slots.w != 0u) at_normal *= look_up(record.slots.w, place).xyz;
  if (record.slots.z != 0u) factor *= look_up(record.slots.z, place).w;
  precise vec3 reduced = min(at_normal, vec3(1.0)) * factor;
  return vec4(reduced, factor);
}

void apply_textures(inout ShadingPoint point, Primitive p, uvec4 corners, vec3 weights, vec3 wound_normal,
                    bool is_flipped, vec3 direction, float cone_width) {
  CornerUvs uvs = load_corner_uvs(corners.xyz);
  TexturePlace place = texture_place(p, uvs, weights, dot3(wound_normal, direction), cone_width);
  // Nested members are not written to one by one: glslang dies over that.
  MaterialRecord material = point.material;
  bool is_phong = has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG;
  bool is_metallic_roughness = has(FEATURE_METALLIC_ROUGHNESS) && model_of(point) == MATERIAL_METALLIC_ROUGHNESS;
  uint base = slot_number(material.cover.z);
  if (base != 0u) {
    vec4 texel = look_up(base, place);
    precise vec3 color = material.a.xyz * texel.xyz;
    material.a = vec4(color, material.a.w);
    precise float alpha = material.cover.x * texel.w;
    material.cover = vec4(alpha, material.cover.yzw);
    if (is_phong) {
      precise vec3 diffuse = material.b.xyz * texel.xyz;
      material.b = vec4(diffuse, material.b.w);
    }
  }
  uint emissive = slot_number(material.cover.w);
  if (emissive != 0u) {
    precise vec3 color = material.emissive.xyz * look_up(emissive, place).xyz;
    material.emissive = vec4(color, material.emissive.w);
  }
  if (is_phong) {
    uint specular = slot_number(material.d.w);
    if (specular != 0u) {
      vec3 factors = look_up(specular, place).xyz;
      precise vec3 color = material.c.xyz * factors;
      precise vec3 reflection = material.d.xyz * factors;
      material.c = vec4(color, material.c.w);
      material.d = vec4(reflection, material.d.w);
    }
  }
  if (is_metallic_roughness) {
    uint metallic_roughness = slot_number(material.d.y);
    if (metallic_roughness != 0u) {
      precise vec2 factors = vec2(material.c.x, material.a.w) * look_up(metallic_roughness, place).yz;
      material.c = vec4(factors.x, material.c.yzw);
      material.a = vec4(material.a.xyz, factors.y);
    }
    uint occlusion = slot_number(material.d.w);
    if (occlusion != 0u) {
      precise float left = 1.0 + material.c.z * (look_up(occlusion, place).x - 1.0);
      point.occlusion = left;
    }
  }
  uint normal = slot_number(is_phong ? material.b.w : material.d.z);
  if ((is_phong || is_metallic_roughness) && normal != 0u) {
    vec4 tangent = tangent_at(corners, weights, p, uvs, normal);
    point.normal = turned_normal(point.normal, look_up(normal, place).xyz, is_phong ? 1.0 : material.c.y, tangent,
                                 is_flipped ? -1.0 : 1.0, direction);
  }
  if (HAS_EXTENSIONS && is_metallic_roughness && is_extended(material)) {
    ExtensionRecord record = extension_of(material);
    if (has(FEATURE_COATS)) {
      Coat coat = point.coat;
      apply_coat_textures(coat, record, p, corners, weights, uvs, place, is_flipped, direction);
      point.coat = coat;
    }
    if (has(FEATURE_SHEENS)) {
      Sheen sheen = point.sheen;
      apply_sheen_textures(sheen, record, place);
      point.sheen = sheen;
    }
    if (has(FEATURE_SPECULAR_TEXTURES) && (record.slots.z | record.slots.w) != 0u) {
      material.b = textured_reflectance(record, place);
    }
  }
  point.material = material;
}

// Coat and sheen as the material has them, without their textures; the coat's weight is how much of it there is.
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

// What the eye sees of the coat: Schlick's factor of an index of refraction of 1.5.
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

// `direction` is the ray's, unit; `cone_width` is how wide the cone of its pixel is at the hit. The point is not returned
// but written to: of a call that is assigned glslang 12 to 15 spread `precise` from the struct's eighth member to the
// eighth of every argument, and crash where one of these is built from fewer (propagateNoContraction.cpp).
void make_shading_point(Ray ray, vec3 direction, Hit hit, float cone_width, out ShadingPoint point) {
  Primitive p = load_primitive(hit.primitive);
  SurfaceRecord record = load_surface(hit.primitive);
  SurfacePoint surface = surface_point(ray, p, hit);
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
  if (has(FEATURE_TEXTURES) && (record.corners_material.w & SURFACE_HAS_UVS) != 0u) {
    apply_textures(point, p, record.corners_material, weights, surface.normal, is_flipped, direction, cone_width);
  }
  if (has(FEATURE_METALLIC_ROUGHNESS)) {
    point.lobe_shares = load_lobe_shares(-dot3(point.normal, direction), point.material.c.x);
  }
  if (has(FEATURE_COATS)) point.coat = seen_coat(point.coat, direction);
  if (has(FEATURE_SHEENS)) point.sheen = seen_sheen(point.sheen, -dot3(point.normal, direction));
  if (has(FEATURE_RAY_LOG)) {
    log_surface(point.position, point.lift, surface.normal, point.normal,
                record.corners_material.w & SURFACE_MATERIAL_MASK);
  }
}

// What a source adds where nothing is between.
vec3 unshadowed_contribution(ShadingPoint point, vec3 to_eye, LightRecord light, LightSample sampled) {
  vec3 to_light = normalize3(sampled.direction);
  precise float cosine = dot3(point.normal, to_light);
  // A coat has a normal of its own.
  bool is_lit = has(FEATURE_COATS) ? cosine > 0.0 || dot3(point.coat.normal, to_light) > 0.0 : cosine > 0.0;
  if (!(is_lit && sampled.strength > 0.0)) return vec3(0.0);

  precise vec3 contribution = contribution_of(point, to_eye, to_light, max(cosine, 0.0), light);
  contribution *= sampled.strength;
  return contribution;
}

Ray shadow_ray(ShadingPoint point, LightRecord light) {
  return shadow_ray(lift_off(point.shadow_position, point.geometric_normal, point.lift), light);
}
