// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/picture_sources.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>
#include <string>
#include <utility>

#include "formats/gltf/image_bytes.h"
#include "promin/error.h"
#include "support/gltf_builder.h"
#include "support/make_jpeg.h"
#include "support/make_png.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::Ge;
using testing::IsEmpty;
using testing::Le;
using Bytes = std::vector<std::byte>;

constexpr size_t kHeadBytes = 65536;

/// Returns a file of 200 KB with the size in its first bytes.
Bytes make_long_png() {
  std::mt19937 random(1);
  std::vector<uint8_t> rows(size_t{3} * 256 * 256);
  std::ranges::generate(rows, [&] { return static_cast<uint8_t>(random()); });
  return make_png({256, 256}, PNG_COLOR_TYPE_RGB, 8, rows);
}

/// Returns a JPEG with 80,000 bytes of metadata before the size.
Bytes make_late_jpeg() {
  Bytes file = make_jpeg({24, 16}, std::vector<uint8_t>(size_t{3} * 24 * 16, 100));
  Bytes metadata(40000);
  const unsigned length = 40000 - 2;
  const unsigned head[] = {0xFF, 0xE1, length >> 8, length & 0xFF};
  for (size_t i = 0; i < 4; ++i) metadata[i] = static_cast<std::byte>(head[i]);
  for (int i = 0; i < 2; ++i) file.insert(file.begin() + 2, metadata.begin(), metadata.end());
  return file;
}

std::string_view text_of(const Bytes& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class PictureSourcesTest : public SceneFolder {
 protected:
  /// Reads a picture of these bytes. Returns the number of bytes of each request.
  std::vector<uint64_t> read(const Bytes& file, PictureSource& source) {
    std::vector<uint64_t> asked;
    read_picture(source, report_, [&](LoadReport&, uint64_t most_bytes) {
      asked.push_back(std::min<uint64_t>(most_bytes, file.size()));
      return Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(asked.back()));
    });
    decode_pictures({&source, 1}, report_);
    return asked;
  }

  LoadReport report_{folder_ / "scene.gltf"};
};

TEST_F(PictureSourcesTest, TheSizeTakesTheHeadAlone) {
  PictureSource source;
  source.takes_texels = false;
  EXPECT_THAT(read(make_long_png(), source), ElementsAre(kHeadBytes));
  EXPECT_EQ(source.image->size, uvec2(256));
  EXPECT_THAT(source.image->texels, IsEmpty());
  EXPECT_THAT(report_.warnings(), IsEmpty());
}

TEST_F(PictureSourcesTest, TexelsTakeTheWholeFile) {
  const Bytes file = make_long_png();
  PictureSource source;
  EXPECT_THAT(read(file, source), ElementsAre(file.size()));
  EXPECT_EQ(source.image->texels.size(), 256U * 256U);
}

TEST_F(PictureSourcesTest, ASizeBehindTheHeadIsReadFromTheWholeFile) {
  const Bytes file = make_late_jpeg();
  PictureSource source;
  source.takes_texels = false;
  EXPECT_THAT(read(file, source), ElementsAre(kHeadBytes, file.size()));
  EXPECT_EQ(source.image->size, uvec2(24, 16));
  EXPECT_THAT(report_.warnings(), IsEmpty());
}

TEST_F(PictureSourcesTest, WhatIsBrokenIsReadOnceWhereItIsShort) {
  PictureSource source;
  source.takes_texels = false;
  EXPECT_THAT(read(Bytes(100, std::byte{'x'}), source), ElementsAre(100U));
  EXPECT_EQ(report_.warnings().size(), 1U);
}

TEST_F(PictureSourcesTest, WhatIsDamagedButDecodedIsShownWithAWarning) {
  Bytes file = make_jpeg({16, 16}, std::vector<uint8_t>(size_t{3} * 16 * 16, 100));
  file.insert(file.end() - 2, 64, std::byte{0});
  PictureSource source;
  source.title = "\"photo\"";
  read(file, source);
  EXPECT_EQ(source.image->texels.size(), 256U);
  EXPECT_THAT(report_.warnings(),
              ElementsAre(AllOf(testing::StartsWith("image \"photo\": a picture is damaged (Corrupt JPEG data: "),
                                testing::EndsWith("); the part that can be decoded is shown"))));
  LoadReport strict(folder_ / "scene.gltf", true);
  source.file = file;
  decode_pictures({&source, 1}, strict);
  EXPECT_THROW(strict.throw_if_refused(), InputError);
}

/// Radiance stores a mantissa and an exponent: 128 / 256 * 2^(127 - 128) is 1/4, which is the byte 64; its code is 137.
TEST_F(PictureSourcesTest, OfPicturesOfLightColorsBecomeCodes) {
  const std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n\x80\x80\x80\x7F";
  const auto* first = reinterpret_cast<const std::byte*>(text.data());
  const Bytes file(first, first + text.size());
  for (const auto& [use, texel] : {std::pair(ImageUse::kData, 0xFF404040U), std::pair(ImageUse::kColor, 0xFF898989U)}) {
    PictureSource source;
    source.image->use = use;
    read(file, source);
    EXPECT_THAT(source.image->texels, ElementsAre(texel));
  }
}

TEST_F(PictureSourcesTest, GltfReadsHeadsOfFilesAndOfDataUris) {
  const Bytes file = make_long_png();
  write("long.png", text_of(file));
  GltfDocument document;
  document.json["images"] = {{{"uri", "long.png"}}, {{"uri", "data:image/png;base64," + encode_base64(text_of(file))}}};
  for (const size_t image : {0U, 1U}) {
    for (const bool takes_texels : {false, true}) {
      PictureSource source;
      source.takes_texels = takes_texels;
      read_gltf_image(document, image, source, report_);
      EXPECT_FALSE(source.problem);
      if (takes_texels) {
        EXPECT_EQ(source.file.size(), file.size());
      } else {
        EXPECT_THAT(source.file.size(), AllOf(Ge(kHeadBytes), Le(kHeadBytes + 3)));
      }
    }
  }
}

}  // namespace
}  // namespace promin
