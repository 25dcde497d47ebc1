// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check the plugin for pictures of other formats from a user's point of view. They check which functions
// work without the plugin, and which messages the programs print if it is missing or wrong.

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

  /// Expects that reading a picture fails with one line that contains this part.
  void expect_refusal(const std::string& part) const {
    write("a.tga", "a picture");
    expect_failure(run({"compare", "a.tga", "a.tga"}), 1, part);
  }

  /// Expects that a program finds the plugin. Its message is then about the picture.
  void expect_found(const fs::path& program) const {
    write("a.tga", "a picture");
    const ProcessResult result = Process(program, {"compare", "a.tga", "a.tga"}, options_).wait();
    EXPECT_EQ(result.exit_code, 3) << result.err;
  }
};

/// Returns how many lines of the dynamic loader's messages name a library.
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

TEST_F(PicturesPluginCliTest, WhatReadsNoUnusualPictureDoesWithoutIt) {
  write_rays("rays.npy", {{{0, 0, 4}, 0, {0, 0, -1}, 10}});
  for (const OptionValues& arguments :
       {OptionValues{"--version"}, OptionValues{"info", "square.gltf"}, OptionValues{"devices"},
        OptionValues{"cast", "square.gltf", "rays.npy", "-o", "hits.npy", "--quiet"},
        OptionValues{"render", "square.gltf", "--size", "8", "8", "--explain", "4", "4"},
        OptionValues{"render", "square.gltf", "--size", "8", "8", "-o", "a.exr", "-o", "a.png"},
        OptionValues{"render", "square.gltf", "--size", "8", "8", "--aov", "depth,normal", "-o", "b.exr"}}) {
    const ProcessResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << testing::PrintToString(arguments) << result.err;
  }
}

TEST_F(PicturesPluginCliTest, AMissingOneIsTold) {
  expect_refusal(
      "the plugin that reads pictures, libpromin_pictures.so, is missing in plugins; install all of promin, "
      "or "
      "name the plugin's folder in PROMIN_PLUGINS");
}

TEST_F(PicturesPluginCliTest, OneThatDoesNotLoadIsRefused) {
  write(fs::path("plugins") / kPlugin.filename(), "no library");
  expect_refusal("the plugin that reads pictures cannot be loaded (plugins/libpromin_pictures.so: ");
}

TEST_F(PicturesPluginCliTest, OneOfAnotherInterfaceIsRefused) {
  fs::copy_file(PROMIN_OTHER_PICTURES_PLUGIN, plugin());
  const std::string ours = std::to_string(PROMIN_PICTURES_INTERFACE);
  const std::string others = std::to_string(PROMIN_PICTURES_INTERFACE + 1);
  expect_refusal(
      "plugins/libpromin_pictures.so: the plugin that reads pictures belongs to another version of promin (its "
      "interface is " +
      others + ", not " + ours + "); ");
}

TEST_F(PicturesPluginCliTest, OneThatLacksAFunctionIsRefused) {
  fs::copy_file(PROMIN_BARE_PICTURES_PLUGIN, plugin());
  expect_refusal("is damaged (");
}

TEST_F(PicturesPluginCliTest, TheVariableNamesItsFolder) {
  fs::copy_file(kPlugin, plugin());
  // The program is copied to a folder where it finds no other plugin.
  fs::copy_file(PROMIN_EXECUTABLE, folder() / "promin");
  expect_found(folder() / "promin");
}

TEST_F(PicturesPluginCliTest, AProgramFindsItBesideItselfWhateverItIsCalledBy) {
  options_.environment.erase("PROMIN_PLUGINS");
  fs::create_symlink(PROMIN_EXECUTABLE, folder() / "link");
  expect_found(folder() / "link");

  // The files lie as in an installation.
  fs::create_directories(folder() / "prefix/bin");
  fs::create_directories(folder() / "prefix/lib/promin");
  const fs::path program = folder() / "prefix/bin/promin";
  fs::copy_file(PROMIN_EXECUTABLE, program);
  expect_failure(Process(program, {"compare", "a.tga", "a.tga"}, options_).wait(), 1, "is missing in /");
  fs::copy_file(kPlugin, folder() / "prefix/lib/promin" / kPlugin.filename());
  expect_found(program);
}

/// The list of libraries only saves time. A wrong or missing list does not change the result.
TEST_F(PicturesPluginCliTest, AWrongListOfLibrariesDoesNoHarm) {
  fs::copy_file(kPlugin, plugin());
  write("plugins/libpromin_pictures.libraries", "libnone.so.1\n\nlibz.so.1\n\x01");
  expect_found(PROMIN_EXECUTABLE);
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
