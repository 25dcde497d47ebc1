// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/decode_picture.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <tuple>

#include "formats/gltf/buffers.h"
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
using std::string_literals::operator""s;

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
  EXPECT_THROW(decode_picture(cut), DecodeError);
  // The checksum of the header no longer fits.
  Bytes lying = png;
  lying[18] = std::byte{0xFF};
  EXPECT_THROW(decode_picture(lying), DecodeError);
  EXPECT_THAT(decoding({}), ThrowsMessage<DecodeError>(HasSubstr("its format is unknown")));
  EXPECT_THAT(decoding(Bytes(100, std::byte{'x'})), ThrowsMessage<DecodeError>(HasSubstr("its format is unknown")));
  Bytes jpeg = make_jpeg({16, 16}, std::vector<uint8_t>(16 * 16 * 3, 100));
  for (const size_t length : {4, 40, 160}) {
    const Bytes part(jpeg.begin(), jpeg.begin() + static_cast<std::ptrdiff_t>(length));
    EXPECT_THROW(decode_picture(part), DecodeError) << length;
  }
}

/// The library warns of such JPEGs and decodes the existing part.
TEST(DecodePicture, JpegsWithWarningsAreDecoded) {
  std::mt19937 random(3);
  std::vector<uint8_t> pixels(size_t{64} * 64 * 3);
  for (uint8_t& sample : pixels) sample = static_cast<uint8_t>(random());
  const Bytes whole = make_jpeg({64, 64}, pixels);
  const std::vector<uint32_t> texels = decode_picture(whole).texels;
  EXPECT_EQ(decode_picture(whole).warning, "");
  // Phones write padding before the end marker.
  Bytes padded = whole;
  padded.insert(padded.end() - 2, 8, std::byte{0});
  EXPECT_EQ(decode_picture(padded).texels, texels);
  EXPECT_THAT(decode_picture(padded).warning, HasSubstr("extraneous bytes before marker 0xd9"));

  Bytes cut = whole;
  cut.resize(cut.size() / 2);
  const DecodedPicture upper = decode_picture(cut);
  EXPECT_THAT(upper.warning, HasSubstr("Premature end"));
  constexpr std::ptrdiff_t kQuarter = 64 * 16;
  EXPECT_TRUE(std::equal(texels.begin(), texels.begin() + kQuarter, upper.texels.begin()));
  EXPECT_EQ(upper.texels.back(), 0xFF808080U) << "grey";
}

TEST(DecodePicture, AbsurdSizesAreRefusedBeforeTheyTakeMemory) {
  const uint32_t side = kMaxTextureSide + 1;
  const Bytes wide = make_png({side, 1}, PNG_COLOR_TYPE_GRAY, 1, std::vector<uint8_t>((side + 7) / 8, 0));
  EXPECT_THROW(read_picture_size(wide), DecodeError);
  // Each side is allowed, but the number of texels is not; the rest of the file does not matter.
  Bytes large = make_png({kMaxTextureSide, 1}, PNG_COLOR_TYPE_GRAY, 1, std::vector<uint8_t>(kMaxTextureSide / 8, 0));
  Bytes jpeg = make_jpeg({16, 16}, std::vector<uint8_t>(16 * 16 * 3, 0));
  for (size_t i = 0; i + 8 < jpeg.size(); ++i) {
    // The frame header has two bytes each for height and width.
    if (jpeg[i] != std::byte{0xFF} || jpeg[i + 1] != std::byte{0xC0}) continue;
    jpeg[i + 5] = jpeg[i + 7] = std::byte{0x40};
    jpeg[i + 6] = jpeg[i + 8] = std::byte{0x00};
    break;
  }
  EXPECT_THAT([&] { return read_picture_size(jpeg); }, ThrowsMessage<DecodeError>(HasSubstr("16384x16384")));
  EXPECT_EQ(read_picture_size(large), uvec2(kMaxTextureSide, 1));
}

/// Returns a picture of floats from 0 to 1, as OpenImageIO writes it.
Bytes make_by_plugin(const std::string& ending, const uvec2& size, int channels, const std::vector<float>& samples,
                     OIIO::TypeDesc type = OIIO::TypeDesc::UINT8) {
  const std::filesystem::path file =
      std::filesystem::path(testing::TempDir()) / (std::to_string(getpid()) + "." + ending);
  const std::unique_ptr<OIIO::ImageOutput> writer = OIIO::ImageOutput::create(file.string());
  OIIO::ImageSpec spec(static_cast<int>(size.x), static_cast<int>(size.y), channels, type);
  // The colours are not multiplied by alpha, and must stay so.
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

/// Returns an uncompressed DDS of BGRA.
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

/// Two lossless WebP files of two pixels, from cwebp -lossless -exact. One has red and (0, 128, 255); the other has
/// (200, 100, 50) with alpha 128 and (1, 2, 3) with alpha 0.
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
  EXPECT_THROW(decode_picture(cut), DecodeError);
}

/// This is how libavif encodes the pixels (200, 100, 50) with alpha 128 and (1, 2, 3) with alpha 0, losslessly.
constexpr std::string_view kAvif =
    "AAAAIGZ0eXBhdmlmAAAAAGF2aWZtaWYxbWlhZk1BMUEAAAGNbWV0YQAAAAAAAAAoaGRscgAAAAAAAAAAcGljdAAAAAAAAAAAAAAAAGxpYmF2"
    "aWYAAAAADnBpdG0AAAAAAAEAAAAsaWxvYwAAAABEAAACAAEAAAABAAABzgAAADYAAgAAAAEAAAG1AAAAGQAAAEJpaW5mAAAAAAACAAAAGmlu"
    "ZmUCAAAAAAEAAGF2MDFDb2xvcgAAAAAaaW5mZQIAAAAAAgAAYXYwMUFscGhhAAAAABppcmVmAAAAAAAAAA5hdXhsAAIAAQABAAAAw2lwcnAA"
    "AACdaXBjbwAAABRpc3BlAAAAAAAAAAIAAAABAAAAEHBpeGkAAAAAAwgICAAAAAxhdjFDgSAAAAAAABNjb2xybmNseAACAAIAAIAAAAAOcGl4"
    "aQAAAAABCAAAAAxhdjFDgQAcAAAAADhhdXhDAAAAAHVybjptcGVnOm1wZWdCOmNpY3A6c3lzdGVtczphdXhpbGlhcnk6YWxwaGEAAAAAHmlw"
    "bWEAAAAAAAAAAgABBAECgwQAAgQBBYYHAAAAV21kYXQSAAoEGAAmFTIPEACG0okpoqTPSS0ktKOAEgAKBzgAJhAgIAkyKRAAAIu7FZWwXzk9"
    "n1Z9YeYBb/1X36zAc5w50N1JZex9RC6rxFTEVM+g";

TEST(DecodePicture, Avif) {
  const Bytes file = decode_base64(kAvif).value();
  EXPECT_EQ(read_picture_size(file), uvec2(2, 1));
  EXPECT_THAT(decode_picture(file).texels, ElementsAre(0x803264C8U, 0x00030201U));
  const Bytes cut(file.begin(), file.end() - 40);
  EXPECT_THROW(decode_picture(cut), DecodeError);
}

/// The parts of a KTX 2.0 file.
struct Ktx2 {
  uint32_t vk_format = 37;
  uvec2 size{2, 1};
  std::vector<uint8_t> level = {200, 100, 50, 128, 1, 2, 3, 0};
  uint32_t supercompression = 0;
  /// The colour model of Khronos' data format: RGBSDA.
  uint8_t color_model = 1;
  std::string notes = {};
};

void append(std::string& text, std::initializer_list<uint32_t> numbers) {
  for (const uint32_t number : numbers) {
    for (uint32_t i = 0; i < 4; ++i) text += static_cast<char>(number >> (8 * i) & 0xFF);
  }
}

/// Returns an entry of a key and its value.
std::string make_note(const std::string& key, const std::string& value) {
  std::string note;
  append(note, {static_cast<uint32_t>(key.size() + value.size() + 2)});
  note += key + '\0' + value + '\0';
  note.resize((note.size() + 3) / 4 * 4);
  return note;
}

Bytes make_ktx2(const Ktx2& ktx2) {
  constexpr uint32_t kDescriptorBytes = 44;
  constexpr uint32_t kDescriptorAt = 80 + 24;
  const auto note_bytes = static_cast<uint32_t>(ktx2.notes.size());
  const auto level_bytes = static_cast<uint32_t>(ktx2.level.size());
  constexpr uint32_t kNotesAt = kDescriptorAt + kDescriptorBytes;
  std::string file = "\xABKTX 20\xBB\r\n\x1A\n";
  append(file, {ktx2.vk_format, 1, ktx2.size.x, ktx2.size.y, 0, 0, 1, 1, ktx2.supercompression});
  append(file, {kDescriptorAt, kDescriptorBytes, note_bytes == 0 ? 0 : kNotesAt, note_bytes, 0, 0, 0, 0});
  append(file, {kNotesAt + note_bytes, 0, level_bytes, 0, level_bytes, 0});
  append(file, {kDescriptorBytes, 0, 2 | 40U << 16, ktx2.color_model});
  file.resize(kNotesAt);
  file += ktx2.notes;
  file.append(ktx2.level.begin(), ktx2.level.end());
  const auto* first = reinterpret_cast<const std::byte*>(file.data());
  return {first, first + file.size()};
}

/// Returns a Zstandard frame (RFC 8878) of one block, which repeats a byte.
std::vector<uint8_t> repeat_by_zstd(uint8_t byte, uint8_t count) {
  return {0x28, 0xB5, 0x2F, 0xFD, 0x20, count, static_cast<uint8_t>(count << 3 | 3), static_cast<uint8_t>(count >> 5),
          0,    byte};
}

TEST(DecodePicture, Ktx2OfPlainChannels) {
  const auto decode = [](const Ktx2& ktx2) { return decode_picture(make_ktx2(ktx2)).texels; };
  EXPECT_EQ(read_picture_size(make_ktx2({})), uvec2(2, 1));
  for (const uint32_t rgba : {37, 43}) {
    EXPECT_THAT(decode({.vk_format = rgba}), ElementsAre(0x803264C8U, 0x00030201U));
  }
  EXPECT_THAT(decode({.vk_format = 50}), ElementsAre(0x80C86432U, 0x00010203U)) << "BGRA";
  EXPECT_THAT(decode({.vk_format = 29, .level = {1, 2, 3, 4, 5, 6}}), ElementsAre(0xFF030201U, 0xFF060504U));
  EXPECT_THAT(decode({.vk_format = 30, .level = {1, 2, 3, 4, 5, 6}}), ElementsAre(0xFF010203U, 0xFF040506U)) << "BGR";
  EXPECT_THAT(decode({.vk_format = 16, .level = {1, 2, 3, 4}}), ElementsAre(0xFF000201U, 0xFF000403U));
  EXPECT_THAT(decode({.vk_format = 9, .level = {7, 8}}), ElementsAre(0xFF000007U, 0xFF000008U));
  EXPECT_THAT(
      decode(
          {.vk_format = 9, .level = {7, 8}, .notes = make_note("KTXwriter", "me") + make_note("KTXswizzle", "rrr1")}),
      ElementsAre(0xFF070707U, 0xFF080808U))
      << "grey";
  EXPECT_THAT(decode({.vk_format = 9, .size = {1, 2}, .level = {7, 8}, .notes = make_note("KTXorientation", "ru")}),
              ElementsAre(0xFF000008U, 0xFF000007U))
      << "from the bottom";
}

TEST(DecodePicture, Ktx2BySupercompression) {
  EXPECT_THAT(decode_picture(make_ktx2({.level = repeat_by_zstd(9, 8), .supercompression = 2})).texels,
              ElementsAre(0x09090909U, 0x09090909U));
  const auto decoding = [](const Ktx2& ktx2) { return [ktx2] { return decode_picture(make_ktx2(ktx2)).size; }; };
  EXPECT_THAT(decoding({.level = repeat_by_zstd(9, 7), .supercompression = 2}),
              ThrowsMessage<DecodeError>(HasSubstr("Zstandard")));
  EXPECT_THAT(decoding({.supercompression = 3}),
              ThrowsMessage<DecodeError>(HasSubstr("supercompression 3 is not read")));
  EXPECT_THAT(decoding({.level = {1, 2, 3}}), ThrowsMessage<DecodeError>(HasSubstr("does not match its pixels")));
}

/// A picture of 43x38 with alpha that basisu 1.15 encodes with -ktx2.
constexpr std::string_view kEtc1s =
    "q0tUWCAyMLsNChoKAAAAAAEAAAArAAAAJgAAAAAAAAAAAAAAAQAAAAEAAAABAAAAaAAAADwAAACkAAAAJAAAAMgAAAAAAAAAQgIAAAAAAAAK"
    "AwAAAAAAAAUBAAAAAAAAAAAAAAAAAAA8AAAAAAAAAAIAOACjAQIAAwMAAAAAAAAAAAAAAAA/AAAAAAAAAAAA/////0AAPw8AAAAAAAAAAP//"
    "//8fAAAAS1RYd3JpdGVyAEJhc2lzIFVuaXZlcnNhbCAxLjE1AABTAD8A4wAAAM0AAABqAAAAAAAAAAAAAAAAAAAAoAAAAKAAAABlAAAAIEAE"
    "gEIYAgLo59TKvVbEmJkDAR5ADIAgCHRXUQ6fdE7TAEGABwACIAjDzqq7VDjmi7+QEIAJCAAAAIIAiFbLfNxaOfUNW2y2XGujq+eX/9cal9bn"
    "9z9mzybmhDlfdzVJeobzneNsF2zrK/aaPs+v0VuqvtaPdfm6pvYzdx8RkTMzZkZVtdZEBABI8t4TETFGAABIa03OOZkJQAAAUKp6++Hv/dnX"
    "qHDPl0TfaXx4HGrp5WNDtpvSdgDvVco61SLRhfaE9JsQbvYZO+OIhNfXMvit/Les+O5SavVeQzYAAAAAAACIB+IITAJBFIY/Zt8GQzBOzJpQ"
    "jsQCrWhJLH4IBeUUFpaU2HmEt2NjyRHGI3iDjQW1CXoIO///AQAYrhqG5VQixhgjDP9t27YQLZCfRkCDV0gXOOD7nSTVuhfEruuMlFL66e4W"
    "wPRvMZs1gEopsHwUEEIIm6/LUc7Qtg8TcAaoRZL3fT82M0l6c/ecc/ZSSprP52Mzk6T1ev3Zu7/eVn/H98/brdnhcNiBH1NKqQE+aq0bQYN0"
    "HWMcAd9H9/uX81k+CTe/k3A6rVZmZkgCAEGcAAIAhGGgBCTVeAccdIiAiMhIj58C4gAMwUAUhvP1PadnqKSsEiEaA5OBSRquiVac3g8IvKKW"
    "hKEATA97Q/QTrCgqpQfVjT35vrONVlCes010KrLNoZuKL1TwQjEAmAAAAAAAAEAAASzTTVJ6eeXqaY28r93YdujzivmvKNjX/1Z1W+/Mmyys"
    "4/U8VhuU53dLl3ijFp8276ejOStTzvnyRS66rT/2rwsbOaytaa66X1emt+GG+4e99MeVW3brp7wP+mPbouoplhljpvGm+s50xKm3epD+Dxk8"
    "vWukxO2uBPfi/FiM8HdVnbkxpkj6tlxESUZ7Oe8mshn++DEODhX0IpboZNtcJwEc02TAy4kbKMIlEsyvXDOe8sYJM1DDzh8JIK6LpswjXSI2"
    "03BIAXxAIFQhICqG/Aw62hIUAk6uJwJcENJEwQhAIgDyAV6AoOADXEQLAdEIIMh2IohrbEgcUYgRDTg4AAUIBAUBAQ==";
/// The value of checksum_of() for its texels. The colours are those that basisu unpacks as ETC1. Alpha differs by at
/// most 3 from basisu's ETC2, which stores alpha in a different kind of block.
constexpr uint64_t kEtc1sChecksum = 0x3556D1FF91637501;

uint64_t checksum_of(const std::vector<uint32_t>& texels) {
  uint64_t sum = 0;
  for (const uint32_t texel : texels) sum = 31 * sum + texel;
  return sum;
}

TEST(DecodePicture, Ktx2OfEtc1sByBasisLz) {
  const DecodedPicture picture = decode_picture(decode_base64(kEtc1s).value());
  EXPECT_EQ(picture.size, uvec2(43, 38));
  EXPECT_EQ(checksum_of(picture.texels), kEtc1sChecksum);
}

/// A UASTC block of each of the 19 modes, side by side, from basisu 1.15, and the RGBA that basisu unpacks from them as
/// ASTC.
constexpr std::string_view kUastc =
    "YUmzVJO1XNsQMlR2mLrc/vUJh8KDFoWHGwDw/w8AAACdWNCgoaGfn0GUJEmABEgAQzg20GSExRAJgADlcnk+ABOctIcOCRAEMUhK29jYWABL"
    "SA7fBt+mIAlggIQkAAAA21plkhrdUmiombru3CITRIeEBohKRwLqxV0S5XJycgAXHl7hv+QcAAAAAAAAAAAAT37w/4SFhTXh4eEfAP//KyrQ"
    "0clmumH+n1YIrz6Q+WkogmwtMIvvBgADdESLuMzPLtDxjqJIMln2zhEN9Vmf9Z8l3gHHx4GClhb8Owr69QXtgd5hZeUCpKXFvAyoUv0HBUW+"
    "BJjVZyoAAAAg8z/zH5UmfLhBAQL8I+EB/MvJ5eTlDGL1HxDgD/gH+Af4B/gH+UCruuqqQZBzEnsPylqv5g==";
constexpr std::string_view kUastcTexels =
    "NDU1/zc6Pv86QEf/PUVR/xS0PP8UtDz/FLQ8/xS0PP/x8Qn/8fEJ//HxCf/x8Qn/AAAA/0QHD/+MDx//0Rcu/x0o3f8NDQ3/NDqx/zxBmv/w"
    "8Ar/8PAK//DwCv9/f3//u9Rm/2dkrv+Snq7/kp6u/xOxOv8dokD/KZNH/zSETv/w8Ar/8PAK//DwCv/w8Ar/AAAA/wAAAP8AAAD/AAAA/+qT"
    "b4jqk5SI6pNgiOqTUohsG6n/bBup/2wbqQBsG6n/3SZakd4xWpHePVqQ3khajxwHWvAcB1rwHwda8B8HWvBWLlrMVi5azFYuWsxWLlrMYGBg"
    "n2BgYJ9gYGCfYGBgn0hISABYWFhUaGhoq3h4eP////8A////AICAgH+AgIB/ra2t/7CwsP+ysrL/tra2/0FMXP9EUmX/R1dv/0pdeP8UtDz/"
    "FLQ8/xS0PP8UtDz/8fEJ//HxCf/x8Qn/8fEJ/y4XF/9rHib/qyY2/+guRf8dKN3/DQ0N/zQ6sf88QZr/8PAK//DwCv+kpFj/pKRY/2dkrv8+"
    "Lq7/Z2Tz/2dk8//FICf/tCgv/6IxOP+ROkH/8PAK//DwCv/w8Ar/8PAK/////wD///8A////AP///wDqk4WI6pMFiOqT74jqk6KIbDep/2w3"
    "qQBsN6n/bDep/90mWpHeMVqR3kNakN5OWo8cB1rwHAda8B8HWvAfB1rwVjRazFY0WsxWNFrMVjRazGBgYJ9gYGCfYGBgn2BgYJ9ISEgAWFhY"
    "VGhoaKt4eHj/////AP///wCAgIB/gICAf7a2tv+5ubn/vb29/8DAwP9PZYb/UmuP/1Vwmf9ZdqL/Hijc/x4o3P8eKNz/Hijc/wAAAP8AAAD/"
    "gICA/4CAgP9cLi7/kj09/8pNTf//XFz/HSjd/w0NDf80OrH/PEGa//DwCv/LyzD/y8sw/8vLMP+71PP/kp7z/2dkIf9nZCH/E7E6/x2iQP8p"
    "k0f/NIRO//DwCv/w8Ar/8PAK//DwCv////8A////AP///wD///8A6pPhiOqTMYjqkwWI6pOUiGxVqQBsVan/bFWp/2xVqQDeK1qR3jdakN5D"
    "WpDeTlqPHwpa7x8KWu8cClrvHApa71Y6WsxWOlrMVjpazFY6WsxaWlqlWlpapVZWVqlWVlapUFBQAGBgYFRwcHCrgICA/////wD///8AgICA"
    "f4CAgH/AwMD/w8PD/8bGxv/Jycn/XHyt/2CCt/9jiMD/Zo3J/x4o3P8eKNz/Hijc/x4o3P8AAAD/AAAA/4CAgP+AgID/kj09/8pNTf//XFz/"
    "/1xc/x0o3f8NDQ3/NDqx/zxBmv/w8Ar/8PAK//DwCv/w8Ar/Pi4h/5KeIf+71Gb/u9Rm/xOxOv8dokD/KZNH/zSETv/w8Ar/8PAK//DwCv/w"
    "8Ar/WlpapVpaWqVaWlqlWlpapeqTlIjqk++I6pOUiOqTYIhscan/bHGp/2xxqQBscan/3itakd43WpDeQ1qQ3k5ajx8KWu8fClrvHApa7xwK"
    "Wu9WQFrLVkBay1ZAWstWQFrLWlpapVpaWqVWVlapVlZWqVBQUABgYGBUcHBwq4CAgP////8A////AICAgH+AgIB/ycnJ/8zMzP/Q0ND/0tLS"
    "/w==";

TEST(DecodePicture, Ktx2OfUastcInEachMode) {
  const Bytes blocks = decode_base64(kUastc).value();
  const Bytes expected = decode_base64(kUastcTexels).value();
  Ktx2 ktx2 = {.vk_format = 0, .size = {76, 4}, .level = {}, .color_model = 166};
  for (const std::byte byte : blocks) ktx2.level.push_back(std::to_integer<uint8_t>(byte));
  const DecodedPicture picture = decode_picture(make_ktx2(ktx2));
  ASSERT_EQ(4 * picture.texels.size(), expected.size());
  EXPECT_EQ(std::memcmp(picture.texels.data(), expected.data(), expected.size()), 0);
  // If the sides are not multiples of 4, blocks are cut.
  ktx2.size = {75, 3};
  const DecodedPicture cut = decode_picture(make_ktx2(ktx2));
  EXPECT_EQ(cut.texels.at(75 + 74), picture.texels.at(76 + 74));
  // No mode begins with the seven bits of 69.
  ktx2.level[0] = 69;
  EXPECT_THAT([&] { return decode_picture(make_ktx2(ktx2)).size; },
              ThrowsMessage<DecodeError>(HasSubstr("a UASTC block is damaged")));
}

/// For any bits, the result is a picture or an error.
TEST(DecodePicture, DamagedEtc1sIsToldOf) {
  std::mt19937 random(11);
  const Bytes file = decode_base64(kEtc1s).value();
  int broken = 0;
  for (int i = 0; i < 300; ++i) {
    Bytes mutant = file;
    mutant[80 + random() % (mutant.size() - 80)] = static_cast<std::byte>(random());
    if (i % 3 == 0) mutant.resize(random() % mutant.size());
    try {
      const DecodedPicture picture = decode_picture(mutant);
      EXPECT_EQ(picture.texels.size(), 43U * 38U);
    } catch (const DecodeError&) {
      ++broken;
    }
  }
  EXPECT_GT(broken, 100);
}

TEST(DecodePicture, Ktx2OfOtherFormatsNamesWhatConvertsIt) {
  const auto decoding = [](const Ktx2& ktx2) { return [ktx2] { return read_picture_size(make_ktx2(ktx2)); }; };
  EXPECT_THAT(decoding({.vk_format = 145}), ThrowsMessage<DecodeError>(HasSubstr("VkFormat 145 is not read")));
  EXPECT_THAT(decoding({.vk_format = 0, .color_model = 200}), ThrowsMessage<DecodeError>(HasSubstr("ktx extract")));
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
                ThrowsMessage<DecodeError>(HasSubstr("65535x65535 is too large")));
  }
  EXPECT_THAT(size_of(put(make_by_plugin("bmp", {2, 3}, 3, rgb), 18, {0, 0, 1, 0, 0, 0, 0, 0xFF})),
              ThrowsMessage<DecodeError>(HasSubstr("65536x16777216 is too large")));
  EXPECT_THAT(size_of(make_dds({100000, 2}, {})), ThrowsMessage<DecodeError>(HasSubstr("100000x2 is too large")));
  EXPECT_THAT(size_of(make_dds({0, 2}, {})), ThrowsMessage<DecodeError>(HasSubstr("no pixels")));
}

TEST(DecodePicture, RadianceStandsUprightWhateverTheOrderOfItsRows) {
  const std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n+Y 2 +X 1\n\x80\0\0\x81\0\0\x80\x81"s;
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  EXPECT_THAT(decode_picture(Bytes(first, first + text.size())).texels, ElementsAre(0xFFFF0000U, 0xFF0000FFU));
}

/// For any bytes, the result is a picture of the declared size, or an error.
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
      } catch (const DecodeError& error) {
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
  EXPECT_STREQ(format_of("\x00\x00\x00\x20"
                         "ftypavif"sv),
               "avif");
  EXPECT_STREQ(format_of("\xABKTX 20\xBB\r\n\x1A\n"sv), "ktx2");
  EXPECT_STREQ(format_of("\xABKTX 11\xBB\r\n\x1A\n"sv), "");
  EXPECT_STREQ(format_of("#?RADIANCE\n"sv), "hdr");
  EXPECT_STREQ(format_of("\x00\x00\x02\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01\x00\x01\x00\x18\x00xyz"sv), "targa");
  EXPECT_STREQ(format_of("\x00\x00\x02\x00\x00\x00\x00\x00\x00\x00\x00\x00\x01\x00\x01\x00\x19\x00xyz"sv), "");
  EXPECT_STREQ(format_of("#"sv), "");
}

}  // namespace
}  // namespace promin
