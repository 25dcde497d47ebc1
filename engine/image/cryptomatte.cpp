// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/cryptomatte.h"
#include "core/json_text.h"

#include <algorithm>
#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "core/parallel.h"

namespace promin {
namespace {

/// Number of ranks in a group of channels, such as CryptoObject00.RGBA.
constexpr size_t kRanksOfGroup = 2;

/// Returns MurmurHash3_x86_32 of a text with seed 0 (Appleby, public domain algorithm).
uint32_t murmur3(std::string_view text) {
  constexpr uint32_t kC1 = 0xCC9E2D51;
  constexpr uint32_t kC2 = 0x1B873593;
  const auto byte = [&](size_t i) { return uint32_t{static_cast<unsigned char>(text[i])}; };
  const auto scramble = [](uint32_t k) { return std::rotl(k * kC1, 15) * kC2; };
  uint32_t hash = 0;
  const size_t whole = text.size() / 4 * 4;
  for (size_t i = 0; i < whole; i += 4) {
    hash ^= scramble(byte(i) | byte(i + 1) << 8 | byte(i + 2) << 16 | byte(i + 3) << 24);
    hash = std::rotl(hash, 13) * 5 + 0xE6546B64;
  }
  uint32_t rest = 0;
  for (size_t i = text.size(); i > whole; --i) rest = rest << 8 | byte(i - 1);
  hash ^= scramble(rest);
  hash ^= static_cast<uint32_t>(text.size());
  hash = (hash ^ hash >> 16) * 0x85EBCA6B;
  hash = (hash ^ hash >> 13) * 0xC2B2AE35;
  return hash ^ hash >> 16;
}

std::string hex(uint32_t number) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (int shift = 28; shift >= 0; shift -= 4) text += kDigits[number >> shift & 15];
  return text;
}

/// Adds a layer of mattes. `names` are the names by index; the coverage is given for each pixel.
void add_layer(const std::string& layer, const std::vector<std::string>& names,
               const std::vector<CoverageRanks>& coverage, Cryptomatte& result) {
  std::vector<uint32_t> ids;
  std::map<std::string, std::string> manifest;
  for (const std::string& name : names) {
    ids.push_back(cryptomatte_id(name));
    manifest[name] = hex(ids.back());
  }

  const size_t first = result.channels.size();
  for (size_t group = 0; group < kCoverageRanks / kRanksOfGroup; ++group) {
    for (const char letter : {'R', 'G', 'B', 'A'}) {
      result.channels.push_back(
          {layer + "0" + std::to_string(group) + "." + letter, false, std::vector<uint32_t>(coverage.size())});
    }
  }
  for_each_pixel(coverage.size(), [&](size_t pixel) {
    // The mattes of the pixel. Objects with the same name form one matte.
    std::array<std::pair<uint32_t, float>, kCoverageRanks> mattes{};
    size_t count = 0;
    for (const Coverage& covered : coverage[pixel]) {
      if (covered.id == Coverage::kNoId) break;
      const auto known = mattes.begin() + static_cast<std::ptrdiff_t>(count);
      const auto same =
          std::find_if(mattes.begin(), known, [&](const auto& matte) { return matte.first == ids[covered.id]; });
      if (same == known) {
        *known = {ids[covered.id], covered.share};
        ++count;
      } else {
        same->second += covered.share;
      }
    }
    std::stable_sort(mattes.begin(), mattes.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const auto& a, const auto& b) { return a.second > b.second; });
    for (size_t rank = 0; rank < count; ++rank) {
      result.channels[first + 2 * rank].values[pixel] = mattes[rank].first;
      result.channels[first + 2 * rank + 1].values[pixel] = std::bit_cast<uint32_t>(mattes[rank].second);
    }
  });

  const std::string key = "cryptomatte/" + hex(murmur3(layer)).substr(0, 7) + "/";
  const nlohmann::json json = manifest;
  result.metadata.emplace_back(key + "name", layer);
  result.metadata.emplace_back(key + "hash", "MurmurHash3_32");
  result.metadata.emplace_back(key + "conversion", "uint32_to_float32");
  result.metadata.emplace_back(key + "manifest", json_text(json));
}

}  // namespace

uint32_t cryptomatte_id(std::string_view name) {
  const uint32_t hash = murmur3(name);
  const uint32_t exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1U << 23 : hash;
}

Cryptomatte make_cryptomatte(const Scene& scene, const Aovs& aovs) {
  std::vector<std::string> objects;
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    const std::string& name = scene.objects[i].name;
    objects.push_back(name.empty() ? "object " + std::to_string(i) : name);
  }
  std::vector<std::string> materials;
  for (const Material& material : scene.materials) {
    materials.push_back(material.name.empty() ? "material " + std::to_string(materials.size()) : material.name);
  }
  Cryptomatte result;
  add_layer("CryptoObject", objects, aovs.object_coverage, result);
  add_layer("CryptoMaterial", materials, aovs.material_coverage, result);
  return result;
}

}  // namespace promin
