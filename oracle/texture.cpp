// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "oracle/distance.h"
#include "oracle/surface.h"

namespace promin::oracle {
namespace {

/// Largest error of a device's sRGB decoding: a fraction of the step between codes, times 2.3, the largest slope of the
/// curve.
constexpr Real kDecodingError = 2.3L * 0.006L / 255;
/// Largest error of a device's level that its logarithms cause. The cone's width and the cosine cause further errors.
constexpr Real kLevelError = 1e-3L;

Texel unpack(uint32_t texel) {
  return Texel(texel & 255U, texel >> 8 & 255U, texel >> 16 & 255U, texel >> 24) / Real(255);
}

/// Returns the linear value of an 8-bit sRGB value.
Real light_of(uint32_t code) {
  static const auto kLights = [] {
    std::array<Real, 256> lights{};
    for (size_t i = 0; i < lights.size(); ++i) lights[i] = decode_srgb(static_cast<Real>(i) / 255);
    return lights;
  }();
  return kLights[code];
}

/// Returns the numbers that are averaged and filtered: colours as linear light, alpha and other numbers unchanged.
Texel decode(uint32_t texel, ImageUse use) {
  Texel value = unpack(texel);
  if (use != ImageUse::kColor) return value;
  for (int i = 0; i < 3; ++i) value[i] = light_of(texel >> 8 * i & 255U);
  return value;
}

uint32_t round_to_code(Real number) {
  return static_cast<uint32_t>(std::lround(255 * std::clamp(number, Real(0), Real(1))));
}

/// Returns a value rounded to 8 bits.
Texel round_texel(const Texel& value, ImageUse use) {
  uint32_t texel = 0;
  for (int i = 0; i < 4; ++i) {
    const bool is_light = use == ImageUse::kColor && i < 3;
    texel |= round_to_code(is_light ? encode_srgb(value[i]) : value[i]) << 8 * i;
  }
  return decode(texel, use);
}

/// Returns the index of the texel for an index beyond the edge.
size_t wrap(int64_t number, uint32_t size, TextureWrap wrap) {
  const int64_t n = size;
  const auto modulo = [](int64_t a, int64_t b) { return ((a % b) + b) % b; };
  if (wrap == TextureWrap::kClampToEdge) return static_cast<size_t>(std::clamp<int64_t>(number, 0, n - 1));
  if (wrap == TextureWrap::kRepeat) return static_cast<size_t>(modulo(number, n));
  const int64_t in_pair = modulo(number, 2 * n);
  return static_cast<size_t>(in_pair < n ? in_pair : 2 * n - 1 - in_pair);
}

Vector2 transform(const TextureSlot& slot, const Vector2& uv) {
  const Vector place(uv.x, uv.y, 1);
  return {glm::dot(Vector(slot.to_u), place), glm::dot(Vector(slot.to_v), place)};
}

Vector2 corner_coordinates(const TextureSlot& slot, const TrianglePoint& point, int corner) {
  const Mesh& mesh = *point.mesh;
  const vec4& uvs = mesh.uvs[mesh.triangles[static_cast<size_t>(point.triangle)][corner]];
  return transform(slot, slot.uv_set == 0 ? Vector2(uvs.x, uvs.y) : Vector2(uvs.z, uvs.w));
}

Vector corner_position(const TrianglePoint& point, int corner) {
  const Mesh& mesh = *point.mesh;
  return Vector(mesh.positions[mesh.triangles[static_cast<size_t>(point.triangle)][corner]]);
}

/// Returns the largest change of each coordinate per length along the triangle. The coordinates are b p + c q at the
/// point p B + q C.
Vector2 steepness(const TextureSlot& slot, const TrianglePoint& point) {
  const UvEdges uv = uv_edges(slot, point);
  const Vector b = corner_position(point, 1) - corner_position(point, 0);
  const Vector c = corner_position(point, 2) - corner_position(point, 0);
  const Vector normal = glm::cross(b, c);
  const Real area = glm::dot(normal, normal);
  // Vectors in the plane whose scalar products with a point are its p and q.
  const Vector to_p = glm::cross(c, normal) / area;
  const Vector to_q = glm::cross(normal, b) / area;
  return {glm::length(uv.to_b.x * to_p + uv.to_c.x * to_q), glm::length(uv.to_b.y * to_p + uv.to_c.y * to_q)};
}

/// Returns the alpha from which texels of an image are present, according to the first mask that uses the image.
/// Returns none if a material blends with the image.
Real cutoff_of(const world::Scene& scene, uint32_t image) {
  Real cutoff = 0;
  for (const Material& material : scene.materials) {
    const TextureSlot slot = slots_of(material)[kBaseSlot];
    if (!slot.exists() || scene.textures[slot.texture].image != image) continue;
    if (material.alpha_mode == AlphaMode::kBlend) return 0;
    const bool cuts = material.alpha_mode == AlphaMode::kMask && material.alpha >= material.alpha_cutoff;
    if (cuts && cutoff == 0) cutoff = Real(material.alpha_cutoff) / material.alpha;
  }
  return cutoff;
}

int64_t alpha_code(const Texel& texel) {
  return std::llround(255 * texel.a);
}

/// Returns the number of texels whose alpha has this code or a larger one.
Real count_from(const std::vector<Texel>& texels, int64_t code) {
  return static_cast<Real>(std::ranges::count_if(texels, [=](const Texel& t) { return alpha_code(t) >= code; }));
}

/// Multiplies alphas by a factor, so that the fraction of present texels is as close as possible to `share`. Of several
/// such factors it uses the one that changes least. Rounding does not change which texels are present.
void keep_share(std::vector<Texel>& texels, int64_t least, Real share) {
  const Real wanted = share * static_cast<Real>(texels.size());
  std::array<Real, 3> best{kInfinity, 0, 0};
  for (int64_t code = 1; code < 256; ++code) {
    const Real miss = std::abs(count_from(texels, code) - wanted);
    best = std::min(best, {miss, static_cast<Real>(std::abs(code - least)), static_cast<Real>(code)});
  }
  const auto threshold = static_cast<int64_t>(best[2]);
  for (Texel& texel : texels) {
    const int64_t code = alpha_code(texel);
    const auto scaled = static_cast<int64_t>(std::floor(static_cast<Real>(code * least) / threshold + 0.5L));
    const bool is_there = code >= threshold;
    texel.a = static_cast<Real>(is_there ? std::clamp<int64_t>(scaled, least, 255) : std::min(scaled, least - 1)) / 255;
  }
}

}  // namespace

Real decode_srgb(Real code) {
  return code <= 0.04045L ? code / 12.92L : std::pow((code + 0.055L) / 1.055L, 2.4L);
}

Real encode_srgb(Real light) {
  return light <= 0.0031308L ? 12.92L * light : 1.055L * std::pow(light, 1 / 2.4L) - 0.055L;
}

Vector2 coordinates_at(const TextureSlot& slot, const TrianglePoint& point) {
  const UvEdges edges = uv_edges(slot, point);
  return corner_coordinates(slot, point, 0) + point.u * edges.to_b + point.v * edges.to_c;
}

UvEdges uv_edges(const TextureSlot& slot, const TrianglePoint& point) {
  const Vector2 a = corner_coordinates(slot, point, 0);
  return {corner_coordinates(slot, point, 1) - a, corner_coordinates(slot, point, 2) - a};
}

Textures::Textures(const world::Scene& scene) : scene_(scene) {
  for (const auto& image : scene.images) {
    Levels& levels = images_.emplace_back();
    if (image->texels.empty()) continue;
    const Real cutoff = cutoff_of(scene, static_cast<uint32_t>(images_.size() - 1));
    const auto least = static_cast<int64_t>(std::ceil(255 * cutoff));
    Real share = 0;
    for (uint32_t number = 0;; ++number) {
      Level& level = levels.emplace_back(make_level(*image, number));
      if (number == 0) share = count_from(level.texels, least) / static_cast<Real>(level.texels.size());
      const bool keeps = number > 0 && least > 0 && least < 256 && share > 0 && share < 1;
      if (keeps) keep_share(level.texels, least, share);
      if (level.size == uvec2(1)) break;
    }
  }
}

Textures::Level Textures::make_level(const TextureImage& image, uint32_t number) {
  Level level;
  level.size = glm::max(uvec2(1), uvec2(image.size.x >> number, image.size.y >> number));
  if (number == 0) {
    for (const uint32_t texel : image.texels) level.texels.push_back(decode(texel, image.use));
    return level;
  }
  // Returns the length of the overlap of an image's texel and a level's texel along one side, times the size of the
  // level.
  const auto share = [](uint32_t from, uint32_t size, uint32_t to, uint32_t level_size) {
    const uint64_t lo = std::max<uint64_t>(uint64_t{from} * level_size, uint64_t{to} * size);
    const uint64_t hi = std::min<uint64_t>(uint64_t{from + 1} * level_size, uint64_t{to + 1} * size);
    return hi > lo ? static_cast<Real>(hi - lo) : Real(0);
  };
  for (uint32_t y = 0; y < level.size.y; ++y) {
    for (uint32_t x = 0; x < level.size.x; ++x) {
      Texel sum(0);
      for (uint32_t j = y * image.size.y / level.size.y; j < image.size.y; ++j) {
        const Real share_y = share(j, image.size.y, y, level.size.y);
        if (share_y == 0) break;
        for (uint32_t i = x * image.size.x / level.size.x; i < image.size.x; ++i) {
          const Real share_x = share(i, image.size.x, x, level.size.x);
          if (share_x == 0) break;
          sum += share_x * share_y * decode(image.texels[size_t{j} * image.size.x + i], image.use);
        }
      }
      const Real area = static_cast<Real>(image.size.x) * static_cast<Real>(image.size.y);
      level.texels.push_back(round_texel(sum / area, image.use));
    }
  }
  return level;
}

Texel Textures::sample(const Level& level, const Texture& texture, const Vector2& place, bool is_linear) {
  const auto texel = [&](int64_t x, int64_t y) {
    return level.texels[wrap(y, level.size.y, texture.wrap_v) * level.size.x + wrap(x, level.size.x, texture.wrap_u)];
  };
  const Vector2 scaled = place * Vector2(level.size);
  if (!is_linear) {
    return texel(static_cast<int64_t>(std::floor(scaled.x)), static_cast<int64_t>(std::floor(scaled.y)));
  }
  const Vector2 low = glm::floor(scaled - Real(0.5));
  const Vector2 part = scaled - Real(0.5) - low;
  const auto x = static_cast<int64_t>(low.x);
  const auto y = static_cast<int64_t>(low.y);
  const Texel upper = glm::mix(texel(x, y), texel(x + 1, y), part.x);
  const Texel lower = glm::mix(texel(x, y + 1), texel(x + 1, y + 1), part.x);
  return glm::mix(upper, lower, part.y);
}

bool Textures::shows(const TextureSlot& slot, const TrianglePoint& point) const {
  return slot.exists() && point.mesh != nullptr && !point.mesh->uvs.empty() &&
         !images_[scene_.textures[slot.texture].image].empty();
}

Texel Textures::filter(const TextureSlot& slot, const Vector2& place, Real level) const {
  const Texture& texture = scene_.textures[slot.texture];
  const Levels& levels = images_[texture.image];
  if (level <= 0) return sample(levels[0], texture, place, texture.is_magnified_linearly);
  const auto sample_level = [&](size_t number) {
    return sample(levels[number], texture, place, texture.is_minified_linearly);
  };
  if (!texture.has_levels) return sample_level(0);
  const size_t last = levels.size() - 1;
  level = std::min(level, static_cast<Real>(last));
  if (!texture.are_levels_linear) return sample_level(static_cast<size_t>(std::ceil(level + 0.5L)) - 1);
  const Real low = std::floor(level);
  const auto number = static_cast<size_t>(low);
  return glm::mix(sample_level(number), sample_level(std::min(number + 1, last)), level - low);
}

Real Textures::level_at(const TextureSlot& slot, const TrianglePoint& point) const {
  const uvec2 size = images_[scene_.textures[slot.texture].image][0].size;
  const UvEdges uv = uv_edges(slot, point);
  const Vector corner = corner_position(point, 0);
  const Real uv_area = std::abs(uv.to_b.x * uv.to_c.y - uv.to_b.y * uv.to_c.x);
  const Real area = glm::length(glm::cross(corner_position(point, 1) - corner, corner_position(point, 2) - corner));
  const Real texels = point.width * point.width * static_cast<Real>(size.x) * static_cast<Real>(size.y);
  return std::log2(texels * uv_area / area) / 2 - std::log2(std::max(point.cosine, kLeastCosine)) / 2;
}

Shown Textures::look_up(const TextureSlot& slot, const TrianglePoint& point) const {
  if (!shows(slot, point)) return {};
  const Vector2 place = coordinates_at(slot, point);
  const Real level = level_at(slot, point);
  Shown shown{filter(slot, place, level)};
  if (scene_.images[scene_.textures[slot.texture].image]->use == ImageUse::kColor) {
    shown.error = Texel(kDecodingError, kDecodingError, kDecodingError, 0);
  }
  shown.error += Texel(4 * kRoundoff);
  // The position is computed from the coordinates with a few rounded products and sums.
  Real largest = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector2 corner = glm::abs(corner_coordinates(slot, point, i));
    largest = std::max({largest, corner.x, corner.y});
  }
  const Vector2 place_error = steepness(slot, point) * point.place_error + Vector2(8 * kRoundoff * largest);
  const Real level_error = kLevelError + point.cosine_error / std::max(point.cosine, kLeastCosine);
  Texel off(0);
  for (const Real x : {-1, 1}) {
    for (const Real y : {-1, 1}) {
      for (const Real z : {-1, 1}) {
        const Texel other = filter(slot, place + Vector2(x, y) * place_error, level + z * level_error);
        off = glm::max(off, glm::abs(other - shown.value));
      }
    }
  }
  shown.error += off;
  return shown;
}

}  // namespace promin::oracle
