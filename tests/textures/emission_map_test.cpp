// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/emission_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace promin {
namespace {

/// Returns the index of a texel inside the image for one outside.
int wrap_texel(int64_t i, int64_t count, TextureWrap mode) {
  if (mode == TextureWrap::kClampToEdge) return static_cast<int>(std::min(std::max(i, int64_t{0}), count - 1));
  const int64_t period = mode == TextureWrap::kMirroredRepeat ? 2 * count : count;
  const int64_t rest = (i % period + period) % period;
  return static_cast<int>(rest < count ? rest : period - 1 - rest);
}

/// An image with few white texels, and the texel at a coordinate.
struct SparseImage {
  uvec2 size;
  std::vector<uint32_t> texels;

  bool is_lit(const dvec2& uv, const Texture& texture) const {
    const dvec2 place = glm::floor(uv * dvec2(size));
    const int x = wrap_texel(static_cast<int64_t>(place.x), size.x, texture.wrap_u);
    const int y = wrap_texel(static_cast<int64_t>(place.y), size.y, texture.wrap_v);
    return texels[static_cast<size_t>(y) * size.x + static_cast<size_t>(x)] != 0xFF000000;
  }
};

constexpr std::array kWraps = {TextureWrap::kRepeat, TextureWrap::kMirroredRepeat, TextureWrap::kClampToEdge};

// A triangle that shows light is never left out, wherever its coordinates are and whatever the size of the image is.
TEST(EmissionMapTest, NoTriangleThatShowsLightIsDark) {
  std::mt19937 random(7);  // NOLINT(cert-msc51-cpp)
  const auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (static_cast<double>(random()) * 0x1p-32); };
  int lit_count = 0;
  int dark_count = 0;
  for (int i = 0; i < 3000; ++i) {
    SparseImage image{uvec2(uniform(1.0, 90.0), uniform(1.0, 90.0)), {}};
    image.texels.assign(size_t{image.size.x} * image.size.y, 0xFF000000);
    // The last column and row often make a square of their own.
    const size_t lit = i % 3 == 0 ? image.texels.size() - 1 : random() % image.texels.size();
    image.texels[lit] = 0xFFFFFFFF;
    Texture texture;
    texture.wrap_u = kWraps[random() % 3];
    texture.wrap_v = kWraps[random() % 3];
    const double extent = std::exp(uniform(-2.0, 0.0));
    const dvec2 about(uniform(-4.0, 4.0), uniform(-4.0, 4.0));
    std::array<dvec2, 3> corners;
    for (dvec2& corner : corners) corner = about + extent * dvec2(uniform(-0.5, 0.5), uniform(-0.5, 0.5));
    bool shows_light = false;
    for (int j = 0; j < 1000 && !shows_light; ++j) {
      double u = uniform(0.0, 1.0);
      double v = uniform(0.0, 1.0);
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      shows_light = image.is_lit(corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]), texture);
    }
    const float mean = EmissionMap(image.texels, image.size).mean_on(corners, texture).x;
    if (shows_light) {
      ++lit_count;
      ASSERT_GT(mean, 0.0F) << i << " " << image.size.x << "x" << image.size.y;
    }
    dark_count += mean == 0.0F ? 1 : 0;
  }
  EXPECT_GT(lit_count, 100);
  EXPECT_GT(dark_count, 300);
}

// A triangle shows a little of the last column, because texels are interpolated. A square of the plane contains this
// column, its mirror image and the columns on both sides.
TEST(EmissionMapTest, InterpolationAtAMirrorShowsLight) {
  constexpr uint32_t kSize = 33;
  std::vector<uint32_t> texels(size_t{kSize} * kSize, 0xFF000000);
  for (size_t i = kSize - 1; i < texels.size(); i += kSize) texels[i] = 0xFFFFFFFF;
  Texture texture;
  texture.wrap_u = TextureWrap::kMirroredRepeat;
  const std::array<dvec2, 3> corners = {dvec2(66.9, 10.0) / 33.0, dvec2(97.8, 10.0) / 33.0, dvec2(97.8, 11.0) / 33.0};
  EXPECT_GT(EmissionMap(texels, uvec2(kSize)).mean_on(corners, texture).x, 0.0F);
}

// The mean is that of the texels on the triangle, and it has the channels of linear light.
TEST(EmissionMapTest, MeansAreThoseOfTheTexels) {
  std::vector<uint32_t> texels(64 * 64, 0xFF000000);
  for (size_t i = 0; i < texels.size(); ++i) {
    if (i % 64 < 32) texels[i] = 0xFF8000FF;
  }
  const EmissionMap map(texels, uvec2(64));
  const Texture texture;
  const vec3 left = map.mean_on({dvec2(0.1), dvec2(0.4, 0.1), dvec2(0.1, 0.4)}, texture);
  EXPECT_NEAR(left.x, 1.0F, 1e-6F);
  EXPECT_EQ(left.y, 0.0F);
  EXPECT_NEAR(left.z, 0.2158605F, 1e-6F) << "the light of the code 128";
  EXPECT_EQ(map.mean_on({dvec2(0.6, 0.1), dvec2(0.9, 0.1), dvec2(0.6, 0.4)}, texture), vec3(0.0F));
  EXPECT_NEAR(map.mean_on({dvec2(0.0), dvec2(1.0, 0.0), dvec2(0.5, 1.0)}, texture).x, 0.5F, 0.02F);
  EXPECT_NEAR(map.mean_on({dvec2(0.0), dvec2(9.0, 0.0), dvec2(0.0, 7.0)}, texture).x, 0.5F, 1e-6F) << "many periods";
  for (const double far : {1e7, -1e12, 1e18}) {
    const vec3 mean = map.mean_on({dvec2(far), dvec2(far + 0.3, far), dvec2(far, far + 0.3)}, texture);
    EXPECT_TRUE(std::isfinite(mean.x) && mean.x >= 0.0F) << far;
  }
}

}  // namespace
}  // namespace promin
