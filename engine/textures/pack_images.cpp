// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/pack_images.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

#include "core/divide_up.h"
#include "core/parallel.h"
#include "core/srgb.h"
#include "textures/alpha_coverage.h"

namespace promin {
namespace {

/// A level whose values are linear numbers from 0 to 1.
struct Level {
  uvec2 size{0};
  std::vector<vec4> texels;
};

/// Returns the number that each byte stands for, in red, green and blue.
std::array<float, 256> make_numbers(ImageUse use) {
  std::array<float, 256> numbers{};
  for (size_t i = 0; i < numbers.size(); ++i) {
    const double code = static_cast<double>(i) / 255.0;
    numbers[i] = static_cast<float>(use == ImageUse::kColor ? srgb_to_linear(code) : code);
  }
  return numbers;
}

/// Returns 255 times the number, rounded. The product has at most 32 bits, so that adding 0.5 is exact.
uint32_t to_byte(float number) {
  return static_cast<uint32_t>(255.0 * static_cast<double>(std::clamp(number, 0.0F, 1.0F)) + 0.5);
}

uint32_t encode(const vec4& texel, ImageUse use) {
  static const SrgbBytes kSrgb;
  uint32_t word = to_byte(texel.a) << 24;
  for (int i = 0; i < 3; ++i) word |= (use == ImageUse::kColor ? kSrgb(texel[i]) : to_byte(texel[i])) << (8 * i);
  return word;
}

/// Texels of a finer level along one axis that a coarser texel covers, with the weight of each.
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

/// Returns the next level, with half of the size. `texel(x, y)` returns a texel of the finer level.
template <typename Texel>
Level make_coarser(const uvec2& fine, const Texel& texel) {
  Level level{glm::max(fine / 2U, uvec2(1)), {}};
  level.texels.reserve(size_t{level.size.x} * level.size.y);
  std::vector<Taps> all_columns;
  for (uint32_t x = 0; x < level.size.x; ++x) all_columns.push_back(taps_of(x, level.size.x, fine.x));
  for (uint32_t y = 0; y < level.size.y; ++y) {
    const Taps rows = taps_of(y, level.size.y, fine.y);
    for (const Taps& columns : all_columns) {
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

/// Returns the size after this number of halvings.
uvec2 halve_size(const uvec2& size, uint32_t halvings) {
  return {std::max(size.x >> halvings, 1U), std::max(size.y >> halvings, 1U)};
}

/// The memory that images need for the levels that their textures use.
class ImageSizes {
 public:
  /// If `needs_texels`, images without texels count as absent; otherwise images without a size.
  ImageSizes(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
             bool needs_texels)
      : images_(images), has_levels_(images.size(), false), needs_texels_(needs_texels) {
    for (const Texture& texture : textures) {
      has_levels_[texture.image] = has_levels_[texture.image] || texture.has_levels;
    }
  }

  /// Returns the number of levels of an image; 0 if the image is absent.
  uint32_t levels(size_t image, uint32_t halvings) const {
    const TextureImage& source = *images_[image];
    if (needs_texels_ ? source.texels.empty() : source.size.x == 0 || source.size.y == 0) return 0;
    return has_levels_[image] ? count_levels(halve_size(images_[image]->size, halvings)) : 1;
  }
  uint64_t words(size_t image, uint32_t halvings) const {
    const uint32_t count = levels(image, halvings);
    return count == 0 ? 0 : count_words(halve_size(images_[image]->size, halvings), count);
  }

 private:
  std::span<const std::shared_ptr<const TextureImage>> images_;
  std::vector<bool> has_levels_;
  bool needs_texels_;
};

/// Writes an image's levels, beginning with the level of the placed size, and without the first level of a bundle's
/// image. The words have the positions of the levels. Each level is computed from the one before it, and not from
/// rounded texels.
void write_image(const TextureImage& image, const PlacedImage& placed, float cutoff, std::span<uint32_t> words) {
  const auto halvings = static_cast<uint32_t>(count_levels(image.size) - count_levels(placed.size));
  const std::array<float, 256> numbers = make_numbers(image.use);
  const double coverage = cutoff > 0.0F ? alpha_coverage(image.texels, cutoff) : 0.0;
  Level level;
  for (uint32_t i = 0; i < halvings + placed.levels; ++i) {
    if (i == 1) {
      level = make_coarser(image.size, [&](uint32_t x, uint32_t y) {
        const uint32_t word = image.texels[size_t{y} * image.size.x + x];
        return vec4(numbers[word & 0xFF], numbers[(word >> 8) & 0xFF], numbers[(word >> 16) & 0xFF],
                    static_cast<float>(word >> 24) / 255.0F);
      });
    } else if (i > 1) {
      const Level finer = std::move(level);
      level =
          make_coarser(finer.size, [&](uint32_t x, uint32_t y) { return finer.texels[size_t{y} * finer.size.x + x]; });
    }
    if (i < halvings) continue;
    const std::span<uint32_t> written = words.subspan(words[i - halvings] + placed.place);
    if (i == 0) {
      if (placed.stride == 1) std::ranges::copy(image.texels, written.begin());
      continue;
    }
    for (size_t j = 0; j < level.texels.size(); ++j) written[j * placed.stride] = encode(level.texels[j], image.use);
    if (cutoff > 0.0F) scale_alpha_to_coverage(written.first(level.texels.size()), cutoff, coverage);
  }
}

/// An image that stands alone, or the images of a bundle.
struct Share {
  std::vector<uint32_t> images;
  /// Size and number of levels of each image.
  uvec2 size{0};
  uint32_t levels = 0;
  uint32_t stride = 1;
  /// Index of the first word.
  uint64_t first = 0;

  /// Returns the number of words for the positions of levels. Texels of bundles begin at multiples of the stride.
  uint64_t head() const { return next_multiple(levels, stride); }
  uint64_t words() const { return head() + stride * (count_words(size, levels) - levels); }
};

/// Sets the first words. Returns the number of words of all shares.
uint64_t place_shares(std::span<Share> shares) {
  uint64_t words = 0;
  for (Share& share : shares) {
    share.first = divide_up<uint64_t>(words, share.stride) * share.stride;
    words = share.first + share.words();
  }
  return words;
}

/// Returns the images, each in one share, ordered by the first image of each share.
std::vector<Share> divide_into_shares(std::span<const std::shared_ptr<const TextureImage>> images,
                                      const ImageSizes& sizes, const TextureFit& fit,
                                      std::span<const ImageBundle> bundles) {
  const auto size_of = [&](uint32_t i) { return halve_size(images[i]->size, fit.halvings[i]); };
  const auto levels_of = [&](uint32_t i) { return sizes.levels(i, fit.halvings[i]); };
  std::vector<const ImageBundle*> bundle_of(images.size(), nullptr);
  for (const ImageBundle& bundle : bundles) {
    const auto is_like_first = [&](uint32_t i) {
      return levels_of(i) > 0 && levels_of(i) == levels_of(bundle[0]) && images[i]->size == images[bundle[0]]->size &&
             fit.halvings[i] == 0;
    };
    if (!std::ranges::all_of(bundle, is_like_first)) continue;
    for (const uint32_t i : bundle) bundle_of[i] = &bundle;
  }
  std::vector<Share> shares;
  for (uint32_t i = 0; i < images.size(); ++i) {
    if (levels_of(i) == 0) continue;
    const ImageBundle* bundle = bundle_of[i];
    if (bundle == nullptr) {
      shares.push_back({{i}, size_of(i), levels_of(i)});
    } else if (i == std::ranges::min(*bundle)) {
      shares.push_back({*bundle, size_of(i), levels_of(i), bundle->size() == 2 ? 2U : kMostBundled});
    }
  }
  return shares;
}

/// Writes the positions of a share's levels, and what its images do not write themselves: the whole pictures of a
/// bundle, and zeros for its missing image.
void begin_share(std::span<const std::shared_ptr<const TextureImage>> images, const Share& share,
                 std::span<uint32_t> words) {
  std::ranges::fill(words.first(share.head()), 0);
  uint64_t position = share.head();
  for (uint32_t level = 0; level < share.levels; ++level) {
    words[level] = static_cast<uint32_t>(position);
    position += share.stride * (count_words(halve_size(share.size, level), 1) - 1);
  }
  if (share.stride == 1) return;
  const size_t texels = size_t{share.size.x} * share.size.y;
  // A core's cache keeps the words of this many texels until all images have written theirs.
  constexpr size_t kTexelsAtOnce = 2048;
  for_each_chunk(texels, kTexelsAtOnce, 0, [&](size_t begin, size_t end) {
    for (uint32_t place = 0; place < share.stride; ++place) {
      uint32_t* word = &words[share.head() + begin * share.stride + place];
      const uint32_t* source = place < share.images.size() ? images[share.images[place]]->texels.data() : nullptr;
      for (size_t i = begin; i < end; ++i, word += share.stride) *word = source == nullptr ? 0 : source[i];
    }
  });
  if (share.images.size() < share.stride) std::ranges::fill(words.subspan(share.head() + texels * share.stride), 0);
}

std::string to_mib(uint64_t bytes) {
  constexpr uint64_t kMib = uint64_t{1} << 20;
  return std::to_string((bytes + kMib - 1) / kMib) + " MiB";
}

/// The largest size of all images in bytes. The words of the buffer that contains images are numbered in 32 bits.
constexpr uint64_t kMostBytes = uint64_t{8} << 30;
constexpr const char* kTextureCure = "raise the memory for textures, or make images smaller";

}  // namespace

TextureFit fit_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                      uint64_t most_bytes) {
  most_bytes = std::min(most_bytes, kMostBytes);
  const ImageSizes sizes(images, textures, true);
  TextureFit fit{std::vector<uint32_t>(images.size(), 0)};
  // The largest image comes first; of several equally large images, the one with the lowest index.
  const auto is_after = [](const auto& a, const auto& b) {
    return a.first != b.first ? a.first < b.first : a.second > b.second;
  };
  std::vector<std::pair<uint64_t, size_t>> heap;
  for (size_t i = 0; i < images.size(); ++i) {
    heap.emplace_back(sizes.words(i, 0), i);
    fit.whole_bytes += sizeof(uint32_t) * heap.back().first;
  }
  fit.bytes = fit.whole_bytes;
  std::ranges::make_heap(heap, is_after);
  while (fit.bytes > most_bytes) {
    std::ranges::pop_heap(heap, is_after);
    auto& [words, image] = heap.back();
    const uint64_t fewer = sizes.words(image, ++fit.halvings[image]);
    if (fewer == words) {
      throw RunError({"textures.memory.short",
                      "the scene's " + std::to_string(images.size()) + " images need more than " + to_mib(most_bytes) +
                          " even with one texel each",
                      "", kTextureCure, Setting::kTextureMemory});
    }
    fit.bytes -= sizeof(uint32_t) * (words - fewer);
    words = fewer;
    std::ranges::push_heap(heap, is_after);
  }
  return fit;
}

std::optional<Problem> warn_of(const TextureFit& fit) {
  const auto count_from = [&](uint32_t least) {
    return std::ranges::count_if(fit.halvings, [=](uint32_t count) { return count >= least; });
  };
  if (count_from(1) == 0) return std::nullopt;
  std::string what = std::to_string(count_from(1)) + " of " + std::to_string(fit.halvings.size()) +
                     " images of textures are halved in size";
  if (count_from(2) > 0) what += ", " + std::to_string(count_from(2)) + " of these more than once";
  what += ", so that " + to_mib(fit.whole_bytes) + " become " + to_mib(fit.bytes);
  return Problem{"textures.halved", what, "", kTextureCure, Setting::kTextureMemory};
}

uint64_t packed_image_bytes(std::span<const std::shared_ptr<const TextureImage>> images,
                            std::span<const Texture> textures) {
  const ImageSizes sizes(images, textures, false);
  uint64_t words = 0;
  for (size_t i = 0; i < images.size(); ++i) words += sizes.words(i, 0);
  return sizeof(uint32_t) * words;
}

PackedImages pack_images(std::span<const std::shared_ptr<const TextureImage>> images, std::span<const Texture> textures,
                         uint64_t most_bytes, std::span<const float> cutoffs, std::span<const ImageBundle> bundles) {
  const TextureFit fit = fit_images(images, textures, most_bytes);
  const ImageSizes sizes(images, textures, true);
  PackedImages packed;
  packed.warning = warn_of(fit);
  std::vector<Share> shares = divide_into_shares(images, sizes, fit, bundles);
  uint64_t words = place_shares(shares);
  if (!bundles.empty() && sizeof(uint32_t) * words > std::min(most_bytes, kMostBytes)) {
    shares = divide_into_shares(images, sizes, fit, {});
    words = place_shares(shares);
  }
  packed.words.resize(words);
  packed.images.resize(images.size());
  uint64_t end = 0;
  for (const Share& share : shares) {
    std::fill(packed.words.begin() + static_cast<ptrdiff_t>(end),
              packed.words.begin() + static_cast<ptrdiff_t>(share.first), 0U);
    end = share.first + share.words();
    const auto has_colors = [&](size_t place) {
      return place < share.images.size() && images[share.images[place]]->use == ImageUse::kColor;
    };
    for (uint32_t place = 0; place < share.images.size(); ++place) {
      packed.images[share.images[place]] = {.first = static_cast<uint32_t>(share.first),
                                            .size = share.size,
                                            .levels = share.levels,
                                            .use = images[share.images[place]]->use,
                                            .stride = share.stride,
                                            .place = place,
                                            .has_colors = {has_colors(0), has_colors(1)}};
    }
    begin_share(images, share, std::span(packed.words).subspan(share.first, share.words()));
  }
  for_each_index(images.size(), 0, [&](size_t i) {
    const PlacedImage& placed = packed.images[i];
    if (placed.levels == 0) return;
    const float cutoff = cutoffs.empty() ? 0.0F : cutoffs[i];
    write_image(*images[i], placed, cutoff, std::span(packed.words).subspan(placed.first));
  });
  return packed;
}

}  // namespace promin
