// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/image.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <limits>
#include <tuple>

#include "core/file.h"
#include "promin/error.h"
#include "support/file_size_limit.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

/// Returns a picture in which every channel of every pixel differs, with values beyond [0, 1].
Image make_ramp_image(uint32_t width, uint32_t height) {
  Image image;
  image.size = uvec2(width, height);
  for (uint32_t i = 0; i < width * height; ++i) {
    const auto x = static_cast<float>(i);
    image.pixels.emplace_back(x / 7.0F, -x, x * 1e6F);
  }
  return image;
}

class ImageTest : public TempFolder {
 protected:
  std::ptrdiff_t file_count() const { return std::distance(fs::directory_iterator(folder_), {}); }
};

std::string message_of_reading(const fs::path& file) {
  return message_of([&] { read_image(file); });
}

TEST(EncodeSrgbTest, KnownValues) {
  // These values of IEC 61966-2-1 were computed with 50 digits.
  EXPECT_EQ(encode_srgb(0.0F), 0.0F);
  EXPECT_EQ(encode_srgb(1.0F), 1.0F);
  EXPECT_FLOAT_EQ(encode_srgb(0.001F), 0.01292F);
  EXPECT_FLOAT_EQ(encode_srgb(0.003F), 0.038760000F);
  EXPECT_FLOAT_EQ(encode_srgb(0.0032F), 0.041323358F);
  EXPECT_FLOAT_EQ(encode_srgb(0.18F), 0.46135614F);
  EXPECT_FLOAT_EQ(encode_srgb(0.5F), 0.73535698F);
}

TEST(EncodeSrgbTest, ClampsAndTakesNanAsBlack) {
  EXPECT_EQ(encode_srgb(-1.0F), 0.0F);
  EXPECT_EQ(encode_srgb(7.0F), 1.0F);
  EXPECT_EQ(encode_srgb(std::numeric_limits<float>::infinity()), 1.0F);
  EXPECT_EQ(encode_srgb(std::numeric_limits<float>::quiet_NaN()), 0.0F);
}

TEST(ImageFormatTest, EndingsAreKnownInAnyCase) {
  EXPECT_TRUE(is_writable_format("a.exr"));
  EXPECT_TRUE(is_writable_format("folder.d/A.PNG"));
  EXPECT_TRUE(is_writable_format("a.jpg"));
  EXPECT_TRUE(is_writable_format("a.JPEG"));
  EXPECT_TRUE(is_writable_format("a.webp"));
  EXPECT_TRUE(is_writable_format("a.tif"));
  EXPECT_TRUE(is_writable_format("a.TIFF"));
  EXPECT_TRUE(is_writable_format("a.hdr"));
  EXPECT_FALSE(is_writable_format("a.gif"));
  EXPECT_FALSE(is_writable_format("exr"));
  EXPECT_FALSE(is_writable_format(""));
}

TEST_F(ImageTest, ExrKeepsEveryBit) {
  const Image image = make_ramp_image(17, 5);
  write_image(folder_ / "a.exr", image);
  const Image back = read_image(folder_ / "a.exr");
  EXPECT_EQ(back.size, image.size);
  EXPECT_EQ(back.pixels, image.pixels);
  EXPECT_EQ(file_count(), 1);
}

TEST_F(ImageTest, EqualPicturesGiveEqualBytes) {
  const Metadata metadata = {{"promin:scene", "a.gltf"}};
  write_image(folder_ / "a.exr", make_ramp_image(64, 64), metadata);
  write_image(folder_ / "b.exr", make_ramp_image(64, 64), metadata);
  EXPECT_EQ(read_file(folder_ / "a.exr"), read_file(folder_ / "b.exr"));
}

TEST_F(ImageTest, ExrCarriesMetadataAndTheCropsPlace) {
  write_image(folder_ / "a.exr", make_ramp_image(8, 4), {{"promin:scene", "a.gltf"}}, CropPlacement{{3, 2}, {20, 10}});
  const auto input = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_TRUE(input);
  const OIIO::ImageSpec& spec = input->spec();
  EXPECT_EQ(spec.get_string_attribute("promin:scene"), "a.gltf");
  EXPECT_EQ(spec.get_string_attribute("compression"), "zip");
  EXPECT_EQ(spec.get_string_attribute("DateTime"), "") << "the time of day would make equal pictures differ";
  EXPECT_EQ(spec.format, OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(std::vector<int>({spec.x, spec.y, spec.width, spec.height}), std::vector<int>({3, 2, 8, 4}));
  EXPECT_EQ(std::vector<int>({spec.full_x, spec.full_y, spec.full_width, spec.full_height}),
            std::vector<int>({0, 0, 20, 10}));
  EXPECT_EQ(read_image(folder_ / "a.exr").pixels, make_ramp_image(8, 4).pixels);
}

TEST_F(ImageTest, PngIsSrgbOf8Bits) {
  Image image;
  image.size = uvec2(2, 1);
  image.pixels = {vec3(0.0F, 0.18F, 0.5F), vec3(1.0F, 9.0F, -1.0F)};
  write_image(folder_ / "a.png", image);
  const Image back = read_image(folder_ / "a.png");
  ASSERT_EQ(back.size, image.size);
  EXPECT_EQ(glm::round(back.pixels[0] * 255.0F), vec3(0.0F, 118.0F, 188.0F));
  EXPECT_EQ(glm::round(back.pixels[1] * 255.0F), vec3(255.0F, 255.0F, 0.0F));
}

TEST_F(ImageTest, JpegIsNearSrgbWithWholeColours) {
  Image image;
  image.size = uvec2(40, 9);
  for (uint32_t i = 0; i < 40 * 9; ++i) {
    const float x = static_cast<float>(i % 40) / 39.0F;
    image.pixels.emplace_back(x, 1.0F - x, 0.5F * x);
  }
  write_image(folder_ / "a.jpg", image);
  write_image(folder_ / "b.JPEG", image);
  EXPECT_EQ(read_file(folder_ / "a.jpg"), read_file(folder_ / "b.JPEG"));
  const Image back = read_image(folder_ / "a.jpg");
  ASSERT_EQ(back.size, image.size);
  for (size_t i = 0; i < image.pixels.size(); ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[i][c], encode_srgb(image.pixels[i][c]), 0.04) << i;
  }
  const auto input = OIIO::ImageInput::open((folder_ / "a.jpg").string());
  ASSERT_TRUE(input);
  EXPECT_EQ(input->spec().get_string_attribute("jpeg:subsampling"), "4:4:4");
  // The format cannot hold such a width.
  EXPECT_THROW(write_image(folder_ / "wide.jpg", make_ramp_image(65501, 1)), RunError);
  EXPECT_EQ(file_count(), 2);
}

/// Eight columns of one colour. In the left half, it covers half of each pixel.
struct Covered {
  Image image;
  Channel alpha{"A", false, std::vector<uint32_t>(8 * 8, std::bit_cast<uint32_t>(1.0F))};

  Covered() {
    image.size = uvec2(8);
    image.pixels.assign(8 * 8, vec3(0.5F, 0.25F, 0.125F));
    for (size_t i = 0; i < 8 * 8; ++i) {
      if (i % 8 >= 4) continue;
      image.pixels[i] *= 0.5F;
      alpha.values[i] = std::bit_cast<uint32_t>(0.5F);
    }
  }
};

TEST_F(ImageTest, WebpAndTiffHoldShownColoursAndAlpha) {
  const Covered covered;
  for (const char* name : {"a.webp", "a.tif", "b.webp", "b.tif"}) {
    write_image(folder_ / name, covered.image, {}, {}, std::span(&covered.alpha, 1));
  }
  for (const char* ending : {".webp", ".tif"}) {
    const fs::path file = folder_ / (std::string("a") + ending);
    EXPECT_EQ(read_file(file), read_file(folder_ / (std::string("b") + ending))) << "equal pictures are equal files";
    OIIO::ImageSpec config;
    config["oiio:UnassociatedAlpha"] = 1;
    const auto input = OIIO::ImageInput::open(file.string(), &config);
    ASSERT_TRUE(input) << file;
    ASSERT_EQ(input->spec().nchannels, 4);
    std::vector<float> pixels(8 * 8 * 4);
    ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::FLOAT, pixels.data()));
    EXPECT_NEAR(pixels[3], 0.5F, 0.003F);
    EXPECT_EQ(pixels[4 * 7 + 3], 1.0F);
    for (size_t c = 0; c < 3; ++c) {
      const float shown = encode_srgb(vec3(0.5F, 0.25F, 0.125F)[static_cast<int>(c)]);
      EXPECT_NEAR(pixels[4 * 7 + c], shown, 0.02F) << file;
    }
  }
  const Image back = read_image(folder_ / "a.tif");
  EXPECT_EQ(glm::round(255.0F * back.pixels[7]), vec3(188.0F, 137.0F, 99.0F));
}

TEST_F(ImageTest, ColoursAreReadAsFilesHaveThemBesideAlpha) {
  const Covered covered;
  for (const char* name : {"a.png", "a.tif"}) {
    write_image(folder_ / name, covered.image, {}, {}, std::span(&covered.alpha, 1));
    const Image back = read_image(folder_ / name);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[0][c], back.pixels[7][c], 0.02F) << name;
  }
}

TEST_F(ImageTest, RadianceFilesHoldLight) {
  Image image;
  image.size = uvec2(2, 1);
  image.pixels = {vec3(0.5F, 0.25F, 0.125F), vec3(1000.0F, 500.0F, 0.0F)};
  write_image(folder_ / "a.hdr", image);
  const Image back = read_image(folder_ / "a.hdr");
  ASSERT_EQ(back.size, image.size);
  for (size_t i = 0; i < 2; ++i) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(back.pixels[i][c], image.pixels[i][c], image.pixels[i].x / 128.0F);
  }
  EXPECT_THROW(write_image(folder_ / "wide.webp", make_ramp_image(16384, 1)), RunError);
  EXPECT_EQ(file_count(), 1);
}

TEST_F(ImageTest, AFailedWriteKeepsTheOldPicture) {
  const Channel depth{"Z", false, std::vector<uint32_t>(40000, 0x3F800000U)};
  const std::tuple<const char*, std::vector<Channel>, ExrOptions> kinds[] = {
      {"a.exr", {}, {}},
      {"a.png", {}, {}},
      {"a.webp", {}, {}},
      {"a.tif", {}, {}},
      {"deep.exr", {depth}, {.compression = ExrCompression::kNone}}};
  for (const auto& [name, channels, exr] : kinds) {
    const fs::path file = folder_ / name;
    write_image(file, make_ramp_image(4, 4));
    const std::vector<std::byte> old = read_file(file);

    {
      const FileSizeLimit limit(100);
      EXPECT_THROW(write_image(file, make_ramp_image(200, 200), {}, {}, channels, {}, exr), RunError) << name;
    }

    EXPECT_EQ(read_file(file), old) << name;
    fs::remove(file);
    EXPECT_EQ(file_count(), 0) << "the temporary file of " << name << " was left behind";
  }
}

TEST_F(ImageTest, UnwritableTargetsAreRefused) {
  fs::create_directory(folder_ / "folder.exr");
  EXPECT_THROW(write_image(folder_ / "folder.exr", make_ramp_image(2, 2)), RunError);
  EXPECT_THROW(write_image(folder_ / "none" / "a.exr", make_ramp_image(2, 2)), RunError);
  EXPECT_THROW(write_image(folder_ / "a.bmp", make_ramp_image(2, 2)), UsageError);
  EXPECT_EQ(file_count(), 1);
}

TEST_F(ImageTest, PicturesWhosePartsDoNotSuitAreRefused) {
  const fs::path file = folder_ / "a.exr";
  EXPECT_THROW(write_image(file, Image()), UsageError);
  Image image = make_ramp_image(4, 3);
  image.size.y = 4;
  EXPECT_THROW(write_image(file, image), UsageError);
  image.size.y = 3;
  const Channel depth{"Z", false, std::vector<uint32_t>(11)};
  EXPECT_THROW(write_image(file, image, {}, std::nullopt, {&depth, 1}), UsageError);
  EXPECT_THROW(write_image(file, image, {}, CropPlacement{{1, 0}, {4, 3}}), UsageError);
  EXPECT_THROW(write_image(file, image, {}, CropPlacement{{0, 0}, {4, 2}}), UsageError);
  EXPECT_EQ(file_count(), 0);
  EXPECT_NO_THROW(write_image(file, image, {}, CropPlacement{{1, 2}, {5, 5}}));
}

TEST_F(ImageTest, UnreadablePicturesSayWhy) {
  std::ofstream(folder_ / "text.exr") << "not a picture";
  EXPECT_THAT(message_of_reading(folder_ / "none.exr"), HasProblem("file.missing"));
  EXPECT_THAT(message_of_reading(folder_), HasProblem("file.missing"));
  const std::string message = message_of_reading(folder_ / "text.exr");
  EXPECT_THAT(message, HasProblem("picture.format"));
  EXPECT_EQ(message.find('\n'), std::string::npos);

  write_image(folder_ / "whole.exr", make_ramp_image(64, 64));
  fs::resize_file(folder_ / "whole.exr", fs::file_size(folder_ / "whole.exr") / 2);
  EXPECT_THAT(message_of_reading(folder_ / "whole.exr"), HasProblem("picture.damaged"));
}

TEST_F(ImageTest, LuminanceIsReadAsGrey) {
  std::ofstream(folder_ / "grey.pgm") << "P2 2 1 255 0 51";
  const Image image = read_image(folder_ / "grey.pgm");
  EXPECT_EQ(image.pixels.at(0), vec3(0.0F));
  for (int channel = 0; channel < 3; ++channel) EXPECT_NEAR(image.pixels.at(1)[channel], 0.2F, 1e-6F);
}

/// Returns the order of the pixels in a Radiance file: for each pixel, row by row from the top, its number in the file.
std::vector<int> read_order(const fs::path& file, const std::string& resolution) {
  std::ofstream out(file, std::ios::binary);
  out << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n" << resolution << "\n";
  // A mantissa of 128 + i and an exponent of 129 give 1 + i / 128.
  for (int i = 0; i < 6; ++i) out << static_cast<char>(128 + i) << "\x80\x80\x81";
  out.close();
  const Image image = read_image(file);
  EXPECT_EQ(image.size, uvec2(3, 2)) << resolution;
  std::vector<int> order;
  for (const vec3& pixel : image.pixels) order.push_back(static_cast<int>((pixel.r - 1.0F) * 128.0F));
  return order;
}

TEST_F(ImageTest, RadianceFilesSayInWhichOrderTheirPixelsLie) {
  const auto order_of = [&](const std::string& resolution) { return read_order(folder_ / "a.hdr", resolution); };
  EXPECT_THAT(order_of("-Y 2 +X 3"), testing::ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(order_of("-Y 2 -X 3"), testing::ElementsAre(2, 1, 0, 5, 4, 3));
  EXPECT_THAT(order_of("+Y 2 -X 3"), testing::ElementsAre(5, 4, 3, 2, 1, 0));
  EXPECT_THAT(order_of("+Y 2 +X 3"), testing::ElementsAre(3, 4, 5, 0, 1, 2));
  // Columns follow each other.
  EXPECT_THAT(order_of("+X 3 -Y 2"), testing::ElementsAre(0, 2, 4, 1, 3, 5));
  EXPECT_THAT(order_of("+X 3 +Y 2"), testing::ElementsAre(1, 3, 5, 0, 2, 4));
  EXPECT_THAT(order_of("-X 3 +Y 2"), testing::ElementsAre(5, 3, 1, 4, 2, 0));
  EXPECT_THAT(order_of("-X 3 -Y 2"), testing::ElementsAre(4, 2, 0, 5, 3, 1));
}

TEST_F(ImageTest, PicturesOfAbsurdSizeAreRefused) {
  std::ofstream(folder_ / "huge.ppm") << "P6 65000 65000 255\n";
  EXPECT_THAT(message_of_reading(folder_ / "huge.ppm"), HasProblem("picture.large"));
}

TEST_F(ImageTest, ChannelsKeepTheirNamesTypesAndBits) {
  const Image image = make_ramp_image(3, 2);
  const float infinity = std::numeric_limits<float>::infinity();
  const std::vector<float> depths = {1.0F, infinity, 3.0F, 1e-30F, 5.0F, 6.5F};
  std::vector<Channel> channels = {{"Z", false, {}}, {"object", true, {0, 0xFFFFFFFF, 2, 3, 16777217, 5}}};
  for (const float depth : depths) channels[0].values.push_back(std::bit_cast<uint32_t>(depth));
  const fs::path file = folder_ / "a.exr";
  write_image(file, image, {}, std::nullopt, channels);
  EXPECT_EQ(read_image(file).pixels, image.pixels);

  const auto reader = OIIO::ImageInput::open(file.string());
  ASSERT_TRUE(reader);
  const OIIO::ImageSpec spec = reader->spec();
  ASSERT_EQ(spec.nchannels, 5);
  const int z = spec.channelindex("Z");
  const int object = spec.channelindex("object");
  ASSERT_TRUE(z >= 0 && object >= 0);
  EXPECT_EQ(spec.channelformat(z), OIIO::TypeDesc::FLOAT);
  EXPECT_EQ(spec.channelformat(object), OIIO::TypeDesc::UINT32);
  std::vector<float> read_depths(6);
  std::vector<uint32_t> read_objects(6);
  ASSERT_TRUE(reader->read_image(0, 0, z, z + 1, OIIO::TypeDesc::FLOAT, read_depths.data()));
  ASSERT_TRUE(reader->read_image(0, 0, object, object + 1, OIIO::TypeDesc::UINT32, read_objects.data()));
  EXPECT_EQ(read_depths, depths);
  EXPECT_EQ(read_objects, channels[1].values);
}

}  // namespace
}  // namespace promin
