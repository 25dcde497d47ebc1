// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// A mapping of radiance to the range of a display (docs/model.md, "Showing a picture"). kNone clips the radiance.
/// kNeutral, Khronos PBR Neutral, keeps base colours and compresses only brighter values. kAces, Narkowicz's fit of a
/// film curve, has more contrast and changes hues. kReinhard compresses only luminance and keeps hues. kAgx, Sobotka's
/// curve, fades bright colours softly to white. tone_mapping_names() returns the names.
enum class ToneMapping : uint32_t {
/// @cond
#define PROMIN_TONE_MAPPING(KIND, ENUMERATOR, NUMBER, NAME) ENUMERATOR = NUMBER,
#include "promin/kinds/tone_mappings.def"
  /// @endcond
};

/// Returns the names to display, indexed by ToneMapping. The first name is "none".
PROMIN_EXPORT std::span<const std::string_view> tone_mapping_names();

/// The conversion of linear radiance to the values that PNG files and windows show. The default does not change the
/// radiance. EXR files always store the radiance unchanged.
struct DisplayTransform {
  /// Exposure in stops, finite. The radiance is first multiplied by 2^exposure_ev.
  float exposure_ev = 0.0F;
  /// The tone mapping, which is applied after the exposure.
  ToneMapping tone_mapping = ToneMapping::kNone;
  /// If true, 8-bit values get noise before they are rounded, which hides bands in gradients. apply() ignores this
  /// member. The noise depends only on the pixel's position in the whole picture, so it is reproducible.
  bool dithers = false;

  /// Returns whether both are equal.
  bool operator==(const DisplayTransform&) const = default;
};

/// Returns the exposure in stops that makes a picture's average luminance equal to a middle grey of 0.18. The average
/// is the mean of log(1e-4 + luminance) (Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002,
/// equation 1). `objects` is Aovs::object. Pixels without a hit do not count, and pixels whose luminance is not finite
/// do not count. If `objects` is empty, every pixel counts as a hit. If `unlit` (Aovs::unlit) is given, each pixel is
/// weighted by its share that is not unlit. Returns 0 if no pixel counts.
PROMIN_EXPORT float average_exposure_ev(std::span<const vec3> pixels, std::span<const uint32_t> objects,
                                        std::span<const vec4> unlit = {});

/// Returns the linear RGB to display for a radiance. encode_srgb() (promin/image.h) then clamps it to 0...1 and encodes
/// it. The function computes in double. The default transform returns its argument bit for bit. Tone mappings treat
/// negative components and NaN as 0.
PROMIN_EXPORT vec3 apply(const DisplayTransform& display, const vec3& radiance);

/// Returns the linear RGB to display for a pixel that partly shows unlit surfaces, whose colours do not change. `unlit`
/// is the pixel's Aovs::unlit: the linear RGB of these surfaces, which is included in `radiance`, and the fraction of
/// the pixel that they cover.
PROMIN_EXPORT vec3 apply(const DisplayTransform& display, const vec3& radiance, const vec4& unlit);

}  // namespace promin
