// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Maps radiance into a display's range (docs/model.md, "Showing a picture"), as engine/image/display.cpp does in double
// for files.

#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) const uint TONE_MAPPING_##KIND = NUMBER;
#include "promin/kinds/tone_mappings.def"

// Larger values are clamped to this, because the curves are flat beyond it and products could overflow.
const float MOST_RADIANCE = 1e9;

// Maps a colour with Khronos PBR Neutral (https://github.com/KhronosGroup/ToneMapping). Base colours are reduced by the
// 0.04 that a surface additionally reflects. Values brighter than 0.8 are compressed and desaturated.
vec3 map_neutral(vec3 c) {
  float least = min(c.x, min(c.y, c.z));
  c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float peak = max(c.x, max(c.y, c.z));
  if (peak <= 0.76) return c;
  float mapped = 1.0 - 0.0576 / (peak - 0.52);
  float saturation = 1.0 / (0.15 * (peak - mapped) + 1.0);
  return c * (saturation * mapped / peak) + mapped * (1.0 - saturation);
}

// Maps a colour with Narkowicz, "ACES Filmic Tone Mapping Curve".
vec3 map_aces(vec3 c) { return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14); }

float luminance_of(vec3 c) { return dot(c, vec3(0.2126, 0.7152, 0.0722)); }

// Maps a colour with equation 4 of Reinhard et al. 2002. A luminance of 4 is displayed as white.
vec3 map_reinhard(vec3 c) {
  float luminance = luminance_of(c);
  return c * ((1.0 + luminance / 16.0) / (1.0 + luminance));
}

// Maps a colour with Sobotka's AgX in Wrensch's approximation ("Minimal AgX Implementation", 2023).
vec3 map_agx(vec3 c) {
  const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                          0.0784335999999992, 0.878468636469772, 0.0784336,
                          0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                           -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                           -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  const float first_stop = -12.47393;
  const float last_stop = 4.026069;
  vec3 stops = clamp(log2(max(inset * c, vec3(1e-30))), first_stop, last_stop);
  vec3 x = (stops - first_stop) / (last_stop - first_stop);
  vec3 shown = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.00232;
  return pow(max(outset * shown, vec3(0.0)), vec3(2.2));
}

vec3 map_tones(uint mapping, vec3 c) {
  if (mapping == TONE_MAPPING_NEUTRAL) return map_neutral(min(max(c, 0.0), MOST_RADIANCE));
  if (mapping == TONE_MAPPING_ACES) return map_aces(min(max(c, 0.0), MOST_RADIANCE));
  if (mapping == TONE_MAPPING_REINHARD) return map_reinhard(min(max(c, 0.0), MOST_RADIANCE));
  if (mapping == TONE_MAPPING_AGX) return map_agx(min(max(c, 0.0), MOST_RADIANCE));
  return c;
}
