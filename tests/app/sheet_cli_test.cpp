// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run `promin thumbnail` and `promin contact-sheet`.
#include <algorithm>

#include "cli_fixture.h"

namespace promin {
namespace {

using testing::HasSubstr;

class ContactSheetTest : public CliTest {
 protected:
  /// Returns the part of a picture that begins at a pixel.
  static std::vector<vec3> cut(const Image& image, const uvec2& lo, const uvec2& size) {
    std::vector<vec3> pixels;
    for (uint32_t y = 0; y < size.y; ++y) {
      for (uint32_t x = 0; x < size.x; ++x) pixels.push_back(image.at(lo.x + x, lo.y + y));
    }
    return pixels;
  }
};

TEST_F(ContactSheetTest, AThumbnailIsTheRenderedPicture) {
  const ProcessResult result = run({"thumbnail", "square.gltf", "thumbnail", "32"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out + result.err, "");
  EXPECT_EQ(files(), std::set<std::string>{"thumbnail"});
  std::filesystem::rename(folder() / "thumbnail", folder() / "thumbnail.png");
  const Image thumbnail = read_image(folder() / "thumbnail.png");
  EXPECT_EQ(thumbnail.size, uvec2(32));
  EXPECT_EQ(thumbnail.pixels,
            render({"square.gltf", "--from", "three-quarter", "--size", "32x32"}, "picture.png").pixels);
}

TEST_F(ContactSheetTest, ColorsWithoutLightKeepClearOfToneMapping) {
  write("mixed.gltf", make_mixed_gltf());
  ASSERT_EQ(run({"thumbnail", "mixed.gltf", "thumbnail.png", "32"}).exit_code, 0);
  EXPECT_EQ(read_image(folder() / "thumbnail.png").pixels,
            render({"mixed.gltf", "--from", "three-quarter", "--size", "32x32"}, "picture.png").pixels);
}

TEST_F(ContactSheetTest, ASheetHasThePicturesAndTheirNames) {
  const ProcessResult result =
      run({"contact-sheet", "square.gltf", "triangle.obj", "square.gltf", "--columns", "2", "--size", "32x24",
           "--exposure", "-1", "--quality", "draft", "-o", "sheet.png", "--quiet"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Image sheet = read_image(folder() / "sheet.png");
  // The sheet has two columns and rows with gaps of 12, and names with a height of 20 pixels below the pictures.
  ASSERT_EQ(sheet.size, uvec2(12 + 2 * (32 + 12), 12 + 2 * (24 + 20 + 12)));
  const OptionValues options = {"--from", "three-quarter", "--size", "32x24", "--exposure", "-1", "--quality", "draft"};
  const auto rendered = [&](const std::string& scene) {
    OptionValues arguments = options;
    arguments.insert(arguments.begin(), scene);
    return render(arguments, "picture.png").pixels;
  };
  EXPECT_EQ(cut(sheet, {12, 12}, {32, 24}), rendered("square.gltf"));
  EXPECT_EQ(cut(sheet, {56, 12}, {32, 24}), rendered("triangle.obj"));
  EXPECT_EQ(cut(sheet, {12, 68}, {32, 24}), cut(sheet, {12, 12}, {32, 24}));
  const std::vector<vec3> name = cut(sheet, {12, 36}, {32, 20});
  EXPECT_LT(std::ranges::min_element(name, {}, &vec3::x)->x, 0.5F);
  EXPECT_EQ(name, cut(sheet, {12, 92}, {32, 20}));
  EXPECT_NE(name, cut(sheet, {56, 36}, {32, 20}));
}

TEST_F(ContactSheetTest, ASceneThatCannotBeReadLeavesAnEmptyPlace) {
  write("bad.obj", "v 0 0\n");
  const ProcessResult result = run({"contact-sheet", "bad.obj", "triangle.obj", "-o", "sheet.png", "--size", "16x12"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.err, HasSubstr("bad.obj"));
  EXPECT_THAT(run({"contact-sheet", ".", "-o", "empty.png", "--size", "16x12"}).err,
              HasSubstr(".: the scene is a folder, not a file; it contains bad.obj and square.gltf; give a file"));
  EXPECT_THAT(result.err, HasSubstr("1 of 2 scenes is not on the sheet"));
  const Image sheet = read_image(folder() / "sheet.png");
  const std::vector<vec3> empty = cut(sheet, {12, 12}, {16, 12});
  EXPECT_EQ(std::ranges::count(empty, empty.front()), 16 * 12);
  EXPECT_NE(cut(sheet, {40, 12}, {16, 12}), empty);
}

TEST_F(ContactSheetTest, HelpSaysWhatASheetDoes) {
  const std::string help = run({"contact-sheet", "--help"}).out;
  EXPECT_THAT(help, HasSubstr("Usage: promin contact-sheet [OPTIONS] SCENES...\n"));
  EXPECT_THAT(help, HasSubstr("[320x240]"));
  EXPECT_THAT(help, testing::Not(HasSubstr("height 720")));
  EXPECT_THAT(help, testing::Not(HasSubstr("--explain")));
}

TEST_F(ContactSheetTest, WrongUseIsRefused) {
  expect_failure(run({"contact-sheet", "triangle.obj"}), 2, "--output");
  expect_failure(run({"contact-sheet", "triangle.obj", "-o", "s.png", "--spp", "4", "--quality", "high"}), 2,
                 "usage.options.contradict --quality --spp");
  expect_failure(run({"contact-sheet", "triangle.obj", "-o", "sheet.exe"}), 2, "sheet.exe");
  expect_failure(run({"contact-sheet", "triangle.obj", "-o", "triangle.obj"}), 2, "triangle.obj");
  expect_failure(run({"contact-sheet", "triangle.obj", "triangle.obj", "-o", "s.png", "--size", "20000x10"}), 2,
                 "at most 32768");
  expect_failure(run({"thumbnail", "triangle.obj", "t.png", "0"}), 2, "SIZE");
  expect_failure(run({"thumbnail", "nosuch.obj", "t.png"}), 3, "nosuch.obj");
  EXPECT_TRUE(files().empty());
}

}  // namespace
}  // namespace promin
