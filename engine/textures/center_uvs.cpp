// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/center_uvs.h"

#include <algorithm>
#include <cmath>

namespace promin {
namespace {

/// The largest number of widths that is tried. A transform with a fraction such as 1/2 or 3/4 repeats after some
/// widths.
constexpr int kMostWidths = 16;
/// Movements smaller than 1/256 of the smallest possible texel do not count, because angles and scales are rounded.
constexpr double kLeastMove = 0x1p-22;

/// Returns whether a picture looks the same after its coordinates have moved by `moved`.
bool shows_the_same(double moved, TextureWrap wrap) {
  if (wrap == TextureWrap::kClampToEdge) return std::abs(moved) <= kLeastMove;
  const double period = wrap == TextureWrap::kRepeat ? 1.0 : 2.0;
  return std::abs(moved - period * std::round(moved / period)) <= kLeastMove;
}

bool shows_the_same(const TextureSlot& slot, const Texture& texture, const dvec2& center) {
  return shows_the_same(glm::dot(dvec2(slot.to_u), center), texture.wrap_u) &&
         shows_the_same(glm::dot(dvec2(slot.to_v), center), texture.wrap_v);
}

/// Returns the center for one component of the coordinates.
double find_center(const Mesh& mesh, int component, std::span<const TextureSlot> slots,
                   std::span<const Texture> textures) {
  double sum = 0.0;
  double farthest = 0.0;
  for (const vec4& uv : mesh.uvs) {
    sum += static_cast<double>(uv[component]);
    farthest = std::max(farthest, std::abs(static_cast<double>(uv[component])));
  }
  const double mean = sum / static_cast<double>(mesh.uvs.size());
  for (int widths = 1; widths <= kMostWidths; ++widths) {
    const double center = widths * std::floor(mean / widths);
    if (center == 0.0) continue;
    const dvec2 move = component % 2 == 0 ? dvec2(center, 0.0) : dvec2(0.0, center);
    const bool is_seen = std::ranges::any_of(slots, [&](const TextureSlot& slot) {
      return slot.uv_set == static_cast<uint32_t>(component / 2) && !shows_the_same(slot, textures[slot.texture], move);
    });
    if (is_seen) continue;
    const bool is_nearer = std::ranges::all_of(mesh.uvs, [&](const vec4& uv) {
      return std::abs(static_cast<double>(uv[component]) - center) <= 0.5 * farthest;
    });
    return is_nearer ? center : 0.0;
  }
  return 0.0;
}

}  // namespace

dvec4 find_uv_center(const Mesh& mesh, std::span<const TextureSlot> slots, std::span<const Texture> textures) {
  dvec4 center(0.0);
  for (int component = 0; component < 4; ++component) {
    const auto reads_it = [&](const TextureSlot& slot) { return slot.uv_set == static_cast<uint32_t>(component / 2); };
    if (std::ranges::none_of(slots, reads_it)) continue;
    center[component] = find_center(mesh, component, slots, textures);
  }
  return center;
}

void center_uvs(Mesh& mesh, const dvec4& center) {
  for (vec4& uv : mesh.uvs) uv = vec4(dvec4(uv) - center);
}

}  // namespace promin
