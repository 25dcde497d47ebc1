// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests compare what a window shows (shaders/window/encode_film.comp) with the content of PNG files.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "device/device.h"
#include "device/pipeline.h"
#include "gpu/device_fixture.h"
#include "image/dither.h"
#include "promin/display.h"
#include "promin/image.h"
#include "view/display/traced_picture.h"

namespace promin::app {
namespace {

constexpr uint32_t kSamples = 2;
constexpr uvec2 kSize(40, 25);

/// Returns sums of two samples. Each pixel has another colour, from black to far beyond white.
std::vector<vec3> make_sums() {
  std::vector<vec3> sums;
  float x = 1e-4F;
  for (uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
    const float share = static_cast<float>(i % 7) / 6.0F;
    sums.push_back(x * vec3(1.0F, share, 1.0F - share));
    x *= 1.02F;
  }
  sums.front() = vec3(0.0F);
  return sums;
}

class EncodeFilmTest : public test::DeviceTest {
 protected:
  /// Returns the bytes that the window shows: R, G and B of each pixel.
  static std::vector<std::array<int, 3>> encode(const std::vector<vec3>& sums, const DisplayTransform& display,
                                                const std::vector<vec4>& unlit = {}) {
    constexpr auto kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
    layout::FilmHead head{};
    head.dispatch.window = uvec4(0, 0, kSize);
    head.dispatch.sampling.x = kSamples;
    // The numbers between the pixels must not be used as pixels.
    std::ranges::fill(head.ray_counts, uvec4(std::bit_cast<uint32_t>(1e9F)));
    gpu::Buffer film(device(), sizeof head + (sums.size() + unlit.size()) * sizeof(uvec4), kStorage);
    film.write(std::as_bytes(std::span(&head, 1)));
    std::vector<uvec4> pixels;
    for (const vec3& sum : sums) pixels.emplace_back(glm::floatBitsToUint(sum), 0U);
    for (const vec4& sum : unlit) pixels.push_back(glm::floatBitsToUint(sum));
    film.write(std::as_bytes(std::span(pixels)), sizeof head);

    gpu::Buffer exposure(device(), sizeof(float), kStorage);
    const float factor = std::exp2(display.exposure_ev);
    exposure.write(std::as_bytes(std::span(&factor, 1)));
    const gpu::Buffer encoded(device(), sums.size() * sizeof(uint32_t), kStorage);
    const gpu::ComputePipeline encoder = make_encoder(device(), film, encoded, exposure, display, !unlit.empty());
    device().run([&](const vk::raii::CommandBuffer& commands) { encoder.dispatch(commands, uvec2(3, 1)); });
    std::vector<uint32_t> words(sums.size());
    encoded.read(std::as_writable_bytes(std::span(words)));
    std::vector<std::array<int, 3>> bytes;
    for (const uint32_t word : words) {
      EXPECT_EQ(word >> 24, 255U);
      bytes.push_back(
          {static_cast<int>(word & 255U), static_cast<int>(word >> 8 & 255U), static_cast<int>(word >> 16 & 255U)});
    }
    return bytes;
  }
};

TEST_F(EncodeFilmTest, UnlitSurfacesAreShownAsInPngFiles) {
  std::vector<vec3> sums;
  std::vector<vec4> unlit;
  for (uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
    const float share = static_cast<float>(i % 5) / 4.0F;
    const float x = static_cast<float>(i) / static_cast<float>(kSize.x * kSize.y);
    unlit.push_back(static_cast<float>(kSamples) * share * vec4(x, 1.0F - x, 0.5F, 1.0F));
    sums.push_back(vec3(unlit.back()) + (1.0F - share) * vec3(4.0F * x, 1.0F, 0.1F));
  }
  const DisplayTransform display{1.0F, ToneMapping::kReinhard};
  const std::vector<std::array<int, 3>> shown = encode(sums, display, unlit);
  for (size_t i = 0; i < sums.size(); ++i) {
    const auto samples = static_cast<float>(kSamples);
    const vec3 expected = apply(display, sums[i] / samples, unlit[i] / samples);
    for (int c = 0; c < 3; ++c) {
      const auto in_file = static_cast<int>(std::lround(255.0F * encode_srgb(expected[c])));
      ASSERT_LE(std::abs(shown[i][static_cast<size_t>(c)] - in_file), 1) << "pixel " << i;
    }
  }
}

TEST_F(EncodeFilmTest, AWindowShowsWhatPngFilesHave) {
  const std::vector<vec3> sums = make_sums();
  for (const DisplayTransform& display :
       {DisplayTransform{}, DisplayTransform{-2.5F, ToneMapping::kNone}, DisplayTransform{0.0F, ToneMapping::kNeutral},
        DisplayTransform{3.0F, ToneMapping::kNeutral}, DisplayTransform{-1.0F, ToneMapping::kAces},
        DisplayTransform{2.0F, ToneMapping::kReinhard}, DisplayTransform{0.0F, ToneMapping::kAgx},
        DisplayTransform{0.0F, ToneMapping::kNone, true}}) {
    const std::vector<std::array<int, 3>> shown = encode(sums, display);
    int differing = 0;
    for (size_t i = 0; i < sums.size(); ++i) {
      const vec3 expected = apply(display, sums[i] / static_cast<float>(kSamples));
      for (int c = 0; c < 3; ++c) {
        float code = 255.0F * encode_srgb(expected[c]);
        const auto at = static_cast<uint32_t>(i);
        if (display.dithers) code = dithered(code, at % kSize.x, at / kSize.x, static_cast<uint32_t>(c));
        const auto in_file = static_cast<int>(std::lround(code));
        const int in_window = shown[i][static_cast<size_t>(c)];
        // The device's pow may round differently.
        ASSERT_LE(std::abs(in_window - in_file), 1) << "pixel " << i << ", radiance " << sums[i][c];
        differing += in_window == in_file ? 0 : 1;
      }
    }
    EXPECT_LT(differing, 6) << "of 3000";
  }
}

}  // namespace
}  // namespace promin::app
