// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// The plugin for pictures as a user of the programs meets it: what starts without it, and what is said where it is
// missing or not the right one.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "cli_fixture.h"
#include "image/plugin/pictures.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

const fs::path kPlugin = PROMIN_PICTURES_PLUGIN;

class PicturesPluginCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    fs::create_directories(folder() / "plugins");
    options_.environment["PROMIN_PLUGINS"] = "plugins";
  }

  fs::path plugin() const { return folder() / "plugins" / kPlugin.filename(); }

  /// Rendering says so in one line, long before the picture would be whole, and leaves no file.
  void expect_refusal(const std::string& part) const {
    const OptionValues arguments = {"render", "square.gltf", "--size", "8", "8", "-o", "a.exr", "-o", "a.png"};
    const ProcessResult result = run(arguments);
    expect_failure(result, 1, part);
    EXPECT_THAT(result.err, testing::Not(HasSubstr("%"))) << "it was traced";
    EXPECT_THAT(files(), testing::ElementsAre("plugins"));
  }
};

/// How many lines of what the dynamic loader tells name a library.
std::ptrdiff_t count_libraries(const fs::path& program, const ProcessOptions& options) {
  ProcessOptions telling = options;
  telling.environment["LD_TRACE_LOADED_OBJECTS"] = "1";
  const std::string told = Process(program, {"--version"}, telling).wait().out;
  return std::count(told.begin(), told.end(), '\n');
}

TEST_F(CliTest, ProgramsStartWithFewLibraries) {
  for (const char* program : {PROMIN_EXECUTABLE, PROMIN_BVH_EXECUTABLE}) {
    const std::ptrdiff_t count = count_libraries(program, options_);
    EXPECT_GE(count, 2) << program << ": the loader tells nothing";
    EXPECT_LE(count, 40) << program;
  }
}

TEST_F(PicturesPluginCliTest, WhatTouchesNoPictureDoesWithoutIt) {
  write_rays("rays.npy", {{{0, 0, 4}, 0, {0, 0, -1}, 10}});
  for (const OptionValues& arguments :
       {OptionValues{"--version"}, OptionValues{"info", "square.gltf"}, OptionValues{"devices"},
        OptionValues{"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--quiet"},
        OptionValues{"render", "square.gltf", "--size", "8", "8", "--explain", "4", "4"}}) {
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << testing::PrintToString(arguments) << result.err;
  }
}

TEST_F(PicturesPluginCliTest, AMissingOneIsToldBeforeTheSceneIsRead) {
  expect_refusal(
      "the plugin that reads and writes pictures, libpromin_pictures.so, is missing, sought in plugins; install promin "
      "whole, or name the plugin's folder in PROMIN_PLUGINS");
  expect_failure(run({"render", "none.gltf", "-o", "a.exr"}), 1, "libpromin_pictures.so, is missing");
}

TEST_F(PicturesPluginCliTest, OneThatDoesNotLoadIsRefused) {
  write(fs::path("plugins") / kPlugin.filename(), "no library");
  expect_refusal("cannot load the plugin that reads and writes pictures (plugins/libpromin_pictures.so: ");
}

TEST_F(PicturesPluginCliTest, OneOfAnotherInterfaceIsRefused) {
  fs::copy_file(PROMIN_OTHER_PICTURES_PLUGIN, plugin());
  const std::string ours = std::to_string(PROMIN_PICTURES_INTERFACE);
  const std::string others = std::to_string(PROMIN_PICTURES_INTERFACE + 1);
  expect_refusal("belongs to another version of promin (its interface is " + others + ", not " + ours +
                 "), plugins/libpromin_pictures.so;");
}

TEST_F(PicturesPluginCliTest, OneThatLacksAFunctionIsRefused) {
  fs::copy_file(PROMIN_BARE_PICTURES_PLUGIN, plugin());
  expect_refusal("is damaged (");
}

TEST_F(PicturesPluginCliTest, TheVariableNamesItsFolder) {
  fs::copy_file(kPlugin, plugin());
  // A program with nothing beside it that it could take instead.
  fs::copy_file(PROMIN_EXECUTABLE, folder() / "promin");
  const ProcessResult result =
      Process(folder() / "promin", {"render", "square.gltf", "--size", "8", "8", "-o", "a.exr"}, options_).wait();
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_image(folder() / "a.exr").size, uvec2(8));
}

TEST_F(PicturesPluginCliTest, AProgramFindsItBesideItselfWhateverItIsCalledBy) {
  options_.environment.erase("PROMIN_PLUGINS");
  fs::create_symlink(PROMIN_EXECUTABLE, folder() / "link");
  const ProcessResult linked =
      Process(folder() / "link", {"render", "square.gltf", "--size", "8", "8", "-o", "a.exr"}, options_).wait();
  EXPECT_EQ(linked.exit_code, 0) << linked.err;

  // As it is installed.
  fs::create_directories(folder() / "prefix/bin");
  fs::create_directories(folder() / "prefix/lib/promin");
  fs::copy_file(PROMIN_EXECUTABLE, folder() / "prefix/bin/promin");
  const OptionValues arguments = {"render", "square.gltf", "--size", "8", "8", "-o", "b.exr"};
  expect_failure(Process(folder() / "prefix/bin/promin", arguments, options_).wait(), 1, "is missing, sought in /");
  fs::copy_file(kPlugin, folder() / "prefix/lib/promin" / kPlugin.filename());
  const ProcessResult installed = Process(folder() / "prefix/bin/promin", arguments, options_).wait();
  EXPECT_EQ(installed.exit_code, 0) << installed.err;
  EXPECT_EQ(read_image(folder() / "b.exr").pixels, read_image(folder() / "a.exr").pixels);
}

/// The list of libraries is only for speed: a wrong one, or none, changes nothing.
TEST_F(PicturesPluginCliTest, AWrongListOfLibrariesDoesNoHarm) {
  fs::copy_file(kPlugin, plugin());
  write("plugins/libpromin_pictures.libraries", "libnone.so.1\n\nlibz.so.1\n\x01");
  EXPECT_EQ(render({"square.gltf", "--size", "8", "8"}, "a.exr").size, uvec2(8));
}

TEST(PicturesPluginListTest, EachLibraryStandsAfterThoseThatItNeeds) {
  fs::path list = kPlugin;
  std::ifstream stream(list.replace_extension(".libraries"));
  std::vector<std::string> names;
  for (std::string name; std::getline(stream, name);) names.push_back(name);
  const auto place_of = [&](const std::string& part) {
    return std::find_if(names.begin(), names.end(), [&](const auto& name) { return name.starts_with(part); });
  };
  EXPECT_LT(place_of("libc.so"), place_of("libstdc++.so"));
  EXPECT_LT(place_of("libstdc++.so"), place_of("libOpenImageIO_Util.so"));
  EXPECT_LT(place_of("libOpenImageIO_Util.so"), place_of("libOpenImageIO.so"));
  EXPECT_NE(place_of("libOpenImageIO.so"), names.end());
}

}  // namespace
}  // namespace promin
