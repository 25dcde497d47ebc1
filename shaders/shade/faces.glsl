// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Reflection and refraction at faces of glass, and at mirrors that depend on the angle (docs/model.md, "Glass").

// Sets the glass of the material without its texture.
void put_bare_glass(inout ShadingPoint point, vec3 direction, uvec2 media, uint object) {
  Glass glass = Glass(vec3(0.0), vec3(0.0), direction, media, 1.0, NO_ENVIRONMENT, 0.0, object);
  uint number = glass_number(point.material);
  if (number != 0u && model_of(point) == MATERIAL_METALLIC_ROUGHNESS) glass.share = load_glass(number).transmission.x;
  point.glass = glass;
}

// Refracts the ray at a surface with this normal. Returns false on total reflection.
bool refract_about(vec3 normal, vec3 direction, Face face, out vec3 refracted) {
  float cosine = min(-dot3(normal, direction), 1.0);
  float k = cosine2_beyond(face, cosine);
  precise float ratio = face.from / face.to;
  precise vec3 sum = ratio * direction + (ratio * cosine - sqrt(max(k, 0.0))) * normal;
  refracted = normalize3(sum);
  return k > 0.0;
}

// Refracts the ray at a surface with the point's normal. If an interpolated normal would keep the ray on this side,
// uses the surface's own normal. Returns false on total reflection.
bool refract_at(ShadingPoint point, vec3 direction, Face face, out vec3 refracted) {
  // An interpolated normal may point away from the eye.
  vec3 normal = dot3(point.normal, direction) < 0.0 ? point.normal : point.geometric_normal;
  bool goes_on = refract_about(normal, direction, face, refracted);
  if (goes_on && dot3(refracted, point.geometric_normal) >= 0.0) {
    goes_on = refract_about(point.geometric_normal, direction, face, refracted);
  }
  return goes_on;
}

// Computes the refracted ray, and the fractions of light that a Phong material reflects and transmits. `hangs_on_angle`
// is true if Fresnel's formulas determine them; `reflected` is then the reflected fraction.
void meet_phong(inout ShadingPoint point, GlassRecord record, bool lets_through, bool is_total, float reflected) {
  Glass glass = point.glass;
  bool hangs_on_angle = has(FEATURE_FRESNEL) && (record.bits.x & GLASS_IS_FRESNEL) != 0u;
  precise vec3 mirror = (hangs_on_angle ? reflected : 1.0) * glass.mirror;
  // On total reflection, the mirror ray also gets the weight of the transmitted light.
  if (lets_through && !hangs_on_angle && is_total) mirror += record.transmission.xyz;
  precise vec3 through = (hangs_on_angle ? 1.0 - reflected : 1.0) * record.transmission.xyz;
  glass.mirror = mirror;
  glass.through = lets_through && !is_total ? through : vec3(0.0);
  point.glass = glass;
}

// Sets the reflectance of a metallic-roughness material in its surrounding medium.
void meet_metallic_roughness(inout ShadingPoint point, GlassRecord record, bool is_total, Face face) {
  MaterialRecord material = point.material;
  Glass glass = point.glass;
  if (is_total) {
    material.b = vec4(1.0);
    glass.share = 0.0;
  } else if (face.from == face.to) {
    material.b = vec4(0.0);
  } else {
    // The material's own values are for air.
    float in_air = normal_reflectance(Face(1.0, record.transmission.w, face.beyond));
    precise vec3 reflectance = in_air > 0.0 ? material.b.xyz * (normal_reflectance(face) / in_air)
                                            : record.reflectance.xyz * normal_reflectance(face);
    material.b = vec4(min(reflectance, vec3(1.0)), material.b.w);
  }
  point.material = material;
  point.glass = glass;
}

// Sets the face of the point. Returns the cosine of the angle on the face's thinner side, which a lobe uses.
float meet_face(inout ShadingPoint point, vec3 direction, uvec2 media, uint color, bool leaves) {
  float seen = -dot3(point.normal, direction);
  Glass glass = point.glass;
  // At this point of the code, the mirror's weight includes the values of textures.
  glass.mirror = point.material.d.xyz;
  point.glass = glass;
  uint number = glass_number(point.material);
  if (number == 0u) return seen;
  GlassRecord record = load_glass(number);
  bool lets_through = has(FEATURE_GLASS) && (record.bits.x & GLASS_IS_CLEAR) != 0u;
  bool is_thin = (record.bits.x & GLASS_IS_THIN) != 0u;
  Face face;
  make_face(number, is_thin || !lets_through, lets_through && leaves, media, color, face);
  // After a diffuse surface, rays run straight through glass, like shadow rays.
  bool bends = face.from != face.to;
  if (has(FEATURE_SCATTERING)) {
    bool is_straight = least_roughness > 0.0;
    bends = bends && !is_straight;
    float from = is_straight ? min(face.from, face.to) : face.from;
    face.to = is_straight ? max(face.from, face.to) : face.to;
    face.from = from;
  }
  vec3 normal = seen > 0.0 ? point.normal : point.geometric_normal;
  float cosine = clamp(-dot3(normal, direction), SMALLEST_NORMAL, 1.0);
  float k = cosine2_beyond(face, cosine);
  float beyond = sqrt(max(k, 0.0));
  bool is_total = !(k > 0.0);
  bool is_bent = lets_through && !is_thin && bends;
  if (is_bent) {
    vec3 refracted;
    is_total = !refract_at(point, direction, face, refracted);
    precise float bend = face.from / face.to;
    glass.bend = bend;
    glass.direction = refracted;
  }
  glass.beyond = face.beyond;
  if (model_of(point) == MATERIAL_METALLIC_ROUGHNESS) {
    precise float blur = is_thin ? clamp(2.0 * record.transmission.w - 2.0, 0.0, 1.0) * point.material.c.x
                                 : point.material.c.x;
    glass.roughness = is_bent || blur > 0.0 ? blur : NO_ENVIRONMENT;
  } else if (is_bent) {
    glass.roughness = perfect_mirror_roughness();
  }
  point.glass = glass;
  if (has(FEATURE_PHONG) && model_of(point) == MATERIAL_PHONG) {
    meet_phong(point, record, lets_through, is_total, is_total ? 1.0 : fresnel_reflectance(face, cosine, beyond));
    return seen;
  }
  if (lets_through) meet_metallic_roughness(point, record, is_total, face);
  if (!is_bent) return seen;
  return face.from <= face.to ? cosine : beyond;
}

// Sets the transmitted fraction for a metallic-roughness material: the light that is not reflected, multiplied by the
// base colour (at each of the two faces of a volume by its square root). A coat and a sheen lie above it.
void let_through(inout ShadingPoint point) {
  uint number = glass_number(point.material);
  if (model_of(point) != MATERIAL_METALLIC_ROUGHNESS || number == 0u) return;
  Glass glass = point.glass;
  bool is_thin = (load_glass(number).bits.x & GLASS_IS_THIN) != 0u;
  Lobe lobe = dielectric_lobe(point);
  vec3 base = base_color_of(point);
  precise float share =
      (1.0 - point.material.a.w) * glass.share * (1.0 - max(lobe.r.x, max(lobe.r.y, lobe.r.z)));
  if (has(FEATURE_SHEENS)) share *= left_below_sheen(point.sheen, point.sheen.share);
  if (has(FEATURE_COATS)) share *= 1.0 - point.coat.weight;
  precise vec3 through = share * (is_thin ? base : sqrt(base));
  glass.through = through;
  point.glass = glass;
}
