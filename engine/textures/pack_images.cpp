// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/pack_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "core/parallel.h"
#include "core/srgb.h"
#include "promin/error.h"

namespace promin {
namespace {

/// A level in linear numbers from 0 to 1.
struct Level {
  uvec2 size{0};
  std::vector<vec4> texels;
};

/// The numbers that bytes stand for, in red, green and blue.
std::array<float, 256> make_numbers(ImageUse use) {
  std::array<float, 256> numbers{};
  for (size_t i = 0; i < numbers.size(); ++i) {
    const double code = static_cast<double>(i) / 255.0;
    numbers[i] = static_cast<float>(use == ImageUse::kColor ? srgb_to_linear(code) : code);
  }
  return numbers;
}

uint32_t to_byte(double number) {
  return static_cast<uint32_t>(std::lround(255.0 * std::clamp(number, 0.0, 1.0)));
}

uint32_t encode(const vec4& texel, ImageUse use) {
  uint32_t word = to_byte(static_cast<double>(texel.a)) << 24;
  for (int i = 0; i < 3; ++i) {
    const auto light = static_cast<double>(texel[i]);
    word |= to_byte(use == ImageUse::kColor ? linear_to_srgb(light) : light) << (8 * i);
  }
  return word;
}

/// A stretch of the texels of a finer level along one axis, with the share of each: the area under a coarser texel.
struct Taps {
  uint32_t first = 0;
  uint32_t count = 0;
  std::array<double, 4> shares{};
};

Taps taps_of(uint32_t place, uint32_t coarse, uint32_t fine) {
  const double begin = static_cast<double>(place) * fine / coarse;
  const double end = static_cast<double>(place + 1) * fine / coarse;
  Taps taps{.first = static_cast<uint32_t>(begin)};
  for (uint32_t i = taps.first; i < fine && static_cast<double>(i) < end && taps.count < taps.shares.size(); ++i) {
    const double share = std::min(end, i + 1.0) - std::max(begin, static_cast<double>(i));
    taps.shares[taps.count++] = share / (end - begin);
  }
  return taps;
}

/// Half of a level's size, made of `texel(x, y)` of the finer level.
template <typename Texel>
Level make_coarser(const uvec2& fine, const Texel& texel) {
  Level level{glm::max(fine / 2U, uvec2(1)), {}};
  level.texels.reserve(size_t{level.size.x} * level.size.y);
  for (uint32_t y = 0; y < level.size.y; ++y) {
    const Taps rows = taps_of(y, level.size.y, fine.y);
    for (uint32_t x = 0; x < level.size.x; ++x) {
      const Taps columns = taps_of(x, level.size.x, fine.x);
      dvec4 sum(0.0);
      for (uint32_t j = 0; j < rows.count; ++j) {
        for (uint32_t i = 0; i < columns.count; ++i) {
          sum += rows.shares[j] * columns.shares[i] * dvec4(texel(columns.first + i, rows.first + j));
        }
      }
      level.texels.emplace_back(sum);
    }
  }
  return level;
}

uint32_t count_levels(const uvec2& size) {
  uint32_t count = 1;
  for (uint32_t side = std::max(size.x, size.y); side > 1; side /= 2) ++count;
  return count;
}

uint64_t count_words(const uvec2& size, uint32_t levels) {
  uint64_t words = levels;
  for (uint32_t level = 0; level < levels; ++level) {
    words += uint64_t{std::max(size.x >> level, 1U)} * std::max(size.y >> level, 1U);
  }
  return words;
}

void write_image(const TextureImage& image, const PlacedImage& placed, std::span<uint32_t> words) {
  uint32_t place = placed.levels;
  words[0] = place;
  std::ranges::copy(image.texels, words.begin() + place);
  place += static_cast<uint32_t>(image.texels.size());
  const std::array<float, 256> numbers = make_numbers(image.use);
  Level level;
  for (uint32_t i = 1; i < placed.levels; ++i) {
    if (i == 1) {
      level = make_coarser(image.size, [&](uint32_t x, uint32_t y) {
        const uint32_t word = image.texels[size_t{y} * image.size.x + x];
        return vec4(numbers[word & 0xFF], numbers[(word >> 8) & 0xFF], numbers[(word >> 16) & 0xFF],
                    static_cast<float>(word >> 24) / 255.0F);
      });
    } else {
      const Level finer = std::move(level);
      level =
          make_coarser(finer.size, [&](uint32_t x, uint32_t y) { return finer.texels[size_t{y} * finer.size.x + x]; });
    }
    words[i] = place;
    for (const vec4& texel : level.texels) words[place++] = encode(texel, image.use);
  }
}

}  // namespace

PackedImages pack_images(std::span<const std::shared_ptr<const TextureImage>> images,
                         std::span<const Texture> textures) {
  std::vector<bool> has_levels(images.size(), false);
  for (const Texture& texture : textures) has_levels[texture.image] = has_levels[texture.image] || texture.has_levels;
  PackedImages packed;
  uint64_t words = 0;
  for (size_t i = 0; i < images.size(); ++i) {
    const TextureImage& image = *images[i];
    PlacedImage& placed = packed.images.emplace_back();
    if (image.texels.empty()) continue;
    placed = {static_cast<uint32_t>(words), image.size, has_levels[i] ? count_levels(image.size) : 1, image.use};
    words += count_words(image.size, placed.levels);
    if (words * sizeof(uint32_t) <= kMostTextureBytes) continue;
    throw RunError({"the scene's textures take more than " + std::to_string(kMostTextureBytes >> 20) + " MiB",
                    "with image " + std::to_string(i), "make some of them smaller"});
  }
  packed.words.resize(words);
  for_each_index(images.size(), 0, [&](size_t i) {
    const PlacedImage& placed = packed.images[i];
    if (placed.levels == 0) return;
    write_image(*images[i], placed, std::span(packed.words).subspan(placed.first));
  });
  return packed;
}

}  // namespace promin
