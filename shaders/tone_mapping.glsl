// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// How radiance beyond a display's range is shown (docs/model.md, "Showing a picture"), as engine/image/display.cpp has
// it in double for files.

#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) const uint TONE_MAPPING_##KIND = NUMBER;
#include "promin/kinds/tone_mappings.def"

// More is shown as this: beyond it the curves are flat, and their products overflow nowhere.
const float MOST_RADIANCE = 1e9;

// Khronos PBR Neutral (https://github.com/KhronosGroup/ToneMapping): base colours lose the 0.04 that a surface reflects
// beside them, and what is brighter than 0.8 is compressed and loses colour.
vec3 map_neutral(vec3 c) {
  float least = min(c.x, min(c.y, c.z));
  c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  float peak = max(c.x, max(c.y, c.z));
  if (peak <= 0.76) return c;
  float mapped = 1.0 - 0.0576 / (peak - 0.52);
  float saturation = 1.0 / (0.15 * (peak - mapped) + 1.0);
  return c * (saturation * mapped / peak) + mapped * (1.0 - saturation);
}

// Narkowicz, "ACES Filmic Tone Mapping Curve".
vec3 map_aces(vec3 c) { return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14); }

vec3 map_tones(uint mapping, vec3 c) {
  if (mapping == TONE_MAPPING_NEUTRAL) return map_neutral(min(max(c, 0.0), MOST_RADIANCE));
  if (mapping == TONE_MAPPING_ACES) return map_aces(min(max(c, 0.0), MOST_RADIANCE));
  return c;
}
