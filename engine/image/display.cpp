// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/display.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/luminance.h"
#include "promin/aovs.h"

namespace promin {
namespace {

/// Larger values are clamped to this, because the curves are flat beyond it and products could overflow.
constexpr double kMostRadiance = 1e9;

/// Maps a colour like map_neutral in shaders/window/tone_mapping.glsl.
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

/// Maps a colour with equation 4 of Reinhard et al. 2002. A luminance of 4 is displayed as white.
dvec3 map_reinhard(const dvec3& c) {
  const double luminance = luminance_of(c);
  return c * ((1.0 + luminance / 16.0) / (1.0 + luminance));
}

/// Maps a colour with Sobotka's AgX in Wrensch's approximation ("Minimal AgX Implementation", 2023). The colour is
/// converted to AgX's own space. There, a sigmoid is applied to stops between -12.47 and 4.03. The result is converted
/// back, and from its display's curve to linear light.
dvec3 map_agx(const dvec3& c) {
  const glm::dmat3 inset(0.842479062253094, 0.0423282422610123, 0.0423756549057051,  //
                         0.0784335999999992, 0.878468636469772, 0.0784336,           //
                         0.0792237451477643, 0.0791661274605434, 0.879142973793104);
  const glm::dmat3 outset(1.19687900512017, -0.0528968517574562, -0.0529716355144438,  //
                          -0.0980208811401368, 1.15190312990417, -0.0980434501171241,  //
                          -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
  constexpr double kFirstStop = -12.47393;
  constexpr double kLastStop = 4.026069;
  dvec3 shown = inset * c;
  for (int i = 0; i < 3; ++i) {
    const double stop = std::clamp(std::log2(std::max(shown[i], 1e-30)), kFirstStop, kLastStop);
    const double x = (stop - kFirstStop) / (kLastStop - kFirstStop);
    shown[i] = ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x) + 0.1191) * x - 0.00232;
  }
  shown = outset * shown;
  for (int i = 0; i < 3; ++i) shown[i] = std::pow(std::max(shown[i], 0.0), 2.2);
  return shown;
}

dvec3 map_tones(ToneMapping mapping, const dvec3& c) {
  switch (mapping) {
    case ToneMapping::kNone:
      break;
    case ToneMapping::kNeutral:
      return map_neutral(c);
    case ToneMapping::kAces:
      return map_aces(c);
    case ToneMapping::kReinhard:
      return map_reinhard(c);
    case ToneMapping::kAgx:
      return map_agx(c);
  }
  return c;
}

/// Returns the fraction of a pixel that is not unlit.
double lit_share(const vec4& unlit) {
  return std::max(1.0 - static_cast<double>(unlit.w), 0.0);
}

/// Returns the radiance that the lit part would have if it filled the pixel.
dvec3 lit_radiance(const vec3& radiance, const vec4& unlit) {
  return (dvec3(radiance) - dvec3(unlit)) / lit_share(unlit);
}

bool is_identity(const DisplayTransform& display) {
  return display.exposure_ev == 0.0F && display.tone_mapping == ToneMapping::kNone;
}

}  // namespace

std::span<const std::string_view> tone_mapping_names() {
  static constexpr std::array kNames = {
#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) std::string_view(NAME),
#include "promin/kinds/tone_mappings.def"
  };
  return kNames;
}

float average_exposure_ev(std::span<const vec3> pixels, std::span<const uint32_t> objects,
                          std::span<const vec4> unlit) {
  double sum = 0.0;
  double count = 0.0;
  for (size_t i = 0; i < pixels.size(); ++i) {
    if (!objects.empty() && objects[i] == Aovs::kNoId) continue;
    const vec4 of_unlit = unlit.empty() ? vec4(0.0F) : unlit[i];
    const double lit = lit_share(of_unlit);
    if (lit == 0.0) continue;
    const double luminance = luminance_of(lit_radiance(pixels[i], of_unlit));
    if (!std::isfinite(luminance)) continue;
    sum += lit * std::log(1e-4 + std::max(luminance, 0.0));
    count += lit;
  }
  if (count == 0.0) return 0.0F;
  return static_cast<float>(std::log2(0.18) - sum / count * std::numbers::log2e);
}

vec3 apply(const DisplayTransform& display, const vec3& radiance) {
  if (is_identity(display)) return radiance;
  const dvec3 exposed = std::exp2(static_cast<double>(display.exposure_ev)) * dvec3(radiance);
  if (display.tone_mapping == ToneMapping::kNone) return vec3(exposed);
  dvec3 shown(0.0);
  for (int i = 0; i < 3; ++i) {
    // The comparison is written so that a NaN becomes 0.
    if (exposed[i] > 0.0) shown[i] = std::min(exposed[i], kMostRadiance);
  }
  return vec3(map_tones(display.tone_mapping, shown));
}

vec3 apply(const DisplayTransform& display, const vec3& radiance, const vec4& unlit) {
  if (unlit.w == 0.0F || is_identity(display)) return apply(display, radiance);
  const double lit = lit_share(unlit);
  if (lit == 0.0) return vec3(unlit);
  return vec3(lit * dvec3(apply(display, vec3(lit_radiance(radiance, unlit)))) + dvec3(unlit));
}

}  // namespace promin
