// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The metallic-roughness model of glTF 2.0, appendix B (docs/model.md, "Metallic-roughness"). In its MaterialRecord, a
// holds the base colour and in w the weight of metal; b the dielectric's reflectance at normal incidence and in w at
// grazing incidence; c.x the roughness.

const float LEAST_COSINE = 0.0009765625;        // 2^-10, the smallest cosine to the eye
const float LEAST_HALF_VECTOR = 0.000244140625;  // 2^-12; below this, the light comes from behind, as seen from the eye
const float LEAST_ALPHA = 0.002;                 // the smallest alpha for highlights of sources, which would otherwise
                                                 // be points (glTF B.3.2 forbids 0)

#include "shade/sheen.glsl"
#include "shade/thin_film.glsl"
#include "shade/anisotropy.glsl"

// The range of roughness in which reflections of objects fade. Above it only the environment is reflected.
const float SHARPEST_BLUR = 0.1;
// The smallest weight of a mirror ray. Mirror rays with a smaller weight are not traced.
const float LEAST_MIRROR_WEIGHT = 1.0 / 256.0;

// Reflection by the lobe. K compensates for light that microfacets reflect more than once, R is the fraction of the
// light from all directions that is reflected to the eye (Fdez-Aguera, "A Multiple-Scattering Microfacet Model for
// Real-Time Image Based Lighting", JCGT 8(1)).
struct Lobe {
  vec3 f0;  // Fresnel's reflectance at normal and at grazing incidence
  float f90;
  vec3 k;
  vec3 r;
};

Lobe make_lobe(vec3 f0, float f90, vec2 shares) {
  precise vec3 mean = f0 + (f90 - f0) * (1.0 / 21.0);
  precise vec3 k = 1.0 / (1.0 - mean * (1.0 - shares.x));
  precise vec3 r = k * (f0 * (shares.x - shares.y) + f90 * shares.y);
  return Lobe(f0, f90, k, r);
}

vec3 base_color_of(ShadingPoint point) {
  precise vec3 base = point.material.a.xyz * point.color;
  return min(base, vec3(1.0));
}

Lobe dielectric_lobe(ShadingPoint point) {
  return make_lobe(point.material.b.xyz, point.material.b.w, point.lobe_shares);
}
Lobe metal_lobe(ShadingPoint point) {
  return make_lobe(has(FEATURE_IRIDESCENCE) ? point.thin_film.metal : base_color_of(point), 1.0, point.lobe_shares);
}

// Changes the reflectances of dielectric and metal to those under the film, at an angle with this cosine. A surface
// that reflects all light, such as glass beyond the critical angle, also does so under a film.
void put_film(inout ShadingPoint point, float cosine) {
  ThinFilm film = point.thin_film;
  vec3 metal = base_color_of(point);
  if (film.layer.x > 0.0) {
    MaterialRecord material = point.material;
    vec3 bare = material.b.xyz;
    bool is_total = min(material.b.w, min(bare.x, min(bare.y, bare.z))) >= 1.0;
    precise vec3 dielectric =
        bare + film.layer.x * (reflectance_under_film(film, bare, material.b.w, cosine) - bare);
    precise vec3 colored = metal + film.layer.x * (reflectance_under_film(film, metal, 1.0, cosine) - metal);
    material.b = is_total ? material.b : vec4(dielectric, material.b.w);
    point.material = material;
    metal = colored;
  }
  film.metal = metal;
  point.thin_film = film;
}

// Returns the fraction of the light that remains for the layers below a sheen. `share` is the fraction that the sheen
// reflects.
float left_below_sheen(Sheen sheen, float share) {
  precise float left = 1.0 - max_abs(sheen.color) * min(share, 1.0);
  return left;
}

// Returns the fraction of the light from all directions that the layers below the sheen reflect to the eye.
vec3 reflectance_of(ShadingPoint point) {
  float metallic = point.material.a.w;
  precise vec3 sum = (1.0 - metallic) * dielectric_lobe(point).r + metallic * metal_lobe(point).r;
  if (has(FEATURE_SHEENS)) sum *= left_below_sheen(point.sheen, point.sheen.share);
  return sum;
}

bool scatters_through(ShadingPoint point) { return point.scattering.w > 0.0; }

// Returns whether a light source in this direction lights the other side of the surface, through which it scatters
// light.
bool lies_behind(ShadingPoint point, vec3 to_light) {
  return scatters_through(point) && dot3(point.geometric_normal, to_light) < 0.0;
}

// Returns the diffuse albedo: the fraction of light that the dielectric does not reflect, times its colour.
vec3 albedo_of(ShadingPoint point) {
  Lobe lobe = dielectric_lobe(point);
  precise vec3 albedo =
      (1.0 - point.material.a.w) * (1.0 - max(lobe.r.x, max(lobe.r.y, lobe.r.z))) * base_color_of(point);
  if (has(FEATURE_GLASS)) albedo *= 1.0 - point.glass.share;
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) albedo *= 1.0 - point.scattering.w;
  return albedo;
}

// Returns the diffuse albedo for light from the other side (KHR_materials_diffuse_transmission).
vec3 albedo_from_behind(ShadingPoint point) {
  Lobe lobe = dielectric_lobe(point);
  precise vec3 albedo = (1.0 - point.material.a.w) * (1.0 - max(lobe.r.x, max(lobe.r.y, lobe.r.z))) *
                        point.scattering.w * point.scattering.xyz;
  if (has(FEATURE_GLASS)) albedo *= 1.0 - point.glass.share;
  return albedo;
}

// Returns the fraction of the reflection that comes from a mirror ray, for a surface of this roughness. The rest comes
// from the environment.
float sharpness_of(float roughness) {
  precise float x = clamp((roughness - SHARPEST_BLUR) * (1.0 / (ROUGHEST_MIRROR - SHARPEST_BLUR)), 0.0, 1.0);
  precise float sharpness = 1.0 - x * x * (3.0 - 2.0 * x);
  return sharpness;
}

bool is_coated(ShadingPoint point) { return has(FEATURE_COATS) && point.coat.weight > 0.0; }

// Returns the same fraction for the material without its coat. A hit has only one mirror ray; if there is a coat, it is
// the coat's. Layers under the coat with another normal reflect only the environment.
float sharpness_of(ShadingPoint point) {
  if (is_coated(point) && any(notEqual(point.normal, point.coat.normal))) return 0.0;
  return sharpness_of(point.material.c.x);
}

vec3 mirror_weight_metallic_roughness(ShadingPoint point) {
  precise vec3 weight = sharpness_of(point) * reflectance_of(point);
  if (is_coated(point)) {
    weight = (1.0 - point.coat.weight) * weight +
             point.coat.weight * point.coat.share * sharpness_of(point.coat.roughness);
  }
  return max_abs(weight) < LEAST_MIRROR_WEIGHT ? vec3(0.0) : weight;
}

// Returns the roughness of the coat or of the material, whichever is smoother. If only the coat has a mirror ray,
// returns the coat's roughness.
float mirror_roughness_metallic_roughness(ShadingPoint point) {
  if (!is_coated(point)) return point.material.c.x;
  bool is_one_normal = all(equal(point.normal, point.coat.normal));
  return is_one_normal ? min(point.material.c.x, point.coat.roughness) : point.coat.roughness;
}

vec3 mirror_normal_metallic_roughness(ShadingPoint point) {
  return is_coated(point) ? point.coat.normal : point.normal;
}

// Returns the direction from which a lobe receives most of its light. For rough lobes it is nearer to the normal.
vec3 direction_of_lobe(vec3 normal, vec3 geometric_normal, float roughness, vec3 direction) {
  vec3 mirrored = reflect_direction(direction, normal, geometric_normal);
  float alpha2 = roughness * roughness * roughness * roughness;
  precise vec3 leaning = mirrored + (normal - mirrored) * alpha2;
  return normalize3(leaning);
}

// Returns the fraction of the environment's reflection that own_light does not contain: the part of the mirror ray, if
// one follows. With FEATURE_SKY_LIGHT, the rest is the light of a source.
float share_elsewhere(float sharpness, bool follows_mirror) {
  precise float rest = 1.0 - sharpness;
  if (has(FEATURE_SKY_LIGHT)) return follows_mirror ? 1.0 : rest;
  return follows_mirror ? sharpness : 0.0;
}

// Returns the light of the environment that the coat reflects, without the part that its mirror ray contributes.
vec3 environment_in_coat(ShadingPoint point, vec3 direction, bool follows_mirror) {
  Coat coat = point.coat;
  vec3 around = environment_radiance(
      direction_of_lobe(coat.normal, point.geometric_normal, coat.roughness, direction), coat.roughness);
  float sharpness = share_elsewhere(sharpness_of(coat.roughness), follows_mirror);
  precise vec3 seen = coat.share * (1.0 - sharpness) * point.occlusion * around;
  return seen;
}

vec3 own_light_metallic_roughness(ShadingPoint point, vec3 direction, bool follows_mirror) {
  float sharpness = share_elsewhere(sharpness_of(point), follows_mirror);
  vec3 around = environment_radiance(
      direction_of_lobe(has(FEATURE_ANISOTROPY) ? point.anisotropy.bent_normal : point.normal, point.geometric_normal,
                        point.material.c.x, direction),
      point.material.c.x);
  vec3 reflectance = reflectance_of(point);
  vec3 ambient = ambient_at(point.normal);
  precise vec3 diffuse = albedo_of(point) * ambient;
  if (has(FEATURE_DIFFUSE_TRANSMISSION)) diffuse += albedo_from_behind(point) * ambient_at(-point.normal);
  if (has(FEATURE_SHEENS)) {
    diffuse = left_below_sheen(point.sheen, point.sheen.share) * diffuse +
              min(point.sheen.share, 1.0) * point.sheen.color * ambient;
  }
  precise vec3 own;
  if (has(FEATURE_TEXTURES)) {
    own = point.material.emissive.xyz + point.occlusion * (diffuse + (1.0 - sharpness) * reflectance * around);
  } else {
    own = point.material.emissive.xyz + diffuse + (1.0 - sharpness) * reflectance * around;
  }
  if (is_coated(point)) {
    vec3 in_coat = environment_in_coat(point, direction, follows_mirror);
    own = (1.0 - point.coat.weight) * own + point.coat.weight * in_coat;
  }
  return own;
}

vec3 emitted_light_metallic_roughness(ShadingPoint point) {
  precise vec3 emitted = point.material.emissive.xyz;
  if (is_coated(point)) emitted *= 1.0 - point.coat.weight;
  return emitted;
}

// Returns the microfacets' density D for the half vector h. It is computed as k^2 / pi, because 1 - (N.H)^2 loses all
// digits in a highlight, while |H - N| keeps them.
float density_of(vec3 normal, vec3 h, float alpha) {
  precise vec3 apart = h - normal;
  precise float q = dot3(apart, apart);
  precise float s2 = q * (1.0 - 0.25 * q);
  precise float k = alpha / (s2 + alpha * alpha * (1.0 - s2));
  precise float density = k * k * INVERSE_PI;
  return density;
}

// Returns Smith's height-correlated masking and shadowing divided by 4 (N.L) (N.V) (Heitz, "Understanding the
// Masking-Shadowing Function", JCGT 3(2)).
float visibility_of(float v, float l, float alpha) {
  precise float a2 = alpha * alpha;
  precise float v_part = l * sqrt(a2 + (1.0 - a2) * v * v);
  precise float l_part = v * sqrt(a2 + (1.0 - a2) * l * l);
  precise float visibility = 0.5 / (v_part + l_part);
  return visibility;
}

// Returns the fraction of a source's light that facets of this roughness reflect to the eye, without Fresnel's factor:
// D times V times N.L. h is the half vector.
float facet_scale(vec3 normal, float roughness, vec3 h, vec3 to_eye, float cosine) {
  float alpha = max(roughness * roughness, LEAST_ALPHA);
  float v = max(dot3(normal, to_eye), LEAST_COSINE);
  precise float scale = cosine * density_of(normal, h, alpha) * visibility_of(v, cosine, alpha);
  return scale;
}

// Returns a source's contribution with a sheen: the sheen's own light, and the light of the layers below, reduced by
// the sheen on the way in and on the way out. At grazing angles the sheen's curves would reflect more light than
// arrives; the whole sum is then divided by this excess. h is the half vector.
vec3 contribution_with_sheen(ShadingPoint point, vec3 h, vec3 to_eye, float cosine, LightRecord light, vec3 rest) {
  Sheen sheen = point.sheen;
  if (max_abs(sheen.color) == 0.0 || !(cosine > 0.0)) return rest;
  float share = max(sheen.share, load_sheen_share(cosine, sheen.roughness));
  precise float sent = sheen_of_source(point.normal, sheen.roughness, h, to_eye, cosine) / max(sheen.share, 1.0);
  precise vec3 all = left_below_sheen(sheen, share) * rest + sent * sheen.color * light.specular.xyz;
  return all;
}

// Returns the reflectance of facets whose normals have this cosine to the eye, with the light that is reflected more
// than once.
vec3 reflectance_of_facets(ShadingPoint point, float cosine) {
  precise float p = 1.0 - cosine;
  precise float p2 = p * p;
  precise float p5 = p2 * p2 * p;
  Lobe dielectric = dielectric_lobe(point);
  Lobe metal = metal_lobe(point);
  float metallic = point.material.a.w;
  precise vec3 reflected =
      (1.0 - metallic) * dielectric.k * (dielectric.f0 + (dielectric.f90 - dielectric.f0) * p5) +
      metallic * metal.k * (metal.f0 + (metal.f90 - metal.f0) * p5);
  return reflected;
}

// Returns a source's contribution to the layers under the coat, or to the whole material if it has no coat.
vec3 contribution_below_coat(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
  precise vec3 contribution = albedo_of(point) * INVERSE_PI * light.diffuse.xyz * cosine;
  precise vec3 sum = to_eye + to_light;
  float size = length3(sum);
  if (size < LEAST_HALF_VECTOR) return contribution;
  precise vec3 h = sum / size;
  vec3 reflected = reflectance_of_facets(point, min(0.5 * size, 1.0));
  float scale;
  if (has(FEATURE_ANISOTROPY) && point.anisotropy.alphas.x > 0.0) {
    scale = anisotropic_scale(point.normal, point.anisotropy, h, to_eye, to_light, cosine);
  } else {
    scale = facet_scale(point.normal, point.material.c.x, h, to_eye, cosine);
  }
  if (has(FEATURE_SKY_LIGHT)) reflected *= lobe_share;
  contribution += reflected * light.specular.xyz * scale;
  if (has(FEATURE_SHEENS)) contribution = contribution_with_sheen(point, h, to_eye, cosine, light, contribution);
  return contribution;
}

// Returns the light of a source that the coat reflects.
vec3 contribution_in_coat(ShadingPoint point, vec3 to_eye, vec3 to_light, LightRecord light) {
  Coat coat = point.coat;
  float cosine = dot3(coat.normal, to_light);
  precise vec3 sum = to_eye + to_light;
  float size = length3(sum);
  if (!(cosine > 0.0) || size < LEAST_HALF_VECTOR) return vec3(0.0);
  precise vec3 h = sum / size;
  precise vec3 reflected = facet_scale(coat.normal, coat.roughness, h, to_eye, cosine) * light.specular.xyz;
  if (has(FEATURE_SKY_LIGHT)) reflected *= coat_share;
  return reflected;
}

// Returns the contribution, under the coat, of a source behind the surface. Transmitted light is scattered and has no
// highlight.
vec3 contribution_from_behind(ShadingPoint point, vec3 to_light, LightRecord light) {
  precise float cosine = -dot3(point.normal, to_light);
  precise vec3 contribution = albedo_from_behind(point) * INVERSE_PI * light.diffuse.xyz * max(cosine, 0.0);
  if (has(FEATURE_SHEENS)) contribution *= left_below_sheen(point.sheen, point.sheen.share);
  if (is_coated(point)) contribution *= 1.0 - point.coat.weight;
  return contribution;
}

vec3 contribution_metallic_roughness(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
  if (has(FEATURE_DIFFUSE_TRANSMISSION) && lies_behind(point, to_light)) {
    return contribution_from_behind(point, to_light, light);
  }
  vec3 below = vec3(0.0);
  if (!has(FEATURE_DIFFUSE_TRANSMISSION) || cosine > 0.0) {
    below = contribution_below_coat(point, to_eye, to_light, cosine, light);
  }
  if (!is_coated(point)) return below;
  precise vec3 sum =
      (1.0 - point.coat.weight) * below + point.coat.weight * contribution_in_coat(point, to_eye, to_light, light);
  return sum;
}

vec3 albedo_color_metallic_roughness(ShadingPoint point) { return base_color_of(point); }
