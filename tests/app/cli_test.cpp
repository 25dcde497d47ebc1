// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run the program promin itself: its exit codes, its lines and its files are an interface.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli_fixture.h"
#include "image/color_words.h"
#include "promin/aovs.h"
#include "promin/device.h"
#include "promin/framing.h"
#include "promin/lighting.h"
#include "promin/load_scene.h"
#include "promin/renderer.h"
#include "support/moving_gltf.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

/// Returns the square without lights and cameras.
std::string classic_square() {
  json gltf = json::parse(kSquareGltf);
  gltf["scenes"][0]["nodes"] = {0};
  return gltf.dump();
}

/// Expects that the PNG shows the picture with this transform.
void expect_displayed(const Image& picture, const Image& png, const DisplayTransform& display) {
  ASSERT_EQ(png.size, picture.size);
  for (size_t i = 0; i < picture.pixels.size(); ++i) {
    const vec3 shown = apply(display, picture.pixels[i]);
    for (int c = 0; c < 3; ++c) {
      ASSERT_EQ(std::lround(255.0F * png.pixels[i][c]), std::lround(255.0F * encode_srgb(shown[c]))) << "pixel " << i;
    }
  }
}

TEST_F(CliTest, NamesOfFilesDriveNoTerminal) {
  // The last character is U+009B, which begins commands of a terminal, as ESC [ does.
  expect_failure(run({"info", "no\nsuch\033[2J\u00e9\u009b.gltf"}), 3, "no?such?[2J\u00e9?.gltf");
  const ProcessResult result = run({"render", "square.gltf", "--size", "8", "8", "-o", "x\033[2J\ny.exr", "-v"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr(": x?[2J?y.exr\n"));
  json gltf = json::parse(classic_square());
  gltf["cameras"] = {
      {{"name", "ma\033[2J\nin"}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
  gltf["nodes"].push_back({{"camera", 0}});
  gltf["scenes"][0]["nodes"] = {0, gltf["nodes"].size() - 1};
  write("camera.gltf", gltf.dump());
  EXPECT_THAT(run({"info", "camera.gltf"}).out, HasSubstr(" 0 ma?[2J?in, perspective"));
}

TEST_F(CliTest, HelpAndVersionEverywhere) {
  for (const OptionValues& command : {OptionValues{}, OptionValues{"render"}, OptionValues{"cast"},
                                      OptionValues{"compare"}, OptionValues{"info"}, OptionValues{"devices"}}) {
    OptionValues with_help = command;
    with_help.emplace_back("--help");
    const ProcessResult help = run(with_help);
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr("Usage: promin"));
    EXPECT_THAT(help.err, IsEmpty());

    OptionValues with_version = command;
    with_version.emplace_back("--version");
    const ProcessResult version = run(with_version);
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, MatchesRegex("promin [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    EXPECT_THAT(version.err, IsEmpty());
  }
}

TEST_F(CliTest, HelpAndVersionAreWordsToo) {
  EXPECT_EQ(run({"help"}).out, run({"--help"}).out);
  EXPECT_EQ(run({"help", "cast"}).out, run({"cast", "--help"}).out);
  EXPECT_EQ(run({"version"}).out, run({"--version"}).out);
}

TEST_F(CliTest, HelpHasExamplesAndGroups) {
  const ProcessResult alone = run({});
  EXPECT_EQ(alone.exit_code, 0);
  EXPECT_THAT(alone.err, IsEmpty());
  EXPECT_EQ(alone.out, run({"--help"}).out);
  EXPECT_THAT(alone.out, HasSubstr("\nExamples:\n  promin model.glb\n"));
  EXPECT_LE(std::ranges::count(alone.out, '\n'), 40) << "more than a page";
  const std::string help = run({"render", "--help"}).out;
  size_t at = 0;
  for (const char* heading : {"Output", "Quality", "Camera", "Look", "Jobs", "Expert", "Examples"}) {
    const size_t found = help.find(std::string("\n") + heading + ":\n");
    ASSERT_NE(found, std::string::npos) << heading;
    EXPECT_GT(found, at) << heading;
    at = found;
  }
  EXPECT_THAT(help, Not(HasSubstr("--samples")));
  for (const char* command : {"merge", "cast", "compare", "info", "thumbnail", "contact-sheet", "devices"}) {
    const std::string own = run({command, "--help"}).out;
    const size_t examples = own.find("Examples:");
    if (examples == std::string::npos) continue;
    EXPECT_THAT(own.substr(examples), Not(ContainsRegex("  promin (model|info|render)"))) << command;
    EXPECT_THAT(own.substr(examples), HasSubstr("  promin " + std::string(command) + " ")) << command;
  }
}

TEST_F(CliTest, AFileAloneIsRendered) {
  const ProcessResult result = run({"square.gltf", "--size", "8x8", "-o", "a.png", "--quiet"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  render({"square.gltf", "--size", "8", "8"}, "b.png");
  EXPECT_EQ(read("a.png"), read("b.png"));
  expect_failure(run({"nope.glb"}), 3, "file.missing nope.glb:");
  expect_failure(run({"a.png"}), 3, "scene.file.picture a.png: .png");
}

TEST_F(CliTest, WrongUsageIsRefusedInOneLine) {
  // tests/messages/usage_messages.cpp has all wrong usages.
  const std::pair<OptionValues, std::string> cases[] = {
      {{"rendr"}, "usage.command.unknown rendr render"},
      {{"diff", "a.png", "b.png"}, "usage.command.unknown diff compare"},
      {{"render", "square.gltf", "--size", "fulhd", "-o", "a.exr"}, "usage.option.value fullhd"},
      {{"render", "square.gltf", "-o", "a.exr", "--spq", "3"}, "usage.option.unknown --spq --spp"},
      {{"render", "square.gltf", "--target-eror=1"}, "usage.option.unknown --target-error"},
      {{"square.gltf", "x.png"}, "usage.argument.unexpected x.png"},
      {{"render"}, "usage.words.wrong SCENE"},
      {{"render", "square.gltf", "--skip-existing"}, "usage.option.needs --skip-existing"},
      {{"render", "square.gltf", "-o", "a.exr", "--min-spp", "8"}, "usage.option.needs --min-spp"},
      {{"render", "square.gltf", "-o", "a.bmp"}, "output.extension \".bmp\""},
      {{"render", "square.gltf", "-o", "a.exr", "-o", "./a.exr"}, "output.twice"},
      {{"render", "square.gltf", "-o", "a.exr", "--spp"}, "usage.option.few --spp"},
      {{"render", "square.gltf", "-o", "a.exr", "--spp", "0"}, "usage.option.value --spp \"0\""},
      {{"render", "square.gltf", "-o", "a.exr", "--camera", "back"}, "camera.unknown 0 (main), 1 (side)"},
      {{"render", "square.gltf", "-o", "a.exr", "--crop", "5", "0", "5", "9"}, "usage.option.value --crop"},
      {{"render", "square.gltf", "-o", "a.exr", "--direction", "0", "2", "0", "--up", "y"}, "camera.direction"},
      {{"render", "square.gltf", "-o", "a.png", "--alpha", "--background", "1", "1", "1"},
       "usage.options.contradict --alpha --background"},
      {{"render", "square.gltf", "-o", "-", "--job", "j"}, "output.standard.taken --job"},
      {{"render", "square.gltf", "-o", "a.exr", "--quiet", "-v"}, "usage.options.contradict"},
      {{"render", "square.gltf", "-o", "a.jpg", "--alpha"}, "output.alpha.none JPEG"},
  };
  for (const auto& [arguments, part] : cases) {
    SCOPED_TRACE(testing::PrintToString(arguments));
    expect_failure(run(arguments), 2, part);
    EXPECT_THAT(files(), IsEmpty());
  }
}

TEST_F(CliTest, BadScenesAreRefused) {
  write("garbage.gltf", "{ not json");
  write("empty.obj", "");
  write("scene.blend", "BLENDER");
  write("old.exr", "old");
  const std::pair<std::string, std::string> cases[] = {{"none.gltf", "none.gltf"},
                                                       {".", "."},
                                                       {"garbage.gltf", "garbage.gltf"},
                                                       {"empty.obj", "empty"},
                                                       {"scene.blend", "scene.blend"}};
  for (const auto& [scene, part] : cases) {
    SCOPED_TRACE(scene);
    expect_failure(run({"render", scene, "-o", "old.exr"}), 3, part);
    expect_failure(run({"info", scene}), 3, part);
  }
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("garbage.gltf", "empty.obj", "scene.blend", "old.exr"));
}

TEST_F(CliTest, AFolderNamesItsScenes) {
  const std::string named = "it contains square.gltf and triangle.obj; give a file";
  for (const char* place : {".", "./"}) {
    expect_failure(run({place}), 3, std::string(place) + ": the scene is a folder, not a file; " + named);
  }
  fs::create_directory(folder() / "models");
  expect_failure(run({"models"}), 3,
                 "models: the scene is a folder, not a file; use a file with one of the extensions");
  expect_failure(run({"info", "."}), 3, named);
  EXPECT_THAT(files(), testing::ElementsAre("models"));
}

TEST_F(CliTest, BadPanoramasAreRefused) {
  write("broken.hdr", "#?RADIANCE");
  write_image(folder() / "bright.exr", {{4, 2}, std::vector<vec3>(8, vec3(2e15F))});
  write_image(folder() / "wide.exr", {{16385, 1}, std::vector<vec3>(16385, vec3(1.0F))});
  const std::pair<std::string, std::string> cases[] = {
      {"none.hdr", "file.missing none.hdr:"},
      {"broken.hdr", "broken.hdr"},
      {"bright.exr", "scene.panorama.pixel bright.exr: (R 2e+15 0, 0)"},
      {"wide.exr", "picture.large wide.exr: (16385x1"}};
  for (const auto& [panorama, part] : cases) {
    SCOPED_TRACE(panorama);
    expect_failure(run({"render", "square.gltf", "--environment", panorama, "-o", "a.exr"}), 3, part);
    expect_failure(run({"info", "square.gltf", "--environment", panorama}), 3, part);
  }
  expect_failure(run({"info", "square.gltf", "--environment-intensity", "-1"}), 2, "--environment-intensity takes");
  expect_failure(run({"render", "square.gltf", "--environment", "wide.exr", "-o", "wide.exr"}), 2, "wide.exr");
}

TEST_F(CliTest, NegativeNumbersOfPanoramasAreWarnedOf) {
  write_image(folder() / "negative.exr", {{4, 2}, std::vector<vec3>(8, vec3(-1.0F))});
  const std::string warning = "24 numbers of negative.exr are negative, the first -1 in pixel 0, 0; they are read as 0";
  EXPECT_THAT(run({"info", "square.gltf", "--environment", "negative.exr"}).out, HasSubstr(warning));
  const ProcessResult render =
      run({"render", "square.gltf", "--environment", "negative.exr", "-o", "a.exr", "--size", "4", "4"});
  EXPECT_EQ(render.exit_code, 0);
  EXPECT_THAT(render.err, HasSubstr(warning));
}

TEST_F(CliTest, InfoSaysWhatSurroundsAScene) {
  write_image(folder() / "sky.exr", {{4, 2}, std::vector<vec3>(8, vec3(1.0F))});
  const ProcessResult info = run({"info", "triangle.obj", "--environment", "sky.exr", "--environment-rotation", "90",
                                  "--environment-intensity", "2"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, ContainsRegex("sky +panorama of 4x2, turned by 90 degrees, times 2\n"));
  EXPECT_THAT(info.out, ContainsRegex("lights +0\n"));
  EXPECT_THAT(run({"info", "triangle.obj", "--environment-intensity", "3"}).out, ContainsRegex("sky +studio, times 3"));
}

TEST_F(CliTest, APanoramaLightsAndIsSeen) {
  write_image(folder() / "sky.exr", {{4, 2}, std::vector<vec3>(8, vec3(0.5F))});
  const Image image = render({"triangle.obj", "--size", "64", "36", "--environment", "sky.exr",
                              "--environment-intensity", "2", "--background", "environment"},
                             "a.exr");
  EXPECT_EQ(image.at(0, 0), vec3(1.0F));
  // The default grey of OBJ is 0.8. The light is 1 from all directions.
  EXPECT_NEAR(image.at(32, 18).x, 0.8F, 1e-3F);
}

// The names of the files beside a scene are known only after it has been loaded.
TEST_F(CliTest, FilesThatASceneIsMadeOfAreNotOverwritten) {
  write("made.obj", "mtllib made.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  write("made.mtl", "newmtl m\nKd 1 0 0\n");
  const std::string materials = read("made.mtl");
  expect_failure(run({"render", "made.obj", "-o", "a.exr", "--stats", "made.mtl"}), 2, "output.input made.mtl:");
  EXPECT_EQ(read("made.mtl"), materials);
}

TEST_F(CliTest, UnwritableOutputsAreFoundBeforeTheWork) {
  write("old.exr", "old");
  fs::create_directory(folder() / "folder.exr");
  // The scene does not exist, but it is only read after the outputs are known to be writable.
  expect_failure(run({"render", "none.obj", "-o", "none/a.exr"}), 1, "output.folder.missing none/a.exr: none");
  expect_failure(run({"render", "none.obj", "-o", "old.exr/a.exr"}), 1,
                 "old.exr/a.exr: the folder of the output file does not exist");
  expect_failure(run({"render", "none.obj", "-o", "folder.exr"}), 1, "output.kind folder.exr:");
  expect_failure(run({"render", "none.obj", "-o", "old.exr", "--stats", "none/s.json"}), 1, "none/s.json");
  expect_failure(run({"render", "none.obj", "-o", "old.exr", "--stats", "/dev/null"}), 1, "/dev/null");
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("old.exr", "folder.exr"));
}

TEST_F(CliTest, AFullDiskLeavesTheOldPictures) {
  write("old.exr", "old");
  write("old.png", "old");
  fill_disk(2000);
  // The test does not use Mesa's cache; newer versions of the cache fail on a full disk.
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  for (const char* output : {"old.exr", "old.png"}) {
    expect_failure(run({"render", "square.gltf", "--size", "300", "300", "-o", output, "--quiet"}), 1, output);
    EXPECT_EQ(read(output), "old");
  }
  // The disk has no room for the bytes before the rows, and only for 50 bytes of the message. libpng prints nothing.
  fill_disk(50);
  const ProcessResult early = run({"render", "square.gltf", "-o", "old.png", "--quiet"});
  EXPECT_EQ(early.exit_code, 1);
  EXPECT_THAT(early.err, testing::StartsWith("promin: "));
  EXPECT_EQ(read("old.png"), "old");
  fill_disk(2000);
  // promin stores this picture on disk until it is complete. It detects before tracing that the disk has no room.
  const OptionValues large = {"render",         "square.gltf", "--size", "30000",   "20000",
                              "--target-error", "0.5",         "-o",     "old.exr", "--quiet"};
  expect_failure(run(large), 1, "there is no room for 7201 MB beside the output file until it can be written");
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::UnorderedElementsAre("old.exr", "old.png"));
}

// If a file system cannot reserve space, promin detects the full disk only while it stores the picture.
TEST_F(CliTest, ADiskThatFillsLeavesTheOldPictures) {
  write("old.exr", "old");
  fill_disk(700'000);
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  for (const bool promises_room : {true, false}) {
    if (!promises_room) options_.environment["PROMIN_TEST_PROMISES_NO_ROOM"] = "1";
    // This picture takes no room itself.
    const OptionValues words = {
        "render", "square.gltf", "-o",           "old.exr", "--quiet", "--light", "none", "--background",   "0",
        "0",      "0",           "--lights-off", "0",       "--size",  "1200",    "900",  "--target-error", "1"};
    expect_failure(run(words), 1, "there is no room for 13 MB beside");
    EXPECT_EQ(read("old.exr"), "old");
    EXPECT_THAT(files(), testing::ElementsAre("old.exr"));
  }
  // The disk has room for the stored picture, but not for the output file.
  const OptionValues large = {
      "render", "square.gltf", "--size",  "200",           "200", "--aov", "object,position,normal",
      "-o",     "old.exr",     "--quiet", "--compression", "none"};
  expect_failure(run(large), 1, "the output file cannot be written (");
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::ElementsAre("old.exr"));
}

// Reading from a pipe that nobody writes to would wait forever.
TEST_F(CliTest, ScenesAreRegularFiles) {
  ASSERT_EQ(::mkfifo((folder() / "pipe.obj").c_str(), 0600), 0);
  expect_failure(run({"info", "pipe.obj"}), 3, "file.kind pipe.obj:");
  std::filesystem::create_directory(folder() / "folder.gltf");
  expect_failure(run({"info", "folder.gltf"}), 3, "file.folder folder.gltf:");
}

// Newer lavapipes keep device memory in a file, to which the limit applies.
TEST_F(CliTest, AFileSizeLimitIsAFailureWhateverItStops) {
  write("old.exr", "old");
  write_rays("rays.npy", std::vector<Ray>(10'000, Ray{vec3(0.0F, 0.0F, 5.0F), 0.0F, vec3(0.0F, 0.0F, -1.0F), 100.0F}));
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  for (const size_t most_bytes : {2'000, 30'000, 100'000}) {
    options_.max_file_bytes = most_bytes;
    const OptionValues words = {"render", "square.gltf", "--size", "1200", "800", "--shading", "uv", "-o", "old.exr"};
    expect_failure(run(words), 1, ";");
    expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "hits.npy"}), 1, ";");
    EXPECT_TRUE(read("old.exr") == "old");
    EXPECT_THAT(files(), testing::UnorderedElementsAre("old.exr", "rays.npy"));
  }
}

// Only devices whose profile recommends it keep kernels.
TEST_F(CliTest, CompiledKernelsAreKeptUnlessOneSaysNoCache) {
  options_.environment["XDG_CACHE_HOME"] = folder() / "cache";
  const auto render = [&](OptionValues words) {
    words.insert(words.begin(), {"render", "square.gltf", "--size", "8", "8", "-o", "a.exr", "--stats", "s.json"});
    const ProcessResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return nlohmann::json::parse(read("s.json")).at("kernels");
  };
  const nlohmann::json first = render({"--no-cache"});
  EXPECT_GT(first.at("compiled"), 0);
  EXPECT_EQ(first.at("read"), 0);
  EXPECT_FALSE(fs::exists(folder() / "cache/promin"));
  const std::string picture = read("a.exr");
  EXPECT_EQ(render({}), first);
  if (!fs::exists(folder() / "cache/promin")) GTEST_SKIP() << "kernels of this device are not kept";
  const nlohmann::json again = render({});
  EXPECT_EQ(again.at("compiled"), 0);
  EXPECT_EQ(again.at("read"), first.at("compiled"));
  EXPECT_TRUE(read("a.exr") == picture);
  EXPECT_EQ(render({"--no-cache"}), first);
}

TEST_F(CliTest, AKernelThatTheDriverRefusesIsCompiledWhole) {
  options_.environment["XDG_CACHE_HOME"] = folder() / "cache";
  OptionValues words = {"render", "square.gltf", "--size", "8", "8", "-o", "a.exr", "-v"};
  ASSERT_EQ(run(words).exit_code, 0);
  const bool keeps_kernels = fs::exists(folder() / "cache/promin");
  const std::string call = keeps_kernels ? "vkCreateShadersEXT" : "vkCreateComputePipelines";
  const std::string picture = read("a.exr");
  // The path of layers contains only this layer and no validation layers.
  options_.environment["VK_LAYER_PATH"] = PROMIN_FAULT_LAYER_DIR;
  options_.environment["VK_INSTANCE_LAYERS"] = "VK_LAYER_PROMIN_fault";
  options_.environment["PROMIN_VALIDATION"] = "";
  const auto run_with = [&](const std::string& fault) {
    options_.environment["PROMIN_TEST_FAULT"] = fault;
    fs::remove_all(folder() / "cache/promin");
    return run(words);
  };
  const ProcessResult refused = run_with(call + " 1 -13");  // VK_ERROR_UNKNOWN
  EXPECT_EQ(refused.exit_code, 0) << refused.err;
  EXPECT_THAT(refused.err, HasSubstr("the driver refused a kernel without its dead code ("));
  EXPECT_TRUE(read("a.exr") == picture);
  EXPECT_FALSE(fs::exists(folder() / "cache/promin"));
  // VK_ERROR_OUT_OF_HOST_MEMORY
  expect_failure(run_with(call + " 1 -1"), 1, "the host has not enough memory (");
  words.emplace_back("--no-cache");
  expect_failure(run_with("vkCreateComputePipelines 1 -1"), 1, "the host has not enough memory (");
}

// Lavapipe turns uniforms into constants (shaders/shared/bindings.glsl). It then compiles for every scene, and small
// kernels for every dispatch.
TEST_F(CliTest, AKernelServesAllScenesOfItsFeatures) {
  options_.environment["MESA_SHADER_CACHE_DIR"] = "cache";
  options_.environment["MESA_DISK_CACHE_MULTI_FILE"] = "true";
  fs::create_directory(folder() / "cache");
  const auto count_kernels_after = [&](const char* corners, const OptionValues& camera = {}) {
    // A scene of triangles with a headlight has the smallest kernel.
    write("triangle.obj", std::string(corners) + "f 1 2 3\n");
    OptionValues words = {"render", "triangle.obj", "--size", "64", "64", "-o", "a.exr", "--quiet"};
    words.insert(words.end(), camera.begin(), camera.end());
    EXPECT_EQ(run(words).exit_code, 0);
    size_t count = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder() / "cache")) count += entry.is_regular_file();
    return count;
  };
  const size_t before = count_kernels_after("v 0 0 0\nv 1 0 0\nv 0 1 0\n");
  if (before == 0) GTEST_SKIP() << "the driver is not Mesa's";
  EXPECT_EQ(count_kernels_after("v 2 3 4\nv 9 3 1\nv 2 7 5\n"), before);
  EXPECT_EQ(
      count_kernels_after("v 2 3 4\nv 9 3 1\nv 2 7 5\n", {"--eye", "3", "9", "9", "--direction", "-1", "-3", "-4"}),
      before);
  EXPECT_EQ(count_kernels_after("v 2 3 4\nv 9 3 1\nv 2 7 5\n", {"--eye", "1", "5", "2", "--direction", "3", "1", "2"}),
            before);
}

TEST_F(CliTest, AFullStandardOutputIsAFailure) {
  options_.standard_output = "/dev/full";
  expect_failure(run({"info", "square.gltf"}), 1, "the standard output");
  expect_failure(run({"render", "--help"}), 1, "the standard output cannot be written");
}

TEST_F(CliTest, WithoutADeviceOnlyInfoWorks) {
  options_.environment = {{"VK_ICD_FILENAMES", "/nonexistent.json"}, {"VK_DRIVER_FILES", "/nonexistent.json"}};
  write("old.exr", "old");
  expect_failure(run({"render", "square.gltf", "-o", "old.exr"}), 4, "there is no Vulkan device");
  expect_failure(run({"devices"}), 4, "there is no Vulkan device");
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::ElementsAre("old.exr"));

  const ProcessResult info = run({"info", "square.gltf"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.err, IsEmpty());
}

TEST_F(CliTest, AnUnknownDeviceIsRefused) {
  expect_failure(run({"render", "square.gltf", "-o", "a.exr", "--device", "no such device"}), 4,
                 "no Vulkan device matches \"no such device\"; use another --device: ");
  expect_failure(run({"render", "square.gltf", "-o", "a.exr", "--device", "99"}), 4, "99");
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliTest, InfoSaysWhatASceneHolds) {
  const ProcessResult info = run({"info", "square.gltf"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, ContainsRegex("triangles +2 \\(degenerate: 0\\)"));
  EXPECT_THAT(info.out, ContainsRegex("objects +1 \\(meshes: 1\\)"));
  EXPECT_THAT(info.out, ContainsRegex("lights +1 \\(point: 1"));
  EXPECT_THAT(info.out, ContainsRegex("cameras +0 main, perspective, vertical field of view 45 degrees"));
  EXPECT_THAT(info.out, HasSubstr("\n            1 side, "));
  EXPECT_THAT(info.out, ContainsRegex("bounds +-1 -1 0 to 1 1 0"));
  EXPECT_THAT(info.out, ContainsRegex("memory +[0-9.]+ MB of geometry on the host, [0-9.]+ MB on the device"));
}

/// Returns the text of the square's file, in which one text replaces another.
std::string square_with(const std::string& part, const std::string& other) {
  std::string text = kSquareGltf;
  text.replace(text.find(part), part.size(), other);
  return text;
}

TEST_F(CliTest, InfoListsAnimations) {
  GltfBuilder gltf = triangle_gltf();
  test::animate(gltf, 0, "/nodes/0/translation", {0, 1.5F}, {0, 0, 0, 2, 0, 0}, "VEC3");
  test::animate(gltf, 0, "/nodes/0/scale", {0, 1}, {1, 1, 1, 2, 2, 2}, "VEC3");
  gltf.json["animations"][0]["name"] = "Walk";
  gltf.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}, {{"POSITION", 0}}};
  gltf.json["skins"] = {{{"joints", {0}}}};
  test::animate(gltf, 1, "/nodes/0/translation", {0, 1}, {0, 0, 0}, "VEC3");
  write("walk.gltf", gltf.text());
  const ProcessResult info = run({"info", "walk.gltf"});
  ASSERT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, ContainsRegex("skins +1 \\(1 joint\\)\n"));
  EXPECT_THAT(info.out, ContainsRegex("targets +2 \\(nodes: 1\\)\n"));
  EXPECT_THAT(info.out, ContainsRegex("animations +0 Walk, 1.5 s, 2 channels \\(translation: 1, scale: 1\\)\n"));
  EXPECT_THAT(info.out, ContainsRegex(" +1 \\(no name\\), 0 s, 0 channels, cannot be shown\n"));
  EXPECT_THAT(info.out, ContainsRegex("bounds +0 0 0 to 1 1 0"));
  EXPECT_THAT(run({"info", "walk.gltf", "--time", "1.5"}).out, ContainsRegex("bounds +2 0 0 to 4 2 0"));
  EXPECT_THAT(run({"info", "walk.gltf", "--time", "2.25", "--loop"}).out,
              ContainsRegex("bounds +1 0 0 to 2.75 1.75 0"));
  const json document = json::parse(run({"info", "walk.gltf", "--json"}).out);
  EXPECT_EQ(document["motion"]["animations"][0]["duration_s"], 1.5);
  EXPECT_EQ(document["motion"]["animations"][0]["channels"]["scale"], 1);
  EXPECT_EQ(document["motion"]["skins"][0]["joints"], 1);
  EXPECT_EQ(document["motion"]["morph_targets"], 2);
  gltf.json["nodes"][0]["scale"] = {0, 0, 0};
  write("hidden.gltf", gltf.text());
  const char* const nothing = "the scene contains nothing to draw";
  EXPECT_THAT(run({"info", "hidden.gltf"}).out, HasSubstr(nothing));
  EXPECT_THAT(run({"info", "hidden.gltf", "--time", "1"}).out, Not(HasSubstr(nothing)));
  expect_failure(run({"info", "walk.gltf", "--animation", "1"}), 3, "gltf.animation.count 1 2");
  EXPECT_THAT(run({"info", "square.gltf", "--time", "1"}).out,
              HasSubstr("the scene has no animations, so its pose does not depend on the time"));
}

TEST_F(CliTest, StrictRefusesWhatIsRequiredAndNotKnown) {
  write("foo.gltf",
        square_with("\"extensionsUsed\":", R"("extensionsRequired": ["KHR_materials_foo"], "extensionsUsed":)"));
  const ProcessResult info = run({"info", "foo.gltf"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("the file requires KHR_materials_foo, which is unknown"));
  EXPECT_THAT(info.out, ContainsRegex("extensions +used: KHR_lights_punctual, PROMIN_materials_phong\n"));
  EXPECT_THAT(info.out, ContainsRegex(" +ignored: KHR_materials_foo \\(required\\)\n"));
  const std::string refusal = "gltf.extension.required KHR_materials_foo";
  expect_failure(run({"info", "foo.gltf", "--strict"}), 3, refusal);
  expect_failure(run({"render", "foo.gltf", "-o", "a.exr", "--strict"}), 3, refusal);
}

TEST_F(CliTest, VariantsAreChosenByName) {
  const std::string variants =
      R"("extensions": {"KHR_materials_variants": {"variants": [{"name": "red"}, {"name": "green"}]}, )";
  write("cars.gltf", square_with("\"extensions\": {", variants));
  EXPECT_THAT(run({"info", "cars.gltf"}).out, HasSubstr("variants    red\n            green\n"));
  EXPECT_EQ(run({"info", "cars.gltf", "--variant", "green"}).exit_code, 0);
  expect_failure(run({"info", "cars.gltf", "--variant", "blue"}), 2, "scene.variant.unknown \"red\", \"green\"");
  expect_failure(run({"render", "cars.gltf", "-o", "a.exr", "--variant", "blue"}), 2, "scene.variant.unknown \"blue\"");
  expect_failure(run({"info", "square.gltf", "--variant", "blue"}), 2, "scene.variant.unknown \"blue\" remove");
  expect_failure(run({"info", "triangle.obj", "--variant", "blue"}), 2, "scene.variant.unknown .obj");
}

TEST_F(CliTest, TheRootWidensWhatASceneMayName) {
  std::filesystem::create_directories(folder() / "models");
  std::string text = square_with("\"indices\": 1", R"("indices": 1, "material": 0)");
  text.insert(text.rfind('}'), R"(, "materials": [{"normalTexture": {"index": 0}}], "textures": [{"source": 0}],
      "images": [{"uri": "../pictures/none.png"}])");
  write("models/square.gltf", text);
  EXPECT_THAT(run({"info", "models/square.gltf"}).out, HasSubstr("leads out of the scene's folder"));
  EXPECT_THAT(run({"info", "models/square.gltf", "--root", "."}).out, HasSubstr("a referenced file does not exist"));
  expect_failure(run({"info", "models/square.gltf", "--root", "none"}), 2, "scene.root.folder none:");
  expect_failure(run({"info", "models/square.gltf", "--strict"}), 3, "--root DIR");
}

TEST_F(CliTest, InfoTellsTexturesBySize) {
  const std::string pixel =
      "data:image/"
      "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNocFAAAAIkAOGVpLGLAAAAAElFTkSuQmCC";
  std::string text = square_with("\"indices\": 1", R"("indices": 1, "material": 0)");
  text.insert(text.rfind('}'), R"(, "materials": [{"normalTexture": {"index": 0}, "occlusionTexture": {"index": 1}}],
      "textures": [{"source": 0}, {"source": 1}], "images": [{"uri": ")" +
                                   pixel + R"("}, {"uri": "none.png"}])");
  write("pixel.gltf", text);
  const ProcessResult info = run({"info", "pixel.gltf"});
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_THAT(info.out, ContainsRegex("textures +2 of 2 images \\(1 of 1x1, 1 absent\\), 0.000 MB on the device\n"));
  EXPECT_THAT(info.out, HasSubstr("image images[1]: a referenced file does not exist (\"none.png\"); "));
}

/// Returns the square with a texture whose PNG has a wrong byte among its texels.
std::string square_with_broken_texels() {
  std::string text = square_with("\"indices\": 1", R"("indices": 1, "material": 0)");
  text.insert(text.rfind('}'), R"(, "materials": [{"normalTexture": {"index": 0}}], "textures": [{"source": 0}],
      "images": [{"uri": "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mNoAAAAAAAkAOGVpLGLAAAAAElFTkSuQmCC"}])");
  return text;
}

TEST_F(CliTest, InfoWarnsOfTexels) {
  write("broken.gltf", square_with_broken_texels());
  const std::string decoded = run({"info", "broken.gltf"}).out;
  EXPECT_THAT(decoded, ContainsRegex("warnings +image images\\[0\\]: a picture cannot be used: .*; "));
  const std::string skipped = run({"info", "broken.gltf", "--no-texels"}).out;
  EXPECT_THAT(skipped, ContainsRegex("textures +1 of 1 images \\(1 of 1x1\\)"));
  EXPECT_THAT(skipped, ContainsRegex("warnings +none\n"));
}

TEST_F(CliTest, InfoWarnsOfCamerasWithoutASensibleSize) {
  write("narrow.gltf", square_with("\"yfov\"", "\"aspectRatio\": 1e-6, \"yfov\""));
  EXPECT_THAT(
      run({"info", "narrow.gltf"}).out,
      HasSubstr("the camera's aspect ratio of 1e-06 is too extreme to compute the width of the picture; give --size"));
}

/// Returns the output of `promin info --json` for a scene.
class InfoJsonTest : public CliTest {
 protected:
  json info(const std::string& scene, const OptionValues& more = {}) {
    OptionValues arguments = {"info", scene, "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    text_ = result.out;
    return json::parse(text_);
  }

  /// Returns the keys in which two values differ, and the differing members of those that are objects.
  static std::set<std::string> differences(const json& a, const json& b) {
    std::set<std::string> places;
    for (const json& change : json::diff(a, b)) places.insert(change["path"].get<std::string>());
    return places;
  }

  std::string text_;
};

TEST_F(InfoJsonTest, SaysWhatASceneHolds) {
  write("square.gltf", make_default_gltf());
  const json scene = info("square.gltf");
  EXPECT_EQ(scene["file"], "square.gltf");
  EXPECT_EQ(scene["counts"]["objects"]["meshes"], 1);
  EXPECT_EQ(scene["counts"]["triangles"], 2);
  EXPECT_EQ(scene["counts"]["degenerate_triangles"], 0);
  EXPECT_EQ(scene["bounds"], json({{"lo", {-1, -1, 0}}, {"hi", {1, 1, 0}}}));
  const json& object = scene["objects"].at(0);
  EXPECT_EQ(object["number"], 0);
  EXPECT_EQ(object["world_from_object"], nullptr);
  EXPECT_EQ(object["geometry"]["kind"], "mesh");
  EXPECT_EQ(object["geometry"]["vertices"], 4);
  EXPECT_THAT(object["geometry"]["hashes"]["positions"].get<std::string>(), MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(object["geometry"]["hashes"]["normals"], nullptr);
  const json& material = scene["materials"].at(object["material"].get<size_t>());
  EXPECT_EQ(material["model"], "metallic_roughness");
  EXPECT_EQ(material["attenuation_distance"], nullptr) << "infinite";
  EXPECT_EQ(material["base_color_texture"], nullptr);
  EXPECT_EQ(scene["lights"].at(0)["kind"], "point");
  EXPECT_EQ(scene["lights"].at(0)["diffuse"], json({3, 3, 3}));
  EXPECT_EQ(scene["cameras"].at(0)["name"], "main");
  EXPECT_EQ(scene["environment"]["sky"]["kind"], "studio");
  EXPECT_EQ(scene["display"]["tone_mapping"], "neutral");
  EXPECT_THAT(scene["assumed"].dump(), HasSubstr("weak studio light"));
  EXPECT_EQ(scene["extensions"], json({{{"is_required", false}, {"is_used", true}, {"name", "KHR_lights_punctual"}}}));
  EXPECT_THAT(scene["warnings"], IsEmpty());
  // The file has the shortest decimal of the fp32 number.
  EXPECT_THAT(text_, HasSubstr("\"yfov\": 0.7853982"));
  EXPECT_EQ(scene.dump(1) + "\n", text_) << "keys are sorted";
}

TEST_F(InfoJsonTest, TellsWhatDiffers) {
  const json square = info("square.gltf");
  fs::create_directories(folder() / "other");
  write("other/square.gltf", kSquareGltf);
  EXPECT_EQ(info("other/square.gltf"), square);
  // The first vertex is at x = -1, which has the bytes 00 00 80 BF; -1.0625 has 00 00 88 BF.
  write("square.gltf", square_with("AACAvwAAgL8AAAAA", "AACIvwAAgL8AAAAA"));
  EXPECT_THAT(differences(square, info("square.gltf")),
              testing::ElementsAre("/bounds/lo/0", "/objects/0/geometry/hashes/positions"));
  write("square.gltf", square_with("{\"mesh\": 0}", R"({"mesh": 0, "rotation": [0, 0, 0, -1]})"));
  EXPECT_EQ(info("square.gltf"), square);
  write("square.gltf", square_with("{\"mesh\": 0}", R"({"mesh": 0, "translation": [0, 0, 1]})"));
  EXPECT_THAT(differences(square, info("square.gltf")),
              testing::ElementsAre("/bounds/hi/2", "/bounds/lo/2", "/objects/0/world_from_object"));
}

TEST_F(InfoJsonTest, OnlyStoredTrianglesTellWhetherObjectsShareAMesh) {
  json gltf = json::parse(kSquareGltf);
  gltf["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 1}}});
  gltf["scenes"][0]["nodes"].push_back(4);
  write("square.gltf", gltf.dump());
  const json shared = info("square.gltf");
  EXPECT_THAT(shared["objects"], testing::SizeIs(2));
  gltf["meshes"].push_back(gltf["meshes"][0]);
  gltf["nodes"][4]["mesh"] = 1;
  write("square.gltf", gltf.dump());
  const json apart = info("square.gltf");
  EXPECT_THAT(differences(apart, shared), testing::ElementsAre("/counts/stored_triangles"));
  EXPECT_EQ(apart["counts"]["stored_triangles"], apart["counts"]["triangles"]);
  EXPECT_EQ(shared["counts"]["stored_triangles"].get<int>() * 2, apart["counts"]["stored_triangles"]);
}

TEST_F(InfoJsonTest, HoldsTexelsByTheirHash) {
  std::string text = square_with_broken_texels();
  const std::string broken = "mNoAAAAAAAkAOGV";
  text.replace(text.find(broken), broken.size(), "mNocFAAAAIkAOGV");
  write("pixel.gltf", text);
  const json decoded = info("pixel.gltf");
  EXPECT_EQ(decoded["images"].at(0)["size"], json({1, 1}));
  EXPECT_EQ(decoded["images"].at(0)["use"], "normal");
  EXPECT_THAT(decoded["images"].at(0)["hash"].get<std::string>(), MatchesRegex("[0-9a-f]{16}"));
  EXPECT_EQ(decoded["textures"].at(0)["wrap_u"], "repeat");
  EXPECT_EQ(decoded["materials"].at(0)["normal_texture"]["texture"], 0);
  EXPECT_THAT(differences(decoded, info("pixel.gltf", {"--no-texels"})), testing::ElementsAre("/images/0/hash"));
}

TEST_F(CliTest, InfoSaysWhatIsAssumed) {
  write("square.gltf", make_default_gltf());
  const std::string lit = run({"info", "square.gltf"}).out;
  EXPECT_THAT(lit,
              ContainsRegex("lights +1 \\(point: 1.*; assumed: weak studio light in addition to the scene's own\n"));
  EXPECT_THAT(lit, ContainsRegex("background +0.85 0.85 0.85 above to 0.55 0.55 0.55 below, as shown \\(assumed\\)\n"));
  EXPECT_THAT(lit, ContainsRegex("display +exposure \\+2 EV, tone mapping neutral\n"));

  const std::string bare = run({"info", "triangle.obj"}).out;
  EXPECT_THAT(bare, ContainsRegex("lights +0; assumed: the light of a studio\n"));
  EXPECT_THAT(
      bare, ContainsRegex("cameras +0; assumed: a camera that frames the scene from the front, because it is flat\n"));
  EXPECT_THAT(bare, ContainsRegex("background +.* above to .* below, as shown \\(assumed\\)\n"));
  EXPECT_THAT(bare, ContainsRegex("display +exposure \\+0 EV, tone mapping neutral\n"));
  EXPECT_THAT(bare, ContainsRegex("features +.*a sky"));

  write("classic.gltf", classic_square());
  const std::string classic = run({"info", "classic.gltf"}).out;
  EXPECT_THAT(classic, ContainsRegex("lights +0; assumed: a headlight along the view and ambient light of 0.1\n"));
  EXPECT_THAT(classic, ContainsRegex(
                           "cameras +0; assumed: a camera that frames the scene from the front, because it is flat\n"));
  EXPECT_THAT(classic, ContainsRegex("background +0 0 0\n"));
  EXPECT_THAT(classic, ContainsRegex("display +exposure \\+0 EV, tone mapping none\n"));
}

TEST_F(CliTest, DevicesNamesTheDefault) {
  const ProcessResult devices = run({"devices"});
  EXPECT_EQ(devices.exit_code, 0) << devices.err;
  EXPECT_THAT(devices.out, StartsWith("index"));
  EXPECT_THAT(devices.out, HasSubstr("picked by default"));
  EXPECT_EQ(devices.out.find("llvmpipe") != std::string::npos,
            devices.out.find("--threads N sets it") != std::string::npos);
}

TEST_F(CliTest, ADeviceIsFoundByItsUuid) {
  const nlohmann::json devices = nlohmann::json::parse(run({"devices", "--json"}).out);
  const std::string uuid = devices.at(0).at("uuid");
  EXPECT_THAT(uuid, MatchesRegex("[0-9a-f]{32}"));
  EXPECT_NE(uuid, std::string(32, '0'));
  const ProcessResult result =
      run({"render", "square.gltf", "--size", "4", "4", "-o", "a.exr", "--device", "uuid:" + uuid});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  expect_failure(run({"render", "square.gltf", "-o", "b.exr", "--device", "uuid:" + std::string(32, '0')}), 4,
                 "no Vulkan device matches \"uuid:0000");
}

TEST_F(CliTest, AQualityNamesSamplesOrAnError) {
  const auto summary = [&](const OptionValues& options) {
    OptionValues command = {"render", "square.gltf", "--size", "16", "9", "-o", "a.png"};
    command.insert(command.end(), options.begin(), options.end());
    return run(command).out;
  };
  EXPECT_THAT(summary({"--quality", "draft"}), HasSubstr(", 1 spp, "));
  EXPECT_THAT(summary({"--quality", "normal"}), HasSubstr(", 8 spp, "));
  EXPECT_THAT(summary({"--quality", "high"}), HasSubstr(", 32 spp, "));
  EXPECT_THAT(summary({"--quality", "best"}), HasSubstr(" spp, error 0.00390625 as shown"));
  EXPECT_THAT(summary({"--quality", "best", "--shading", "uv"}), HasSubstr(", 128 spp, "));
  expect_failure(run({"render", "square.gltf", "-o", "b.png", "--quality", "high", "--spp", "2"}), 2,
                 "--quality and --spp contradict each other");
}

TEST_F(CliTest, ATimeLimitHasUnitsAndNamesWhatGivesThePictureAgain) {
  const OptionValues picture = {"render", "square.gltf", "--size", "16", "9", "--max-spp", "8"};
  for (const std::string time : {"1ms", "0.001s", "0.001"}) {
    OptionValues command = picture;
    command.insert(command.end(), {"-o", "a.exr", "--time-limit", time});
    const ProcessResult result = run(command);
    EXPECT_THAT(result.err, HasSubstr(" s, longer than the limit of 0.001 s: even one sample per pixel takes longer"));
    EXPECT_THAT(result.err, HasSubstr("the same picture again: --spp 1\n"));
    EXPECT_THAT(result.out, StartsWith("16x9, 1 spp, "));
  }
  EXPECT_EQ(run({"render", "square.gltf", "--size", "16", "9", "--spp", "1", "-o", "b.exr"}).exit_code, 0);
  EXPECT_EQ(read("a.exr"), read("b.exr"));
  OptionValues command = picture;
  command.insert(command.end(), {"-o", "a.exr", "--time-limit", "2min"});
  const std::string notes = run(command).err;
  EXPECT_THAT(notes, HasSubstr("the same picture again: --target-error 1.5258789e-05 "));
  EXPECT_THAT(notes, HasSubstr("--max-spp allows 8 samples per pixel; --max-spp 32 uses more of the time\n"));
  expect_failure(run({"render", "square.gltf", "-o", "a.exr", "--time-limit", "2weeks"}), 2,
                 "--time-limit takes a number from 0.001 to ");
}

TEST_F(CliTest, RenderWritesPicturesAndSaysSoInOneLine) {
  write("square.gltf", make_default_gltf());
  const ProcessResult result = run({"render", "square.gltf", "--size", "64", "36", "--background",
                                    "linear:0.0625,0.0625,0.0625", "-o", "a.exr", "-o", "a.png"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("64x36, 8 spp, "));
  EXPECT_THAT(result.out, HasSubstr(": a.exr, a.png\n"));
  EXPECT_EQ(std::count(result.out.begin(), result.out.end(), '\n'), 1);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.exr", "a.png"));

  const Image exr = read_image(folder() / "a.exr");
  ASSERT_EQ(exr.size, uvec2(64, 36));
  // 3 candela at a distance of 2 give 0.75 lux, which 2 stops raise to about pi.
  EXPECT_EQ(exr.at(0, 0), vec3(0.0625F)) << "EXR files are not exposed";
  EXPECT_NE(exr.at(32, 18), vec3(0.0625F)) << "the square is seen";
  expect_displayed(exr, read_image(folder() / "a.png"), {.exposure_ev = 2.0F, .tone_mapping = ToneMapping::kNeutral});
}

TEST_F(CliTest, PicturesAreShownAsAsked) {
  write("square.gltf", make_default_gltf());
  const std::pair<OptionValues, DisplayTransform> cases[] = {
      {{"--tone-mapping", "none"}, {2.0F, ToneMapping::kNone}},
      {{"--exposure", "0.5"}, {0.5F, ToneMapping::kNeutral}},
      {{"--exposure", "3", "--exposure", "auto", "--tone-mapping", "aces"}, {2.0F, ToneMapping::kAces}},
      {{"--tone-mapping", "reinhard"}, {2.0F, ToneMapping::kReinhard}},
      {{"--tone-mapping", "agx", "--exposure", "0"}, {0.0F, ToneMapping::kAgx}},
      {{"--exposure", "-1", "--shading", "normals"}, {}}};
  for (const auto& [options, display] : cases) {
    SCOPED_TRACE(testing::PrintToString(options));
    OptionValues arguments = {"square.gltf", "--size", "32", "18", "--background", "linear:0.1,0.2,0.3", "-o", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Image exr = render(arguments, "a.exr");
    expect_displayed(exr, read_image(folder() / "a.png"), display);
    const std::string header = read("a.exr");
    // In the header, four bytes before a value give its length.
    const auto value_of = [&](const std::string& name, size_t length) {
      return header.substr(header.find(name) + name.size() + sizeof "string" + 5, length);
    };
    const std::string mapping(tone_mapping_names()[static_cast<size_t>(display.tone_mapping)]);
    EXPECT_EQ(value_of("promin:tone_mapping", mapping.size()), mapping);
    const std::string exposure = display.exposure_ev == 0.5F ? "0.5" : display.exposure_ev == 2.0F ? "2" : "0";
    EXPECT_EQ(value_of("promin:exposure_ev", exposure.size()), exposure);
  }
  // Exposure and tone mapping do not change the light itself, and a crop does not change the picture.
  const OptionValues plain = {"square.gltf", "--size", "32", "18"};
  OptionValues exposed = plain;
  exposed.insert(exposed.end(), {"--exposure", "5", "--tone-mapping", "none"});
  EXPECT_EQ(render(plain, "a.exr").pixels, render(exposed, "b.exr").pixels);
  OptionValues crop = plain;
  crop.insert(crop.end(), {"--crop", "8", "4", "24", "14"});
  const Image whole = render(plain, "a.png");
  const Image part = render(crop, "b.png");
  for (uint32_t x = 0; x < 16; ++x) EXPECT_EQ(part.at(x, 3), whole.at(x + 8, 7));
}

TEST_F(CliTest, UnlitColoursKeepClearOfExposureAndToneMapping) {
  write("mixed.gltf", make_mixed_gltf());
  const vec3 color(0.5F, 0.25F, 0.02F);
  const std::pair<OptionValues, std::optional<DisplayTransform>> cases[] = {
      {{}, DisplayTransform{2.0F, ToneMapping::kNeutral}},
      {{"--exposure", "4", "--tone-mapping", "aces", "--spp", "4", "--alpha"},
       DisplayTransform{4.0F, ToneMapping::kAces}},
      {{"--exposure", "average"}, std::nullopt},
      {{"--exposure", "-3", "--tone-mapping", "agx", "--target-error", "0.05", "--error-in", "display"},
       DisplayTransform{-3.0F, ToneMapping::kAgx}}};
  for (const auto& [options, display] : cases) {
    SCOPED_TRACE(testing::PrintToString(options));
    OptionValues arguments = {"mixed.gltf", "--size", "64", "36", "-o", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    // One sample is used unless the case gives another number, because sums of more samples round.
    if (std::ranges::none_of(options, [](const std::string& w) { return w == "--spp" || w == "--target-error"; })) {
      arguments.insert(arguments.end(), {"--spp", "1"});
    }
    const Image exr = render(arguments, "a.exr");
    const Image png = read_image(folder() / "a.png");
    const uvec2 lit(19, 18);
    const uvec2 unlit(45, 18);
    EXPECT_EQ(exr.at(unlit.x, unlit.y), color);
    EXPECT_EQ(read("a.exr").find("unlit."), std::string::npos) << "nobody has asked for it";
    for (int c = 0; c < 3; ++c) {
      EXPECT_EQ(std::lround(255.0F * png.at(unlit.x, unlit.y)[c]), std::lround(255.0F * encode_srgb(color[c])));
      if (!display) continue;
      const vec3 shown = apply(*display, exr.at(lit.x, lit.y));
      EXPECT_EQ(std::lround(255.0F * png.at(lit.x, lit.y)[c]), std::lround(255.0F * encode_srgb(shown[c])));
    }
  }
  render({"mixed.gltf", "--size", "64", "36", "--aov", "unlit", "-o", "b.png"}, "b.exr");
  EXPECT_NE(read("b.exr").find("unlit.A"), std::string::npos);
  expect_failure(run({"render", "mixed.gltf", "--aov", "unlit", "--shading", "normals"}), 2, "--aov of light");
}

TEST_F(CliTest, ThePictureMayTellItsExposure) {
  const OptionValues options = {"square.gltf", "--size", "32", "18", "--spp", "1", "--background", "linear:9,9,9"};
  OptionValues with_ids = options;
  with_ids.insert(with_ids.end(),
                  {"--exposure", "average", "--tone-mapping", "none", "-o", "a.png", "--aov", "object"});
  const Image exr = render(with_ids, "a.exr");
  std::vector<uint32_t> objects;
  for (const vec3& pixel : exr.pixels) objects.push_back(pixel == vec3(9.0F) ? Aovs::kNoId : 0);
  const float stops = average_exposure_ev(exr.pixels, objects);
  EXPECT_NE(stops, 0.0F);
  expect_displayed(exr, read_image(folder() / "a.png"), {.exposure_ev = stops});
  EXPECT_EQ(exr.pixels, render(options, "b.exr").pixels);
}

TEST_F(CliTest, DitheringHangsOnThePlaceInTheWholePicture) {
  write("square.gltf", make_default_gltf());
  const OptionValues options = {"square.gltf", "--size", "32", "18", "--tone-mapping", "none", "--exposure", "0"};
  OptionValues dithered = options;
  dithered.emplace_back("--dither");
  const Image plain = render(options, "a.png");
  const Image noisy = render(dithered, "b.png");
  size_t differing = 0;
  for (size_t i = 0; i < plain.pixels.size(); ++i) {
    differing += plain.pixels[i] != noisy.pixels[i] ? 1 : 0;
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(plain.pixels[i][c], noisy.pixels[i][c], 2.01F / 255.0F);
  }
  EXPECT_GT(differing, plain.pixels.size() / 4);
  dithered.insert(dithered.end(), {"--crop", "8", "4", "24", "14"});
  const Image crop = render(dithered, "c.png");
  for (uint32_t x = 0; x < 16; ++x) EXPECT_EQ(crop.at(x, 3), noisy.at(x + 8, 7));
}

TEST_F(CliTest, OfAMissingSceneNothingIsSaidToBeWritten) {
  const ProcessResult result = run({"render", "nope.gltf"});
  expect_failure(result, 3, "file.missing nope.gltf:");
  EXPECT_THAT(result.err, testing::StartsWith("promin: "));
}

// Without -o the picture has the scene's name and lies in the current folder. It replaces only pictures that promin
// made of a scene of this name.
TEST_F(CliTest, PicturesHaveTheScenesNameByDefault) {
  const ProcessResult result = run({"render", "square.gltf", "--size", "8", "8"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("promin: note: writing square.exr and square.png\n"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("square.exr", "square.png"));
  const std::string before = read("square.png");
  EXPECT_EQ(run({"render", "square.gltf", "--size", "9", "9"}).exit_code, 0);
  EXPECT_EQ(read_image(folder() / "square.png").size, uvec2(9));
  EXPECT_EQ(read_image(folder() / "square.exr").size, uvec2(9));
  for (const char* name : {"square.png", "square.exr"}) {
    // One picture shows another scene, and one names no scene.
    run({"render", "triangle.obj", "-o", name, "--size", "8", "8"});
    const std::string other = read(name);
    expect_failure(
        run({"render", "square.gltf", "--size", "7", "7"}), 2,
        name +
            std::string(" exists already and promin did not make it from square.gltf; give the file to write with -o"));
    EXPECT_EQ(read(name), other);
    write(name, "my notes");
    expect_failure(run({"render", "square.gltf"}), 2, "exists already and promin did not make it");
    EXPECT_EQ(run({"render", "square.gltf", "-o", name, "--size", "8", "8"}).exit_code, 0) << "-o replaces";
  }
  EXPECT_EQ(read("square.png"), before);
}

TEST_F(CliTest, APictureGoesToTheStandardOutput) {
  const OptionValues words = {"render", "square.gltf", "--size", "8", "8", "--quality", "draft"};
  OptionValues to_file = words;
  to_file.insert(to_file.end(), {"-o", "a.png"});
  ASSERT_EQ(run(to_file).exit_code, 0);
  OptionValues to_output = words;
  to_output.insert(to_output.end(), {"-o", "-", "-o", "b.webp"});
  const ProcessResult result = run(to_output);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, read("a.png"));
  EXPECT_THAT(result.err, HasSubstr("8x8, 1 spp"));
  EXPECT_THAT(files(), testing::UnorderedElementsAre("a.png", "b.webp"));
}

TEST_F(CliTest, TheBackgroundIsTheUsers) {
  const OptionValues size = {"triangle.obj", "--size", "32", "18", "--spp", "1"};
  const auto corner = [&](const OptionValues& options) {
    OptionValues arguments = size;
    arguments.insert(arguments.end(), options.begin(), options.end());
    return render(arguments, "a.exr").at(0, 0);
  };
  EXPECT_LT(kStudioBackdropTop - corner({}).x, 0.02F) << "the gradient's upper end";
  EXPECT_EQ(corner({"--background", "linear:0.5,0,2"}), vec3(0.5F, 0.0F, 2.0F));
  EXPECT_EQ(corner({"--background", "1", "0", "0.04045"}), vec3(1.0F, 0.0F, static_cast<float>(0.04045 / 12.92)))
      << "sRGB";
  EXPECT_EQ(corner({"--background", "lime", "--exposure", "-3"}), vec3(0.0F, 1.0F, 0.0F))
      << "an EXR has what is shown without exposure";
  EXPECT_EQ(corner({"--light", "headlight", "--background", "environment"}), vec3(0.1F)) << "the ambient light";
  EXPECT_EQ(corner({"--light", "headlight", "--background=environment"}), vec3(0.1F));
  // The option takes exactly one word, even if more words follow.
  OptionValues arguments = {"render", "--light", "headlight", "--background", "environment"};
  arguments.insert(arguments.end(), size.begin(), size.end());
  arguments.insert(arguments.end(), {"-o", "b.exr"});
  EXPECT_EQ(run(arguments).exit_code, 0);
  EXPECT_EQ(read_image(folder() / "b.exr").at(0, 0), vec3(0.1F));
}

// The background has exactly the given colour under every display transform. At an edge it is weighted by the fraction
// of the pixel that it covers.
TEST_F(CliTest, ABackgroundIsShownAsItIsGiven) {
  const auto codes_at = [](const Image& image, uint32_t x, uint32_t y) {
    return uvec3(glm::round(255.0F * image.at(x, y)));
  };
  const std::pair<const char*, uvec3> colors[] = {{"white", uvec3(255)},
                                                  {"BLACK", uvec3(0)},
                                                  {"#369", uvec3(0x33, 0x66, 0x99)},
                                                  {"#336699", uvec3(0x33, 0x66, 0x99)}};
  for (const auto& [word, codes] : colors) {
    for (const std::string_view mapping : tone_mapping_names()) {
      // Only two colours are tested with every tone mapping, because the other two would test nothing new.
      const bool is_each_mapped = word == std::string_view("white") || word == std::string_view("#369");
      if (!is_each_mapped && mapping != tone_mapping_names().front()) continue;
      render({"triangle.obj", "--size", "32", "18", "--spp", "2", "--exposure", "1.5", "--background", word, "-o",
              "a.png", "--tone-mapping", std::string(mapping), "--dither"},
             "a.exr");
      const uvec3 shown = codes_at(read_image(folder() / "a.png"), 0, 0);
      const bool is_end = codes == uvec3(0) || codes == uvec3(255);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(shown[c], codes[c], is_end ? 0 : 1) << word << ", " << mapping;
    }
  }
  // The scene looks the same in front of any background. The background fills the rest of each pixel, in linear light.
  const auto show = [&](const char* word) {
    render({"triangle.obj", "--size", "32", "18", "--spp", "16", "--tone-mapping", "aces", "--background", word, "-o",
            "a.png"},
           "a.exr");
    std::vector<float> shown;
    for (const vec3& pixel : read_image(folder() / "a.png").pixels) shown.push_back(linear_of_srgb(pixel).x);
    return shown;
  };
  const std::vector<float> white = show("white");
  const std::vector<float> black = show("black");
  const std::vector<float> grey = show("gray");
  const float of_grey = linear_of_srgb(vec3(128.0F / 255.0F)).x;
  size_t edges = 0;
  for (size_t i = 0; i < white.size(); ++i) {
    const float share = white[i] - black[i];
    EXPECT_NEAR(grey[i], black[i] + share * of_grey, 0.01F) << i;
    if (share > 0.2F && share < 0.8F) ++edges;
  }
  EXPECT_GT(edges, 5U);
}

// The picture has the file's camera, a headlight and a black background, as in versions before the studio existed.
TEST_F(CliTest, ClassicLightGivesClassicPictures) {
  write("classic.gltf", classic_square());
  const gpu::DeviceHandle device = gpu::open_device();
  const std::pair<const char*, OptionValues> cases[] = {
      {"classic.gltf", {}}, {"triangle.obj", {"--light", "headlight", "--background", "0", "0", "0"}}};
  for (const auto& [file, options] : cases) {
    Scene scene = load_scene(folder() / file);
    add_default_lights(scene);
    View view;
    view.size = uvec2(64, 36);
    view.camera = frame_scene(scene, 16.0F / 9.0F);
    const Image expected = Renderer(*device, scene).render(view).image;
    OptionValues arguments = {file, "--size", "64", "36", "--spp", "1", "-o", "a.png"};
    arguments.insert(arguments.end(), options.begin(), options.end());
    const Image exr = render(arguments, "a.exr");
    EXPECT_EQ(exr.pixels, expected.pixels) << file;
    EXPECT_GT(exr.at(30, 20).x, 0.1F);
    EXPECT_EQ(exr.at(0, 0), vec3(0.0F));
    expect_displayed(exr, read_image(folder() / "a.png"), {});
  }
}

TEST_F(CliTest, QuietIsSilent) {
  const ProcessResult result = run({"render", "triangle.obj", "--size", "64", "36", "-o", "a.exr", "--quiet"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.out, IsEmpty());
  EXPECT_THAT(result.err, IsEmpty());
}

TEST_F(CliTest, WhatIsAssumedIsSaid) {
  // The list leaves out the note that a slow machine prints while it compiles.
  const auto notes_of = [&](OptionValues words) {
    words.insert(words.begin(), {"render", "--size", "64x36"});
    std::string notes = run(words).err;
    const std::string compiling = "promin: note: compiling ...\n";
    if (const size_t place = notes.find(compiling); place != std::string::npos) notes.erase(place, compiling.size());
    return notes;
  };
  EXPECT_EQ(notes_of({"triangle.obj", "-o", "a.exr"}),
            "promin: note: assumed: a camera that frames the scene from the front, because it is flat, the light of a "
            "studio, a grey background\n");
  write("square.gltf", make_default_gltf());
  const std::string shown = notes_of({"square.gltf", "-o", "a.exr", "-o", "a.png"});
  EXPECT_EQ(
      shown,
      "promin: note: assumed: the first of the file's 2 cameras, weak studio light in addition to the scene's own, a "
      "grey background, an exposure of +2 EV, tone mapping neutral\n");
  // For an EXR, only the errors are in display terms.
  EXPECT_EQ(notes_of({"square.gltf", "-o", "a.exr", "--target-error", "0.5", "--error-in", "display"}), shown);
  EXPECT_EQ(notes_of({"square.gltf", "-o", "a.png", "--camera", "0", "--light", "none", "--background", "0", "0", "0",
                      "--exposure", "0", "--tone-mapping", "aces"}),
            "");
}

TEST_F(CliTest, VerboseTellsTheSteps) {
  const ProcessResult result = run({"render", "square.gltf", "--size", "64", "36", "-o", "a.exr", "-v"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* part : {"loaded square.gltf", "BVH by ", "features: ", "upload "}) {
    EXPECT_THAT(result.err, HasSubstr(part));
  }
}

TEST_F(CliTest, ErrorsMayBeFractions) {
  render({"square.gltf", "--target-error", "1/64"}, "a.exr");
  render({"square.gltf", "--target-error", "0.015625"}, "b.exr");
  EXPECT_TRUE(read("a.exr") == read("b.exr"));
}

TEST_F(CliTest, ErrorsAsTheyAreShownAreTold) {
  const auto told = [&](const OptionValues& how) {
    OptionValues words = {"render", "square.gltf", "--size", "64", "36", "-o", "a.exr", "--stats", "s.json"};
    words.insert(words.end(), {"--target-error", "0.0625", "--background", "linear:0.1,0.1,0.1"});
    words.insert(words.end(), how.begin(), how.end());
    const ProcessResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return std::pair(result.out, nlohmann::json::parse(read("s.json")).at("error").at("in").get<std::string>());
  };
  const auto [linear, in_linear] = told({});
  EXPECT_THAT(linear, testing::AllOf(HasSubstr(" spp, error 0.0625"), testing::Not(HasSubstr(" as shown"))));
  EXPECT_EQ(in_linear, "linear");
  EXPECT_EQ(told({"--error-in", "linear"}).first.substr(0, 30), linear.substr(0, 30));
  const auto [shown, in_shown] = told({"--error-in", "display"});
  EXPECT_THAT(shown, HasSubstr(" spp, error 0.0625 as shown"));
  EXPECT_EQ(in_shown, "display");
  // The display transform decides how exact the picture has to be; with this exposure everything is white.
  const auto [white, in_white] = told({"--error-in", "display", "--exposure", "20", "--tone-mapping", "none"});
  EXPECT_THAT(white, HasSubstr(", 4 spp, error"));
  EXPECT_THAT(shown, testing::Not(HasSubstr(", 4 spp, error")));
  // In linear light, errors are fractions of white.
  EXPECT_THAT(linear, testing::Not(HasSubstr(", 4 spp, error")));
  EXPECT_THAT(told({"--exposure", "-20"}).first, HasSubstr(", 4 spp, error"));
  const auto [black, in_black] = told({"--error-in", "display", "--exposure", "-20", "--tone-mapping", "none"});
  EXPECT_THAT(black, HasSubstr(", 4 spp, error"));
}

TEST_F(CliTest, StatsHoldWhatTheInterfacePromises) {
  const ProcessResult result = run({"render", "square.gltf", "--size", "64", "36", "-s", "4", "--repeat", "3", "-o",
                                    "a.exr", "--stats", "s.json", "--builder", "median"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json stats = json::parse(read("s.json"));
  EXPECT_THAT(stats.at("device").get<std::string>(), Not(IsEmpty()));
  EXPECT_THAT(stats.at("driver").get<std::string>(), Not(IsEmpty()));
  EXPECT_EQ(stats.at("scene").at("objects"), 1);
  EXPECT_EQ(stats.at("scene").at("meshes"), 1);
  EXPECT_EQ(stats.at("scene").at("triangles"), 2);
  EXPECT_EQ(stats.at("scene").at("lights"), 1);
  EXPECT_EQ(stats.at("bvh").at("builder"), "median");
  EXPECT_GE(stats.at("bvh").at("nodes"), 1);
  EXPECT_GT(stats.at("bvh").at("bytes"), 0);
  EXPECT_GT(stats.at("bvh").at("sah_cost"), 0.0);
  for (const char* name : {"load", "bvh", "upload", "pipeline", "trace", "write", "total"}) {
    EXPECT_GE(stats.at("times_ms").at(name), 0.0) << name;
  }
  EXPECT_GT(stats.at("times_ms").at("trace"), 0.0);
  EXPECT_EQ(stats.at("rays").at("primary"), 64 * 36 * 4);
  EXPECT_GT(stats.at("rays").at("shadow"), 0);
  EXPECT_EQ(stats.at("rays").at("reflection"), 0);
  EXPECT_TRUE(stats.at("features").is_array());

  std::vector<double> runs = stats.at("trace_runs_ms");
  ASSERT_EQ(runs.size(), 3U);
  std::sort(runs.begin(), runs.end());
  EXPECT_EQ(stats.at("times_ms").at("trace"), runs[1]) << "the median";
  const double rays = stats.at("rays").at("primary").get<double>() + stats.at("rays").at("shadow").get<double>();
  EXPECT_NEAR(stats.at("mrays_per_s").get<double>(), rays / runs[1] / 1e3, 1e-6 * rays / runs[1]);
}

TEST_F(CliTest, StatsCountTheLightsThatAreOn) {
  const ProcessResult result =
      run({"render", "square.gltf", "--size", "8", "8", "-o", "a.exr", "--stats", "s.json", "--lights-off", "0,0,0"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(json::parse(read("s.json")).at("scene").at("lights"), 0);
}

TEST_F(CliTest, APictureDoesNotDependOnTheDriversThreads) {
  const OptionValues arguments = {"square.gltf", "--size", "150", "100", "-s", "2"};
  options_.environment["LP_NUM_THREADS"] = "1";
  const Image by_one = render(arguments, "one.exr");
  options_.environment["LP_NUM_THREADS"] = "3";
  const Image by_three = render(arguments, "three.exr");
  ASSERT_EQ(by_one.size, by_three.size);
  for (size_t i = 0; i < by_one.pixels.size(); ++i) ASSERT_EQ(by_one.pixels[i], by_three.pixels[i]) << "pixel " << i;
  // The option --threads has the same effect. Its kernels come from the cache that the other runs have filled.
  OptionValues with_threads = arguments;
  with_threads.insert(with_threads.end(), {"--threads", "2"});
  render(with_threads, "two.exr");
  EXPECT_EQ(read("two.exr"), read("one.exr"));
}

TEST_F(CliTest, ACropHasTheBitsOfTheWholePicture) {
  const Image whole = render({"square.gltf", "--size", "67", "41", "-s", "2"}, "whole.exr");
  const Image crop =
      render({"square.gltf", "--size", "67", "41", "-s", "2", "--crop", "13", "5", "50", "38"}, "crop.exr");
  ASSERT_EQ(crop.size, uvec2(37, 33));
  for (uint32_t y = 0; y < crop.size.y; ++y) {
    for (uint32_t x = 0; x < crop.size.x; ++x) {
      ASSERT_EQ(crop.at(x, y), whole.at(x + 13, y + 5)) << "pixel " << x + 13 << ", " << y + 5;
    }
  }
}

TEST_F(CliTest, RunsAndFeaturesDoNotChangeTheBits) {
  const Image once = render({"square.gltf", "--size", "64", "36"}, "a.exr");
  EXPECT_EQ(once.pixels, render({"square.gltf", "--size", "64", "36"}, "b.exr").pixels);
  // The debug view is used because its kernels with all features compile fastest; RendererTest has pictures.
  const OptionValues uv = {"square.gltf", "--size", "64", "36", "--shading", "uv"};
  OptionValues of_all = uv;
  of_all.insert(of_all.end(), {"--features", "all"});
  EXPECT_EQ(render(uv, "c.exr").pixels, render(of_all, "d.exr").pixels);
  EXPECT_EQ(once.pixels, render({"square.gltf", "--size", "64", "36", "--builder", "median"}, "e.exr").pixels);
}

TEST_F(CliTest, CamerasGoByNameAndByIndex) {
  const Image main = render({"square.gltf", "--size", "64", "36"}, "main.exr");
  const Image by_name = render({"square.gltf", "--size", "64", "36", "--camera", "side"}, "name.exr");
  const Image by_index = render({"square.gltf", "--size", "64", "36", "--camera", "1"}, "index.exr");
  EXPECT_EQ(by_name.pixels, by_index.pixels);
  EXPECT_NE(by_name.pixels, main.pixels);
}

TEST_F(CliTest, AFreePoseShowsWhatTheSameCameraShows) {
  const Image camera = render({"square.gltf", "--size", "64", "36", "--camera", "side"}, "camera.exr");
  const Image pose = render({"square.gltf", "--size", "64",   "36", "--eye", "1", "0.5",   "3",  "--direction", "0",
                             "0",           "-1",     "--up", "0",  "1",     "0", "--fov", "45", "--near",      "0.01"},
                            "pose.exr");
  EXPECT_EQ(pose.pixels, camera.pixels);
}

TEST_F(CliTest, TheDefaultSizeFollowsTheCamera) {
  EXPECT_EQ(render({"triangle.obj"}, "a.exr").size, uvec2(1280, 720));
}

TEST_F(CliTest, LongWorkTellsItsProgressInPlainLines) {
  // These arguments leave nothing to assume.
  const OptionValues arguments = {"render", "square.gltf",  "--camera", "0",  "--size", "4000",
                                  "4000",   "-s",           "4096",     "-o", "a.exr",  "--light",
                                  "none",   "--background", "0",        "0",  "0"};
  Process program(PROMIN_EXECUTABLE, arguments, options_);
  const auto tells_progress = [&] { return program.err().find(" left\n") != std::string::npos; };
  for (int i = 0; i < 600 && !tells_progress(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  program.send(SIGTERM);
  const ProcessResult result = program.wait();
  EXPECT_EQ(result.signal, SIGTERM);
  EXPECT_THAT(result.err, MatchesRegex("(promin: note: compiling ...\n)?(promin: [0-9]+ %, [0-9:]+ left\n)+"));
  EXPECT_THAT(files(), IsEmpty());
}

TEST_F(CliTest, AnInterruptLeavesNoPartialFile) {
  write("old.exr", "old");
  for (const int delay_ms : {30, 150, 600}) {
    Process program(PROMIN_EXECUTABLE,
                    {"render", "square.gltf", "--size", "2000", "2000", "-s", "4096", "-o", "old.exr", "-o", "a.png"},
                    options_);
    std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
    program.send(SIGINT);
    const ProcessResult result = program.wait();
    EXPECT_EQ(result.signal, SIGINT) << result.err;
    EXPECT_EQ(read("old.exr"), "old");
    EXPECT_THAT(files(), testing::ElementsAre("old.exr"));
  }
}

// The file that stores the data until the picture is complete has no name.
TEST_F(CliTest, AnInterruptLeavesNothingOfAPictureThatWaitsOnDisk) {
  write("old.exr", "old");
  Process program(PROMIN_EXECUTABLE,
                  {"render", "square.gltf", "--camera", "0", "--size", "4000", "4000", "--target-error", "1e-4",
                   "--max-spp", "32768", "-o", "old.exr", "--light", "none", "--background", "0", "0", "0"},
                  options_);
  const auto tells_progress = [&] { return program.err().find(" left\n") != std::string::npos; };
  for (int i = 0; i < 600 && !tells_progress(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  program.send(SIGINT);
  const ProcessResult result = program.wait();
  EXPECT_EQ(result.signal, SIGINT) << result.err;
  EXPECT_THAT(result.err, MatchesRegex("(promin: note: compiling ...\n)?(promin: [0-9]+ %, [0-9:]+ left\n)+"));
  EXPECT_EQ(read("old.exr"), "old");
  EXPECT_THAT(files(), testing::ElementsAre("old.exr"));
}

TEST_F(CliTest, AovsAreChannelsOfTheExr) {
  const OptionValues view = {"square.gltf", "--size", "16", "9"};
  const auto with = [&](OptionValues words) {
    words.insert(words.begin(), view.begin(), view.end());
    return words;
  };
  const Image plain = render(with({}), "plain.exr");
  const Image picture = render(with({"--aov", "depth,object"}), "a.exr");
  ASSERT_EQ(picture.size, plain.size);
  EXPECT_EQ(picture.pixels, plain.pixels);
  EXPECT_THAT(read("a.exr"), testing::AllOf(HasSubstr("object"), Not(HasSubstr("primitive")), Not(HasSubstr("N.X"))));

  expect_failure(run({"render", "square.gltf", "-o", "a.png", "--aov", "depth"}), 2, "--aov needs an EXR");
  expect_failure(run({"render", "square.gltf", "-o", "b.exr", "--aov", "depth,colour"}), 2, "not \"colour\"");
  EXPECT_EQ(
      run({"render", "square.gltf", "-o", "b.exr", "-o", "b.png", "--aov", "normal", "--size", "8", "8"}).exit_code, 0);
}

}  // namespace
}  // namespace promin
