// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The interface of materials. Each model of promin/kinds/materials.def has these functions, with its prefix after the
// name; `direction` is the unit direction of the ray that has hit the point:
//   own_light         the point's light without any source: emitted, ambient and from the environment; with
//                     `follows_mirror` without the part that the mirror ray adds
//   emitted_light     the emitted part of own_light
//   contribution      the light that a source of strength 1 adds if it is not blocked
//   mirror_weight     the weight of the mirror ray's radiance; if it is 0, no mirror ray is traced
//   albedo_color      the base colour of the point
//   mirror_normal     the unit normal for the direction of the mirror ray
//   mirror_roughness  the roughness at which a mirror ray that hits nothing sees the environment, or NO_ENVIRONMENT

const float INVERSE_PI = 0.318309886;

// With FEATURE_SKY_LIGHT: the parts of the lobes of the material and of its coat that the current source lights. For the
// environment, the rest is the part of the mirror ray; for all other sources they are 1. Set by sample_light_or_lobe().
float lobe_share;
float coat_share;

// With FEATURE_SCATTERING: the least roughness of surfaces, which is not 0 after a diffuse surface. Glass then does not
// bend rays.
float least_roughness = 0.0;
// Features of sources with tables (emitters.glsl).
const uint TABLE_FEATURES = FEATURE_BIT(FEATURE_EMITTERS) | FEATURE_BIT(FEATURE_CHOSEN_LIGHTS) |
                            FEATURE_BIT(FEATURE_RECT_EMITTERS);
// Features of sources that emissive surfaces are. If each object with such surfaces is one rectangle, the records of
// sources have the rectangles.
const uint LAMP_FEATURES = FEATURE_BIT(FEATURE_EMITTERS) | FEATURE_BIT(FEATURE_RECT_EMITTERS);
const bool ARE_LAMPS_RECTANGLES = FEATURE_BIT(FEATURE_RECT_EMITTERS) > FEATURE_BIT(FEATURE_EMITTERS);

bool has_table(LightRecord light) { return TABLE_FEATURES != 0u && light.kind.x == LIGHT_EMITTERS; }

// Returns whether a source is the environment.
bool is_of_sky(LightRecord light) { return LIGHT_KIND_COUNT + TABLE_FEATURES == 0u || light.kind.x == LIGHT_SKY; }

#include "shade/materials/phong.glsl"
#include "shade/materials/metallic_roughness.glsl"
#include "shade/materials/unlit.glsl"

uint model_of(ShadingPoint point) { return flags_of(point.material) & MATERIAL_MODEL_MASK; }

// Calls the function of the point's model.
#define RETURN_BY_MODEL(KIND, FEATURE, CALL) \
  if (has(FEATURE) && (MATERIAL_KIND_COUNT == 1u || model_of(point) == MATERIAL_##KIND)) return CALL;

// Returns the radiance of the point without light sources.
vec3 own_light(ShadingPoint point, vec3 direction, bool follows_mirror) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, own_light_##PREFIX(point, direction, follows_mirror))
#include "promin/kinds/materials.def"
  return vec3(0.0);
}

vec3 emitted_light(ShadingPoint point) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, emitted_light_##PREFIX(point))
#include "promin/kinds/materials.def"
  return vec3(0.0);
}

vec3 contribution_of(ShadingPoint point, vec3 to_eye, vec3 to_light, float cosine, LightRecord light) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, contribution_##PREFIX(point, to_eye, to_light, cosine, light))
#include "promin/kinds/materials.def"
  return vec3(0.0);
}

vec3 mirror_weight(ShadingPoint point) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, mirror_weight_##PREFIX(point))
#include "promin/kinds/materials.def"
  return vec3(0.0);
}

float mirror_roughness(ShadingPoint point) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, mirror_roughness_##PREFIX(point))
#include "promin/kinds/materials.def"
  return NO_ENVIRONMENT;
}

vec3 mirror_normal(ShadingPoint point) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, mirror_normal_##PREFIX(point))
#include "promin/kinds/materials.def"
  return point.normal;
}

vec3 albedo_color(ShadingPoint point) {
#define PROMIN_MATERIAL(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  RETURN_BY_MODEL(KIND, FEATURE_##FEATURE, albedo_color_##PREFIX(point))
#include "promin/kinds/materials.def"
  return vec3(0.0);
}
