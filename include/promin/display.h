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
/// compresses only what is brighter; kAces, Narkowicz's fit of a film's curve, has more contrast and changes hues.
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

  /// Whether both are the same.
  bool operator==(const DisplayTransform&) const = default;
};

/// What is shown of a radiance, linear RGB: encode_srgb() (promin/image.h) cuts it to 0...1 and encodes it. Computed in
/// double; the default transform gives the same bits back. Under a tone mapping negative components and NaN count as 0.
PROMIN_EXPORT vec3 apply(const DisplayTransform& display, const vec3& radiance);

}  // namespace promin
