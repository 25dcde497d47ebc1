// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/decode_picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <turbojpeg.h>

#include <array>
#include <cstring>

#include "promin/textures.h"
#include "support/make_png.h"

namespace promin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::ThrowsMessage;
using Bytes = std::vector<std::byte>;

Bytes make_jpeg(const uvec2& size, const std::vector<uint8_t>& rgb) {
  const tjhandle handle = tjInitCompress();
  unsigned char* bytes = nullptr;
  unsigned long count = 0;
  EXPECT_EQ(tjCompress2(handle, rgb.data(), static_cast<int>(size.x), 0, static_cast<int>(size.y), TJPF_RGB, &bytes,
                        &count, TJSAMP_444, 100, 0),
            0);
  const auto* first = reinterpret_cast<const std::byte*>(bytes);
  Bytes file(first, first + count);
  tjFree(bytes);
  tjDestroy(handle);
  return file;
}

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
  EXPECT_THAT(decoding({}), ThrowsMessage<PictureError>(HasSubstr("neither PNG nor JPEG")));
  EXPECT_THAT(decoding(Bytes(100, std::byte{'x'})), ThrowsMessage<PictureError>(HasSubstr("neither PNG nor JPEG")));
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

}  // namespace
}  // namespace promin
