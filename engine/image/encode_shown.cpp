// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/encode_shown.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string_view>

#include "core/parallel.h"
#include "image/dither.h"

namespace promin {
namespace {

const Channel* find_shown(std::span<const Channel> channels, std::string_view name) {
  const auto found = std::ranges::find(channels, name, &Channel::name);
  return found == channels.end() ? nullptr : &*found;
}

/// The channels that are needed to make an 8-bit picture; missing channels are null.
struct ShownChannels {
  const Channel* alpha;
  /// The channels of Aovs::unlit.
  std::array<const Channel*, 4> unlit;

  ShownChannels(std::span<const Channel> channels, bool has_alpha)
      : alpha(has_alpha ? find_shown(channels, "A") : nullptr),
        unlit{find_shown(channels, "unlit.R"), find_shown(channels, "unlit.G"), find_shown(channels, "unlit.B"),
              find_shown(channels, "unlit.A")} {}

  float alpha_at(size_t pixel) const { return alpha == nullptr ? 1.0F : std::bit_cast<float>(alpha->values[pixel]); }
  vec4 unlit_at(size_t pixel) const {
    vec4 result(0.0F);
    if (std::ranges::find(unlit, nullptr) != unlit.end()) return result;
    for (int i = 0; i < 4; ++i) result[i] = std::bit_cast<float>(unlit[static_cast<size_t>(i)]->values[pixel]);
    return result;
  }
};

/// Returns the colour of a PNG pixel that is partly covered: the light divided by the covered fraction.
template <typename Light>
Light unassociated(const Light& light, float alpha) {
  return alpha > 0.0F ? light / alpha : Light(0.0F);
}

}  // namespace

std::vector<uint8_t> encode_shown(const Image& image, std::span<const Channel> all, const DisplayTransform& display,
                                  const uvec2& lo, bool has_alpha) {
  const ShownChannels channels(all, has_alpha);
  const size_t stride = has_alpha ? 4 : 3;
  std::vector<uint8_t> bytes(image.pixels.size() * stride);
  for_each_index(image.size.y, 0, [&](size_t y) {
    uint8_t* next = &bytes[stride * y * image.size.x];
    for (uint32_t x = 0; x < image.size.x; ++x) {
      const size_t at = y * image.size.x + x;
      const float covered = channels.alpha_at(at);
      vec3 color = image.pixels[at];
      vec4 unlit = channels.unlit_at(at);
      if (has_alpha) {
        color = unassociated(color, covered);
        unlit = unassociated(unlit, covered);
      }
      const vec3 shown = apply(display, color, unlit);
      for (int channel = 0; channel < 3; ++channel) {
        float code = 255.0F * encode_srgb(shown[channel]);
        if (display.dithers) {
          code = dithered(code, lo.x + x, lo.y + static_cast<uint32_t>(y), static_cast<uint32_t>(channel));
        }
        *next++ = static_cast<uint8_t>(std::lround(code));
      }
      if (has_alpha) *next++ = static_cast<uint8_t>(std::lround(255.0F * std::clamp(covered, 0.0F, 1.0F)));
    }
  });
  return bytes;
}

}  // namespace promin
