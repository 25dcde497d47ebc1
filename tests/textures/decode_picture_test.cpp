// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/decode_picture.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <tuple>

#include "image/picture_formats.h"
#include "promin/textures.h"
#include "support/make_jpeg.h"
#include "support/make_png.h"

namespace promin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Bytes = std::vector<std::byte>;

TEST(DecodePicture, PngOfEveryKindBecomesRgba) {
  EXPECT_THAT(decode_picture(make_png({2, 1}, PNG_COLOR_TYPE_RGB, 8, {1, 2, 3, 4, 5, 6})).texels,
              ElementsAre(0xFF030201U, 0xFF060504U));
  EXPECT_THAT(decode_picture(make_png({1, 1}, PNG_COLOR_TYPE_RGBA, 8, {1, 2, 3, 0})).texels, ElementsAre(0x00030201U))
      << "colours under alpha 0 stay";
  EXPECT_THAT(decode_picture(make_png({2, 1}, PNG_COLOR_TYPE_GRAY, 8, {7, 200})).texels,
              ElementsAre(0xFF070707U, 0xFFC8C8C8U))
      << "the file's gamma is ignored";
  EXPECT_THAT(decode_picture(make_png({2, 1}, PNG_COLOR_TYPE_GRAY, 1, {0x40})).texels,
              ElementsAre(0xFF000000U, 0xFFFFFFFFU));
  EXPECT_THAT(decode_picture(make_png({1, 1}, PNG_COLOR_TYPE_GRAY_ALPHA, 8, {9, 5})).texels, ElementsAre(0x05090909U));
  EXPECT_THAT(decode_picture(make_png({1, 1}, PNG_COLOR_TYPE_GRAY, 16, {0x80, 0x7F})).texels, ElementsAre(0xFF808080U))
      << "16 bits are rounded: 255 * 0x807F / 65535 = 127.996";
  EXPECT_THAT(decode_picture(make_png({2, 1}, PNG_COLOR_TYPE_PALETTE, 8, {1, 0}, {{10, 20, 30}, {40, 50, 60}})).texels,
              ElementsAre(0xFF3C3228U, 0xFF1E140AU));
}

TEST(DecodePicture, Jpeg) {
  const DecodedPicture picture = decode_picture(make_jpeg({16, 8}, std::vector<uint8_t>(16 * 8 * 3, 100)));
  EXPECT_EQ(picture.size, uvec2(16, 8));
  EXPECT_THAT(picture.texels, testing::Each(0xFF646464U));
}

TEST(DecodePicture, TheSizeNeedsTheHeaderAlone) {
  const Bytes png = make_png({3, 2}, PNG_COLOR_TYPE_GRAY, 8, {1, 2, 3, 4, 5, 6});
  EXPECT_EQ(read_picture_size(png), uvec2(3, 2));
  EXPECT_EQ(read_picture_size(std::span(png).first(60)), uvec2(3, 2));
  EXPECT_EQ(read_picture_size(make_jpeg({5, 7}, std::vector<uint8_t>(5 * 7 * 3, 0))), uvec2(5, 7));
}

TEST(DecodePicture, BrokenFilesAreToldOf) {
  const auto decoding = [](const Bytes& file) { return [file] { return decode_picture(file).size; }; };
  Bytes png = make_png({4, 4}, PNG_COLOR_TYPE_GRAY, 8, std::vector<uint8_t>(16, 1));
  Bytes cut = png;
  cut.resize(png.size() - 20);
  EXPECT_THROW(decode_picture(cut), PictureError);
  // The sum over the header no longer fits.
  Bytes lying = png;
  lying[18] = std::byte{0xFF};
  EXPECT_THROW(decode_picture(lying), PictureError);
  EXPECT_THAT(decoding({}), ThrowsMessage<PictureError>(HasSubstr("of no known format")));
  EXPECT_THAT(decoding(Bytes(100, std::byte{'x'})), ThrowsMessage<PictureError>(HasSubstr("of no known format")));
  Bytes jpeg = make_jpeg({16, 16}, std::vector<uint8_t>(16 * 16 * 3, 100));
  for (const size_t length : {size_t{4}, size_t{40}, jpeg.size() / 2, jpeg.size() - 2}) {
    const Bytes part(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(decode_picture(part), PictureError) << length;
  }
}

TEST(DecodePicture, AbsurdSizesAreRefusedBeforeTheyTakeMemory) {
  const uint32_t side = kMaxTextureSide + 1;
  const Bytes wide = make_png({side, 1}, PNG_COLOR_TYPE_GRAY, 1, std::vector<uint8_t>((side + 7) / 8, 0));
  EXPECT_THROW(read_picture_size(wide), PictureError);
  // Each side is allowed, all texels are not; the rest of the file does not matter.
  Bytes large = make_png({kMaxTextureSide, 1}, PNG_COLOR_TYPE_GRAY, 1, std::vector<uint8_t>(kMaxTextureSide / 8, 0));
  Bytes jpeg = make_jpeg({16, 16}, std::vector<uint8_t>(16 * 16 * 3, 0));
  for (size_t i = 0; i + 8 < jpeg.size(); ++i) {
    // The frame header: two bytes each of height and width.
    if (jpeg[i] != std::byte{0xFF} || jpeg[i + 1] != std::byte{0xC0}) continue;
    jpeg[i + 5] = jpeg[i + 7] = std::byte{0x40};
    jpeg[i + 6] = jpeg[i + 8] = std::byte{0x00};
    break;
  }
  EXPECT_THAT([&] { return read_picture_size(jpeg); }, ThrowsMessage<PictureError>(HasSubstr("16384x16384")));
  EXPECT_EQ(read_picture_size(large), uvec2(kMaxTextureSide, 1));
}

/// A picture as OpenImageIO writes it, of floats from 0 to 1.
Bytes make_by_plugin(const std::string& ending, const uvec2& size, int channels, const std::vector<float>& samples,
                     OIIO::TypeDesc type = OIIO::TypeDesc::UINT8) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / ("decode_picture_test." + ending);
  const std::unique_ptr<OIIO::ImageOutput> writer = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), channels, type);
  // Colours come unassociated, and are to stay so.
  spec.attribute("oiio:UnassociatedAlpha", 1);
  spec.attribute("compression", "lossless");
  EXPECT_TRUE(writer && writer->open(file.string(), spec) &&
              writer->write_image(OIIO::TypeDesc::FLOAT, samples.data()) && writer->close())
      << ending;
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(file);
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  return {first, first + text.size()};
}

/// An uncompressed DDS of BGRA.
Bytes make_dds(const uvec2& size, const std::vector<uint32_t>& texels) {
  std::array<uint32_t, 32> header{};
  header[0] = 0x20534444;  // "DDS "
  header[1] = 124;
  header[2] = 0x100F;
  header[3] = size.y;
  header[4] = size.x;
  header[5] = 4 * size.x;
  header[19] = 32;
  header[20] = 0x41;
  header[22] = 32;
  header[23] = 0x00FF0000;
  header[24] = 0x0000FF00;
  header[25] = 0x000000FF;
  header[26] = 0xFF000000;
  header[27] = 0x1000;
  Bytes file(sizeof(header) + 4 * texels.size());
  std::memcpy(file.data(), header.data(), sizeof(header));
  std::memcpy(file.data() + sizeof(header), texels.data(), 4 * texels.size());
  return file;
}

constexpr float kByte = 1.0F / 255.0F;

TEST(DecodePicture, OtherFormatsAreReadByThePlugin) {
  const std::vector<float> rgb = {255 * kByte, 0, 0, 0, 128 * kByte, 255 * kByte};
  const auto colors = ElementsAre(0xFF0000FFU, 0xFFFF8000U);
  for (const char* ending : {"tga", "bmp"}) {
    EXPECT_THAT(decode_picture(make_by_plugin(ending, {2, 1}, 3, rgb)).texels, colors) << ending;
  }
  const std::vector<float> primaries = {1, 0, 0, 0, 1, 1};
  EXPECT_THAT(decode_picture(make_by_plugin("gif", {2, 1}, 3, primaries)).texels,
              ElementsAre(0xFF0000FFU, 0xFFFFFF00U));
  EXPECT_THAT(decode_picture(make_dds({2, 1}, {0x40102030, 0xFF000102})).texels, ElementsAre(0x40302010U, 0xFF020100U));
  const std::vector<float> radiance = {2, 0.5F, -1, 0, 1, 0.25F};
  EXPECT_THAT(decode_picture(make_by_plugin("exr", {2, 1}, 3, radiance, OIIO::TypeDesc::FLOAT)).texels,
              ElementsAre(0xFF0080FFU, 0xFF40FF00U));
  EXPECT_THAT(decode_picture(make_by_plugin("hdr", {2, 1}, 3, {4, 1, 0, 0, 1, 0}, OIIO::TypeDesc::FLOAT)).texels,
              ElementsAre(0xFF00FFFFU, 0xFF00FF00U));
}

Bytes bytes_of(const std::vector<uint8_t>& numbers) {
  const auto* first = reinterpret_cast<const std::byte*>(numbers.data());
  return {first, first + numbers.size()};
}

/// Lossless WebP files of two pixels, as cwebp -lossless -exact makes them: red and (0, 128, 255); and (200, 100, 50)
/// with alpha 128 beside (1, 2, 3) with alpha 0.
const std::vector<uint8_t> kWebpColors = {0x52, 0x49, 0x46, 0x46, 0x20, 0x00, 0x00, 0x00, 0x57, 0x45,
                                          0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x13, 0x00, 0x00, 0x00,
                                          0x2f, 0x01, 0x00, 0x00, 0x00, 0x0f, 0x30, 0x80, 0xfb, 0x3f,
                                          0xff, 0xf3, 0x1f, 0x5a, 0xa8, 0x40, 0x44, 0xff, 0x03, 0x00};
const std::vector<uint8_t> kWebpAlphas = {0x52, 0x49, 0x46, 0x46, 0x26, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50,
                                          0x56, 0x50, 0x38, 0x4c, 0x19, 0x00, 0x00, 0x00, 0x2f, 0x01, 0x00, 0x00,
                                          0x10, 0x0f, 0x70, 0x01, 0xb1, 0x3d, 0x26, 0xc8, 0xb6, 0x0d, 0x6d, 0x3b,
                                          0xd0, 0x07, 0x30, 0x98, 0x1f, 0x19, 0xd1, 0xff, 0x00, 0x00};

TEST(DecodePicture, WebP) {
  EXPECT_THAT(decode_picture(bytes_of(kWebpColors)).texels, ElementsAre(0xFF0000FFU, 0xFFFF8000U));
  Bytes cut = bytes_of(kWebpColors);
  cut.resize(cut.size() - 6);
  EXPECT_THROW(decode_picture(cut), PictureError);
}

TEST(DecodePicture, ColoursAreNotMultipliedByAlpha) {
  EXPECT_THAT(decode_picture(bytes_of(kWebpAlphas)).texels, ElementsAre(0x803264C8U, 0x00030201U));
  const std::vector<float> rgba = {200 * kByte, 100 * kByte, 50 * kByte, 128 * kByte};
  EXPECT_THAT(decode_picture(make_by_plugin("tga", {1, 1}, 4, rgba)).texels, ElementsAre(0x803264C8U));
}

TEST(DecodePicture, GreyIsSpreadOverColours) {
  EXPECT_THAT(decode_picture(make_by_plugin("tga", {2, 1}, 1, {0.2F, 1})).texels,
              ElementsAre(0xFF333333U, 0xFFFFFFFFU));
  EXPECT_THAT(decode_picture(make_by_plugin("exr", {1, 1}, 1, {0.4F}, OIIO::TypeDesc::HALF)).texels,
              ElementsAre(0xFF666666U));
}

TEST(DecodePicture, AbsurdSizesOfOtherFormatsAreRefusedByTheirHeader) {
  const auto size_of = [](const Bytes& file) { return [file] { return read_picture_size(file); }; };
  const auto put = [](Bytes file, size_t place, std::initializer_list<int> bytes) {
    for (const int byte : bytes) file.at(place++) = static_cast<std::byte>(byte);
    return file;
  };
  const std::vector<float> rgb(2 * 3 * 3, 0.5F);
  for (const auto& [ending, place, size] : {std::tuple("gif", 6, uvec2(2, 3)), std::tuple("tga", 12, uvec2(2, 3))}) {
    const Bytes file = make_by_plugin(ending, {2, 3}, 3, rgb);
    EXPECT_EQ(read_picture_size(file), size) << ending;
    EXPECT_THAT(size_of(put(file, static_cast<size_t>(place), {0xFF, 0xFF, 0xFF, 0xFF})),
                ThrowsMessage<PictureError>(HasSubstr("65535x65535 is too large")));
  }
  EXPECT_THAT(size_of(put(make_by_plugin("bmp", {2, 3}, 3, rgb), 18, {0, 0, 1, 0, 0, 0, 0, 0xFF})),
              ThrowsMessage<PictureError>(HasSubstr("65536x16777216 is too large")));
  EXPECT_THAT(size_of(make_dds({100000, 2}, {})), ThrowsMessage<PictureError>(HasSubstr("100000x2 is too large")));
  EXPECT_THAT(size_of(make_dds({0, 2}, {})), ThrowsMessage<PictureError>(HasSubstr("no pixels")));
}

/// Whatever the bytes, there is a picture of the size that was told, or an error.
TEST(DecodePicture, BrokenFilesOfOtherFormatsAreToldOf) {
  std::mt19937 random(5);
  std::vector<float> samples(16 * 16 * 4);
  for (float& sample : samples) sample = static_cast<float>(random() % 256) * kByte;
  int broken = 0;
  for (const char* ending : {"webp", "tga", "bmp", "gif", "exr", "hdr"}) {
    const bool is_float = ending == std::string_view("exr") || ending == std::string_view("hdr");
    const Bytes good = make_by_plugin(ending, {16, 16}, ending == std::string_view("hdr") ? 3 : 4, samples,
                                      is_float ? OIIO::TypeDesc::FLOAT : OIIO::TypeDesc::UINT8);
    for (int i = 0; i < 60; ++i) {
      Bytes mutant = good;
      for (uint32_t k = 0; k < 1 + random() % 3; ++k)
        mutant[random() % mutant.size()] = static_cast<std::byte>(random());
      if (random() % 3 == 0) mutant.resize(random() % mutant.size());
      try {
        const DecodedPicture picture = decode_picture(mutant);
        EXPECT_EQ(picture.texels.size(), uint64_t{picture.size.x} * picture.size.y);
      } catch (const PictureError& error) {
        ++broken;
        EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      }
    }
  }
  EXPECT_GT(broken, 30);
}

TEST(DecodePicture, FormatsAreToldByTheirFirstBytes) {
  const auto format_of = [](std::string_view bytes) {
    const PictureFormat* format = find_picture_format(std::as_bytes(std::span(bytes)));
    return format == nullptr ? "" : format->name;
  };
  using std::string_view_literals::operator""sv;
  EXPECT_STREQ(format_of("RIFF\x01\x02\x03\x04WEBPVP8 "sv), "webp");
  EXPECT_STREQ(format_of("RIFF\x01\x02\x03\x04WAVE"sv), "");
  EXPECT_STREQ(format_of("#?RADIANCE\n"sv), "hdr");
  EXPECT_STREQ(format_of("\x00\x00\x02\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01\x00\x01\x00\x18\x00xyz"sv), "targa");
  EXPECT_STREQ(format_of("\x00\x00\x02\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01\x00\x01\x00\x19\x00xyz"sv), "");
  EXPECT_STREQ(format_of("#"sv), "");
}

}  // namespace
}  // namespace promin
