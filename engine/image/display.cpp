// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/display.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace promin {
namespace {

/// More is shown as this: beyond it the curves are flat, and their products overflow nowhere.
constexpr double kMostRadiance = 1e9;

/// As shaders/tone_mapping.glsl has it.
dvec3 map_neutral(dvec3 c) {
  const double least = std::min({c.x, c.y, c.z});
  c -= least < 0.08 ? least - 6.25 * least * least : 0.04;
  const double peak = std::max({c.x, c.y, c.z});
  if (peak <= 0.76) return c;
  const double mapped = 1.0 - 0.0576 / (peak - 0.52);
  const double saturation = 1.0 / (0.15 * (peak - mapped) + 1.0);
  return c * (saturation * mapped / peak) + mapped * (1.0 - saturation);
}

dvec3 map_aces(const dvec3& c) {
  return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
}

dvec3 map_tones(ToneMapping mapping, const dvec3& c) {
  switch (mapping) {
    case ToneMapping::kNone:
      break;
    case ToneMapping::kNeutral:
      return map_neutral(c);
    case ToneMapping::kAces:
      return map_aces(c);
  }
  return c;
}

}  // namespace

std::span<const std::string_view> tone_mapping_names() {
  static constexpr std::array kNames = {
#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) std::string_view(NAME),
#include "promin/kinds/tone_mappings.def"
  };
  return kNames;
}

vec3 apply(const DisplayTransform& display, const vec3& radiance) {
  if (display == DisplayTransform()) return radiance;
  const dvec3 exposed = std::exp2(static_cast<double>(display.exposure_ev)) * dvec3(radiance);
  if (display.tone_mapping == ToneMapping::kNone) return vec3(exposed);
  dvec3 shown(0.0);
  for (int i = 0; i < 3; ++i) {
    // Written so that a NaN becomes 0.
    if (exposed[i] > 0.0) shown[i] = std::min(exposed[i], kMostRadiance);
  }
  return vec3(map_tones(display.tone_mapping, shown));
}

}  // namespace promin
