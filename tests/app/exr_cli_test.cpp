// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check the content of EXRs of `promin render`, which OpenImageIO reads.
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "cli_fixture.h"

namespace promin {
namespace {

/// All channels of an EXR, from all its parts, by name.
struct ReadExr {
  std::map<std::string, std::vector<float>> channels;
  std::map<std::string, OIIO::TypeDesc> types;
  std::vector<std::string> order;
  int part_count = 0;
  std::string compression;
  std::map<std::string, std::string> metadata;
};

class ExrCliTest : public CliTest {
 protected:
  ReadExr read_exr(const std::string& file) const {
    ReadExr exr;
    const auto input = OIIO::ImageInput::open((folder() / file).string());
    EXPECT_TRUE(input) << OIIO::geterror();
    if (!input) return exr;
    for (; input->seek_subimage(exr.part_count, 0); ++exr.part_count) {
      const OIIO::ImageSpec spec = input->spec();
      exr.compression = spec.get_string_attribute("compression");
      for (const auto& attribute : spec.extra_attribs) {
        exr.metadata[attribute.name().string()] = attribute.get_string();
      }
      for (int i = 0; i < spec.nchannels; ++i) {
        const std::string& name = spec.channelnames[static_cast<size_t>(i)];
        std::vector<float>& values = exr.channels[name];
        values.resize(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height));
        EXPECT_TRUE(input->read_image(exr.part_count, 0, i, i + 1, OIIO::TypeDesc::FLOAT, values.data()));
        exr.types[name] = spec.channelformat(i);
        exr.order.push_back(name);
      }
    }
    return exr;
  }

  ReadExr render_exr(OptionValues options, const uvec2& size = uvec2(40, 30)) const {
    options.insert(options.begin(), {"render", "square.gltf", "-o", "a.exr", "--quiet", "--size",
                                     std::to_string(size.x), std::to_string(size.y)});
    const ProcessResult result = run(options);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_exr("a.exr");
  }
};

TEST_F(ExrCliTest, HalvesAreColoursAloneAndOffByTheirRounding) {
  const OptionValues aovs = {"--spp", "4", "--aov", "depth,normal,object,cryptomatte,position,error"};
  const ReadExr full = render_exr(aovs);
  OptionValues options = aovs;
  options.push_back("--half");
  const ReadExr half = render_exr(options);
  ASSERT_EQ(half.order, full.order);
  for (const char* name : {"R", "G", "B", "N.X"}) EXPECT_EQ(half.types.at(name), OIIO::TypeDesc::HALF) << name;
  for (const char* name : {"Z", "P.X", "CryptoObject00.R", "error.R"}) {
    EXPECT_EQ(half.types.at(name), OIIO::TypeDesc::FLOAT) << name;
    EXPECT_EQ(half.channels.at(name), full.channels.at(name)) << name;
  }
  EXPECT_EQ(half.types.at("object"), OIIO::TypeDesc::UINT32);
  bool is_rounded = false;
  for (size_t i = 0; i < full.channels.at("R").size(); ++i) {
    const float exact = full.channels.at("R")[i];
    ASSERT_LE(std::abs(half.channels.at("R")[i] - exact), 0x1p-11F * exact);
    is_rounded = is_rounded || half.channels.at("R")[i] != exact;
  }
  EXPECT_TRUE(is_rounded);
}

TEST_F(ExrCliTest, EveryCompressionHoldsTheSameNumbers) {
  const ReadExr none = render_exr({"--aov", "depth,uv", "--compression", "none"});
  EXPECT_EQ(none.compression, "none");
  for (const char* name : {"rle", "zips", "zip", "piz"}) {
    const ReadExr exr = render_exr({"--aov", "depth,uv", "--compression", name});
    EXPECT_EQ(exr.compression, name);
    EXPECT_EQ(exr.channels, none.channels) << name;
  }
  EXPECT_EQ(run({"render", "square.gltf", "-o", "b.exr", "--compression", "dwaa"}).exit_code, 2);
}

TEST_F(ExrCliTest, AlphaLeavesTheBackgroundOut) {
  const ReadExr with = render_exr({"--background", "linear:0.5,0.25,1", "--spp", "16"});
  const ReadExr without = render_exr({"--alpha", "--spp", "16"});
  const std::vector<float>& alpha = without.channels.at("A");
  size_t between = 0;
  for (size_t i = 0; i < alpha.size(); ++i) {
    between += alpha[i] > 0.0F && alpha[i] < 1.0F ? 1 : 0;
    EXPECT_NEAR(without.channels.at("R")[i] + (1.0F - alpha[i]) * 0.5F, with.channels.at("R")[i], 1e-6F);
    EXPECT_NEAR(without.channels.at("B")[i] + (1.0F - alpha[i]) * 1.0F, with.channels.at("B")[i], 1e-6F);
  }
  EXPECT_GT(between, 10U);
  EXPECT_EQ(alpha.front(), 0.0F);
  EXPECT_EQ(alpha[15 * 40 + 20], 1.0F);
}

// The square is perpendicular to the view, so its depth is the same everywhere.
TEST_F(ExrCliTest, DepthIsOfTheRayOrOfThePlane) {
  const ReadExr of_ray = render_exr({"--aov", "depth"});
  const ReadExr of_plane = render_exr({"--aov", "depth", "--depth", "plane"});
  EXPECT_EQ(of_ray.metadata.at("promin:depth"), "ray");
  EXPECT_EQ(of_plane.metadata.at("promin:depth"), "plane");
  float farthest = 0.0F;
  for (size_t i = 0; i < of_ray.channels.at("Z").size(); ++i) {
    const float along = of_plane.channels.at("Z")[i];
    const float away = of_ray.channels.at("Z")[i];
    ASSERT_EQ(std::isinf(along), std::isinf(away));
    if (std::isinf(away)) continue;
    ASSERT_NEAR(along, 4.0F, 1e-6F);
    farthest = std::max(farthest, away);
  }
  EXPECT_GT(farthest, 4.1F);
}

// A band holds 12 MiB. A picture with many channels is written in several bands. The file does not depend on this.
TEST_F(ExrCliTest, BandsLeaveNoTrace) {
  const OptionValues options = {
      "--size", "900", "400", "--spp", "2", "--aov", "position,normal,shading_normal,albedo,error,direct"};
  OptionValues whole = {"render", "square.gltf", "-o", "whole.exr", "--quiet"};
  whole.insert(whole.end(), options.begin(), options.end());
  ASSERT_EQ(run(whole).exit_code, 0);
  // An average exposure needs the whole picture at once; the EXR is the same.
  OptionValues at_once = {"render", "square.gltf", "-o", "once.exr", "--quiet", "--exposure", "average"};
  at_once.insert(at_once.end(), options.begin(), options.end());
  ASSERT_EQ(run(at_once).exit_code, 0);
  EXPECT_EQ(read_exr("whole.exr").channels, read_exr("once.exr").channels);
}

// OpenEXR holds blocks of rows for each thread that compresses: 40 MB for each of three threads with this picture. It
// allocates this memory when it receives rows, so the picture must have some rows.
TEST_F(ExrCliTest, WidePicturesOfManyChannelsTakeLittleMemory) {
  const auto held_mb = [&](const OptionValues& aovs) {
    OptionValues arguments = {"render", "square.gltf", "-o", "a.exr", "--size", "16384", "72", "-v"};
    // The number of samples is small, because the time of tracing is not measured.
    if (std::ranges::count(aovs, "--target-error") == 0) arguments.insert(arguments.end(), {"--spp", "2"});
    arguments.insert(arguments.end(), aovs.begin(), aovs.end());
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    const size_t place = result.err.find("at most ");
    EXPECT_NE(place, std::string::npos) << result.err;
    return place == std::string::npos ? 0.0 : std::stod(result.err.substr(place + 8));
  };
  const auto compression = [&] {
    const auto input = OIIO::ImageInput::open((folder() / "a.exr").string());
    return input ? std::string(input->spec().get_string_attribute("compression")) : "none";
  };
  const double of_colors = held_mb({});
  EXPECT_EQ(compression(), "zip");
  const OptionValues aovs = {"--aov",
                             "depth,position,normal,shading_normal,uv,albedo,emission,direct,indirect,reflection,"
                             "transmission,background,object,primitive,material,steps,samples,error,cryptomatte"};
  const double of_all = held_mb(aovs);
  EXPECT_EQ(compression(), "zips") << "16 rows have 71 MB";
  EXPECT_GT(of_colors, 50.0);
  EXPECT_LT(of_all - of_colors, 300.0) << "of colours alone " << of_colors << " MB";
  // A picture with a target error is stored on disk until it is complete. Only then is its first row written.
  OptionValues refined = aovs;
  refined.insert(refined.end(), {"--target-error", "0.25"});
  EXPECT_LT(held_mb(refined) - of_colors, 300.0) << "of colours alone " << of_colors << " MB";
}

// A job of one piece holds the whole picture. The other picture is stored on disk, like all pictures of more than 12
// MiB. Both pictures have 55 numbers per pixel.
TEST_F(ExrCliTest, PicturesOfAnErrorHaveTheBytesOfThoseHeldWhole) {
  const OptionValues aovs = {
      "--aov",
      "cryptomatte,depth,position,normal,shading_normal,albedo,object,samples,error,direct,reflection,background",
      "--alpha",
      "--target-error",
      "0.1",
      "--dither",
      "--quiet"};
  const std::vector<OptionValues> windows = {{"--size", "257", "330"},
                                             {"--size", "600", "400", "--crop", "41", "70", "553", "326"}};
  for (size_t i = 0; i < windows.size(); ++i) {
    OptionValues single = {"render", "square.gltf", "-o", "single.exr", "-o", "single.png"};
    OptionValues job = {
        "render", "square.gltf", "-o", "job.exr", "-o", "job.png", "--job", "job" + std::to_string(i), "--pieces", "1"};
    // Rendering twice adds nothing.
    if (i == 1) single.insert(single.end(), {"--repeat", "2"});
    for (OptionValues* words : {&single, &job}) {
      words->insert(words->end(), windows[i].begin(), windows[i].end());
      words->insert(words->end(), aovs.begin(), aovs.end());
      const ProcessResult result = run(*words);
      ASSERT_EQ(result.exit_code, 0) << result.err;
    }
    EXPECT_TRUE(read("single.exr") == read("job.exr")) << i;
    EXPECT_TRUE(read("single.png") == read("job.png")) << i;
  }
}

TEST_F(ExrCliTest, TheHeaderTellsHowErrorsAreMeasured) {
  const OptionValues target = {"--target-error", "0.0625"};
  const ReadExr linear = render_exr(target);
  EXPECT_FALSE(linear.metadata.contains("promin:error_in"));
  const ReadExr shown = render_exr({"--target-error", "0.0625", "--error-in", "display"});
  EXPECT_EQ(shown.metadata.at("promin:error_in"), "display");
  EXPECT_EQ(shown.metadata.at("promin:error_target"), "0.0625");
  EXPECT_NE(shown.channels, linear.channels);
}

// The file has all AOVs of light. Their sum is the picture.
TEST_F(ExrCliTest, PartsOfLightSumToThePicture) {
  const ReadExr exr = render_exr({"--spp", "16", "--background", "linear:0.5,0.25,1", "--aov",
                                  "emission,direct,indirect,reflection,transmission,background"});
  for (const char* letter : {"R", "G", "B"}) {
    for (size_t i = 0; i < exr.channels.at("R").size(); ++i) {
      float sum = 0.0F;
      for (const char* part : {"emission.", "direct.", "indirect.", "reflection.", "transmission.", "background."}) {
        sum += exr.channels.at(part + std::string(letter))[i];
      }
      ASSERT_NEAR(sum, exr.channels.at(letter)[i], 1e-6F) << letter << " " << i;
    }
  }
}

/// A part of an EXR that another program might write, with 40 x 50 pixels.
struct ForeignPart {
  std::string name;
  std::vector<std::string> channels;
  /// All channels of each pixel.
  std::vector<float> values;
  /// The size of a tile; 0 if the part is stored in rows.
  int tile_size = 0;
};

void write_foreign(const std::filesystem::path& file, const std::vector<ForeignPart>& parts) {
  std::vector<OIIO::ImageSpec> specs;
  for (const ForeignPart& part : parts) {
    OIIO::ImageSpec spec(40, 50, static_cast<int>(part.channels.size()), OIIO::TypeDesc::FLOAT);
    spec.channelnames = part.channels;
    spec.y = -7;
    spec.tile_width = spec.tile_height = part.tile_size;
    spec.attribute("oiio:subimagename", part.name);
    specs.push_back(spec);
  }
  const auto output = OIIO::ImageOutput::create(file.string());
  ASSERT_TRUE(output->open(file.string(), static_cast<int>(specs.size()), specs.data())) << output->geterror();
  for (size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) {
      ASSERT_TRUE(output->open(file.string(), specs[i], OIIO::ImageOutput::AppendSubimage));
    }
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, parts[i].values.data())) << output->geterror();
  }
  ASSERT_TRUE(output->close());
}

TEST_F(ExrCliTest, FilesOfOthersAreComparedInAllTheirParts) {
  const auto numbers = [](size_t channels) {
    std::vector<float> values(channels * 40 * 50);
    std::iota(values.begin(), values.end(), 0.0F);
    return values;
  };
  const ForeignPart rows{"main", {"R", "G", "B", "Z"}, numbers(4)};
  ForeignPart tiles = rows;
  tiles.tile_size = 16;
  write_foreign(folder() / "rows.exr", {rows});
  write_foreign(folder() / "tiles.exr", {tiles});
  const ProcessResult same = run({"compare", "rows.exr", "tiles.exr", "--fail", "0"});
  EXPECT_EQ(same.exit_code, 0) << same.out << same.err;
  tiles.values[4 * (33 * 40 + 39) + 3] += 0.5F;
  write_foreign(folder() / "tiles.exr", {tiles});
  EXPECT_THAT(run({"compare", "rows.exr", "tiles.exr"}).out, testing::HasSubstr("Z: largest 0.5, at pixel 39 33; 1 "));

  // If a part's name is that of its channels, it adds nothing to their names.
  ForeignPart colors{"rgba", {"R", "G", "B"}, {}};
  ForeignPart depth{"Z", {"Z"}, {}};
  for (size_t i = 0; i < rows.values.size(); ++i) (i % 4 < 3 ? colors : depth).values.push_back(rows.values[i]);
  write_foreign(folder() / "parts.exr", {colors, depth});
  const ProcessResult parts = run({"compare", "rows.exr", "parts.exr", "--fail", "0"});
  EXPECT_EQ(parts.exit_code, 0) << parts.out << parts.err;

  // The names of other parts are prefixes of their channels' names.
  const std::vector<ForeignPart> eyes = {{"left", {"R", "G", "B"}, numbers(3)}, {"right", {"R", "G", "B"}, numbers(3)}};
  std::vector<ForeignPart> other_eyes = eyes;
  other_eyes[1].values[4] += 0.25F;
  write_foreign(folder() / "eyes.exr", eyes);
  write_foreign(folder() / "other_eyes.exr", other_eyes);
  const ProcessResult second_eye = run({"compare", "eyes.exr", "other_eyes.exr", "--fail", "0"});
  EXPECT_EQ(second_eye.exit_code, 5);
  EXPECT_THAT(second_eye.out, testing::HasSubstr("right.G: largest 0.25, at pixel 1 0; 1 "));
  expect_failure(
      run({"compare", "rows.exr", "eyes.exr"}), 3,
      "the pictures have different channels: only rows.exr has Z, only eyes.exr has right.B right.G right.R");
}

TEST_F(ExrCliTest, OptionsOfExrsWantOne) {
  for (const OptionValues& option : {OptionValues{"--half"},
                                     {"--compression", "piz"},
                                     {"--compression", "zip"},
                                     {"--depth", "plane"},
                                     {"--aov", "depth"}}) {
    OptionValues arguments = {"render", "square.gltf", "-o", "a.png"};
    arguments.insert(arguments.end(), option.begin(), option.end());
    expect_failure(run(arguments), 2, option.front());
  }
  EXPECT_EQ(files(), std::set<std::string>{});
}

}  // namespace
}  // namespace promin
