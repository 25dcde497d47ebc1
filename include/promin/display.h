// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// How radiance beyond what a display can show is brought into its range (docs/model.md, "Showing a picture"), by the
/// names that tone_mapping_names() has: kNone cuts it off; kNeutral, Khronos PBR Neutral, keeps base colours and
/// compresses only what is brighter; kAces, Narkowicz's fit of a film's curve, has more contrast and changes hues;
/// kReinhard compresses luminance alone and keeps hues; kAgx, Sobotka's curve, lets bright colours go to white softly.
enum class ToneMapping : uint32_t {
/// @cond
#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) ENUMERATOR = NUMBER,
#include "promin/kinds/tone_mappings.def"
  /// @endcond
};

/// Names for people, by the value of the ToneMapping; the first is "none".
PROMIN_EXPORT std::span<const std::string_view> tone_mapping_names();

/// How linear radiance is shown, in PNG files and windows. By default as it is; EXR files always have it as it is.
struct DisplayTransform {
  /// Stops, finite: before all else radiance is multiplied by 2 to this power.
  float exposure_ev = 0.0F;
  /// Comes after the exposure.
  ToneMapping tone_mapping = ToneMapping::kNone;
  /// Whether the codes of 8 bits get noise before they are rounded, so that gradients show no bands; apply() knows
  /// nothing of it. The noise hangs on the place of the pixel in the whole picture, so it has the same bits always.
  bool dithers = false;

  /// Whether both are the same.
  bool operator==(const DisplayTransform&) const = default;
};

/// Stops that bring a picture's luminance to a middle grey of 0.18: of its pixels the mean of log(1e-4 + luminance)
/// counts (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 1). `objects` are
/// Aovs::object: pixels that hit nothing, and those whose luminance is not finite, do not count; where `objects` is
/// empty all hit. Where there is `unlit`, which is Aovs::unlit, each counts with its share that is not unlit. 0 where
/// none counts.
PROMIN_EXPORT float average_exposure_ev(std::span<const vec3> pixels, std::span<const uint32_t> objects,
                                        std::span<const vec4> unlit = {});

/// What is shown of a radiance, linear RGB: encode_srgb() (promin/image.h) cuts it to 0...1 and encodes it. Computed in
/// double; the default transform gives the same bits back. Under a tone mapping negative components and NaN count as 0.
PROMIN_EXPORT vec3 apply(const DisplayTransform& display, const vec3& radiance);

/// The same of a pixel in part of which the camera sees unlit surfaces, which are shown as they are. `unlit` is its
/// Aovs::unlit: linear RGB, which `radiance` includes, and the share of the pixel.
PROMIN_EXPORT vec3 apply(const DisplayTransform& display, const vec3& radiance, const vec4& unlit);

}  // namespace promin
