// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The path of light along a shadow ray, straight through surfaces that blend and through glass (docs/model.md,
// "Glass"), the nearest surface first, so that the product does not depend on the tree.

struct LightWay {
  vec3 arriving;  // the fraction of the source's light that remains so far
  // The following members need FEATURE_GLASS:
  uvec2 media;  // the media that contain the ray
  float t;      // the t that the ray has reached
};

LightWay light_way(uvec2 media) { return LightWay(vec3(1.0), media, 0.0); }

// Applies the absorption of the ray's current medium up to t.
void absorb_until(inout LightWay way, Ray ray, float t) {
  precise float length = (t - way.t) * length3(ray.direction);
  precise vec3 arriving = way.arriving * left_after(last_entered(way.media), length);
  way.arriving = arriving;
  way.t = t;
}

vec3 tint_at_hit(Hit hit, Primitive p, SurfaceRecord surface, MaterialRecord material) {
  precise vec3 tint = material.a.xyz * texel_at_hit(slot_number(material.cover.z), hit, p, surface).xyz;
  uvec4 corners = surface.corners_material;
  if (has(FEATURE_VERTEX_COLORS) && (corners.w & SURFACE_IS_COLORED) != 0u) {
    precise vec3 weights = vec3(1.0 - hit.u - hit.v, hit.u, hit.v);
    tint *= load_vertex_color(corners.xyz, weights).xyz;
  }
  return min(tint, vec3(1.0));
}

// Returns the fraction of the light that a face transmits, and the media behind it. Shadow rays run straight, so each
// face is treated as if the ray came from its thinner side; there is then no total reflection.
vec3 share_through(Hit hit, Ray ray, SurfaceRecord surface, MaterialRecord material, inout uvec2 media) {
  Primitive p = load_primitive_of(hit.primitive, hit.part);
  GlassRecord record = load_glass(glass_number(material));
  bool is_thin = (record.bits.x & GLASS_IS_THIN) != 0u;
  vec3 normal = surface_point(ray, p, hit).normal;
  float along = dot3(normal, normalize3(ray.direction));
  float cosine = min(abs(along), 1.0);
  Face face;
  make_face(glass_number(material), is_thin, along > 0.0, media, GREEN, face);
  media = face.beyond;
  Face outside = Face(min(face.from, face.to), max(face.from, face.to), face.beyond);
  if (has(FEATURE_PHONG) && (flags_of(material) & MATERIAL_MODEL_MASK) == MATERIAL_PHONG) {
    if (!has(FEATURE_FRESNEL) || (record.bits.x & GLASS_IS_FRESNEL) == 0u) return record.transmission.xyz;
    float beyond = sqrt(max(cosine2_beyond(outside, cosine), 0.0));
    precise vec3 left = record.transmission.xyz * (1.0 - fresnel_reflectance(outside, max(cosine, SMALLEST_NORMAL), beyond));
    return left;
  }
  precise vec3 f0 = min(record.reflectance.xyz * normal_reflectance(face), vec3(1.0));
  precise vec3 reflected = f0 + (material.b.w - f0) * schlick_weight(cosine);
  if (face.from == face.to) reflected = vec3(0.0);
  vec3 tint = tint_at_hit(hit, p, surface, material);
  precise float metallic = material.a.w * texel_at_hit(slot_number(material.d.y), hit, p, surface).z;
  precise float transmission = record.transmission.x * texel_at_hit(record.bits.y, hit, p, surface).x;
  precise float share =
      (1.0 - metallic) * transmission * (1.0 - max(reflected.x, max(reflected.y, reflected.z)));
  precise vec3 left = share * (is_thin ? tint : sqrt(tint));
  return left;
}

// Continues a shadow ray behind a hit. `layers` is the number of hits before it. Returns whether any light remains.
bool goes_on_behind(inout LightWay way, Ray ray, Hit hit, uint layers) {
  if (!has(FEATURE_GLASS)) {
    way.arriving = vec3(share_behind(hit, ray.direction, way.arriving.x, layers));
    return way.arriving.x > 0.0;
  }
  SurfaceRecord surface = load_surface_of(hit.primitive, hit.part);
  MaterialRecord material = material_of(surface);
  absorb_until(way, ray, hit.t);
  float coverage = coverage_of_hit(hit, ray.direction);
  precise vec3 left = vec3(1.0 - coverage);
  if (is_clear(material) && coverage > 0.0) left += coverage * share_through(hit, ray, surface, material, way.media);
  precise vec3 arriving = layers < MOST_LAYERS ? way.arriving * left : vec3(0.0);
  way.arriving = max_abs(arriving) >= LEAST_SHARE_BEHIND ? arriving : vec3(0.0);
  return max_abs(way.arriving) > 0.0;
}

// Applies the absorption between the last surface and the light source.
void end_way(inout LightWay way, Ray ray) {
  if (has(FEATURE_GLASS) && ray.tmax < INFINITY && max_abs(way.arriving) > 0.0) absorb_until(way, ray, ray.tmax);
}
