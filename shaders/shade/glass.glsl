// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Glass (docs/model.md, "Glass"): the media that contain a ray, reflection and transmission at a face of glass, and the
// light along shadow rays.

uint glass_number(MaterialRecord material) { return flags_of(material) >> MATERIAL_GLASS_SHIFT; }

// Returns whether the material transmits light.
bool is_clear(MaterialRecord material) {
  if (!has(FEATURE_GLASS) || glass_number(material) == 0u) return false;
  return (load_glass(glass_number(material)).bits.x & GLASS_IS_CLEAR) != 0u;
}

// The media that contain a ray, as the numbers of their glasses in 16 bits each. The medium that was entered last comes
// first, in the lower half of x. If there are more than four media, the one that was entered first is dropped.
const uint NO_MEDIUM = 0u;
uint last_entered(uvec2 media) { return media.x & 0xFFFFu; }
uvec2 enter(uvec2 media, uint medium) { return uvec2(media.x << 16 | medium, media.y << 16 | media.x >> 16); }
bool is_within(uvec2 media, uint medium) {
  uvec2 lower = media & 0xFFFFu;
  uvec2 upper = media >> 16;
  return any(equal(lower, uvec2(medium))) || any(equal(upper, uvec2(medium)));
}
// Returns the media without the last occurrence of this medium.
uvec2 leave(uvec2 media, uint medium) {
  uvec2 lower = media & 0xFFFFu;
  uvec2 upper = media >> 16;
  if (lower.x == medium) return uvec2(upper.x | lower.y << 16, upper.y);
  if (upper.x == medium) return uvec2(lower.x | lower.y << 16, upper.y);
  if (lower.y == medium) return uvec2(media.x, upper.y);
  if (upper.y == medium) return uvec2(media.x, lower.y);
  return media;
}

// The colours of light that dispersion separates. Light that is not separated is refracted like green.
const uint RED = 0u;
const uint GREEN = 1u;
const uint BLUE = 2u;

uint count_colors(vec3 weight) { return uint(weight.x > 0.0) + uint(weight.y > 0.0) + uint(weight.z > 0.0); }

// Returns the colour whose index of refraction applies to light of this weight: its own colour if it has only one.
uint color_of(vec3 weight) {
  if (!has(FEATURE_DISPERSION) || count_colors(weight) != 1u) return GREEN;
  return weight.x > 0.0 ? RED : (weight.y > 0.0 ? GREEN : BLUE);
}

float index_of(uint medium, uint color) {
  if (medium == NO_MEDIUM) return 1.0;
  GlassRecord record = load_glass(medium);
  if (!has(FEATURE_DISPERSION) || color == GREEN) return record.transmission.w;
  precise float index = record.transmission.w + (color == RED ? -record.reflectance.w : record.reflectance.w);
  return index;
}

// Returns the fraction of the light that remains after this distance in a medium (Beer and Lambert).
vec3 left_after(uint medium, float way) {
  if (medium == NO_MEDIUM) return vec3(1.0);
  vec3 absorption = load_glass(medium).absorption.xyz;
  precise vec3 exponent = -absorption * way;
  // If the absorption is 0, the result is 1 for every distance, even an infinite one.
  return vec3(absorption.x > 0.0 ? power_of_two(exponent.x) : 1.0, absorption.y > 0.0 ? power_of_two(exponent.y) : 1.0,
              absorption.z > 0.0 ? power_of_two(exponent.z) : 1.0);
}

// A face between two media: the indices of refraction on the ray's side and on the other side, and the media on the
// other side.
struct Face {
  float from;
  float to;
  uvec2 beyond;
};

// Makes the face of a medium. Where solids overlap, the solid that was entered last counts; faces of other solids
// inside it do not bend rays (Schmidt and Budge, "Simple Nested Dielectrics in Ray Traced Images", JGT 7(2)). If a ray
// leaves a solid that it has not entered, the solid contains the camera or is a mesh that is not closed.
void make_face(uint medium, bool is_thin, bool leaves, uvec2 media, uint color, out Face face) {
  float outside = index_of(last_entered(media), color);
  float inside = index_of(medium, color);
  face.from = outside;
  face.to = outside;
  face.beyond = media;
  if (is_thin) {
    face.to = inside;
  } else if (!leaves) {
    face.to = inside;
    face.beyond = enter(media, medium);
  } else {
    face.beyond = leave(media, medium);
    bool is_last = last_entered(media) == medium;
    if (is_last || !is_within(media, medium)) {
      face.from = inside;
      face.to = is_last ? index_of(last_entered(face.beyond), color) : outside;
    }
  }
}

// Returns the squared cosine beyond the face, 1 - sine^2, for a ray that hits the face at an angle with this cosine. It
// is not positive on total reflection.
float cosine2_beyond(Face face, float cosine) {
  precise float ratio = face.from / face.to;
  precise float k = 1.0 - ratio * ratio * ((1.0 - cosine) * (1.0 + cosine));
  return k;
}

// Returns Schlick's weight for the cosine on the thinner side.
float schlick_weight(float cosine) {
  precise float p = clamp(1.0 - cosine, 0.0, 1.0);
  precise float p2 = p * p;
  precise float p5 = p2 * p2 * p;
  return p5;
}

// Returns Fresnel's reflectance of a dielectric for unpolarised light. The arguments are the cosines on both sides.
float fresnel_reflectance(Face face, float cosine, float cosine_beyond) {
  precise float s_from = face.from * cosine;
  precise float s_to = face.to * cosine_beyond;
  precise float p_from = face.from * cosine_beyond;
  precise float p_to = face.to * cosine;
  precise float s = (s_from - s_to) / (s_from + s_to);
  precise float p = (p_from - p_to) / (p_from + p_to);
  precise float mean = 0.5 * (s * s + p * p);
  return mean;
}

// Returns the factor of the reflectance at normal incidence that depends on the surrounding medium and is not in the
// record of a glass: ((n2 - n1) / (n2 + n1))^2.
float normal_reflectance(Face face) {
  precise float slope = (face.to - face.from) / (face.to + face.from);
  precise float square = slope * slope;
  return square;
}
