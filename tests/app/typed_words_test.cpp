// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/typed_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <sstream>

#include "options/arguments.h"
#include "options/cast_options.h"
#include "options/render_options.h"
#include "output/console.h"
#include "promin/error.h"
#include "work/pictures/view_setup.h"

namespace promin::app {
namespace {

using testing::HasSubstr;

std::vector<std::string> split(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), {}};
}

/// A program that renders and casts.
class TypedWordsTest : public testing::Test {
 protected:
  TypedWordsTest() {
    render_ = &add_command(program_, "render", "");
    add_render_options(*render_, pictures_);
    cast_ = &add_command(program_, "cast", "");
    add_cast_options(*cast_, rays_);
  }

  std::string spell(const std::string& line) const {
    std::string spelt;
    for (const std::string& word : spell_out(program_, split(line))) spelt += (spelt.empty() ? "" : " ") + word;
    return spelt;
  }

  void parse(const std::string& line) {
    const std::vector<std::string> words = split(line);
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    EXPECT_TRUE(parse_arguments(program_, static_cast<int>(argv.size()), argv.data()));
  }

  CLI::App program_{"", "promin"};
  CLI::App* render_ = nullptr;
  CLI::App* cast_ = nullptr;
  RenderSpec pictures_;
  CastSpec rays_;
};

TEST_F(TypedWordsTest, OtherNamesBecomeTheTables) {
  EXPECT_EQ(spell("promin render a.glb --samples 4 --transparent"), "promin render a.glb --spp 4 --alpha");
  EXPECT_EQ(spell("promin render a.glb --samples=4"), "promin render a.glb --spp=4");
  EXPECT_EQ(spell("promin cast a.glb rays.npy --samples 4"), "promin cast a.glb rays.npy --samples 4")
      << "what a command cannot do it does not know by another name";
}

TEST_F(TypedWordsTest, ASizeIsOneWord) {
  EXPECT_EQ(spell("promin render a.glb --size 64 48 -s 4"), "promin render a.glb --size 64x48 -s 4");
  EXPECT_EQ(spell("promin render a.glb --resolution 64 48"), "promin render a.glb --size 64x48");
  EXPECT_EQ(spell("promin render --size 64 a.glb"), "promin render --size 64 a.glb");
  EXPECT_EQ(spell("promin render a.glb --height 48 -s 4 --width=64"), "promin render a.glb --size 64x48 -s 4");
  EXPECT_EQ(spell("promin render a.glb --height 48"), "promin render a.glb --size x48");
  EXPECT_EQ(spell("promin render a.glb --width 64"), "promin render a.glb --size 64");
  EXPECT_EQ(spell("promin a.glb -w 64 -h 48 -o a.png"), "promin render a.glb --size 64x48 -o a.png");
  EXPECT_EQ(spell("promin a.glb -h"), "promin render a.glb -h") << "which is help";
  EXPECT_EQ(spell("promin render -h a.glb"), "promin render -h a.glb");
}

TEST_F(TypedWordsTest, NumbersMayHaveCommas) {
  EXPECT_EQ(spell("promin render a.glb --eye 1,-2,3e1 --spp 4"), "promin render a.glb --eye 1 -2 3e1 --spp 4");
  EXPECT_EQ(spell("promin render a.glb --look-at=1,2,3"), "promin render a.glb --look-at 1 2 3");
  EXPECT_EQ(spell("promin render a.glb --crop 0,0,8,8"), "promin render a.glb --crop 0 0 8 8");
  for (const char* line : {"promin render a.glb --eye 1,2", "promin render a.glb --eye 1,,3",
                           "promin render a.glb --lights-off 1,2,3", "promin render a.glb --background linear:1,2,3"}) {
    EXPECT_EQ(spell(line), line);
  }
  parse("promin render a.glb --eye 1,2,3 --direction 0,0,1 --up 0,1,0");
  EXPECT_EQ(pictures_.view.pose.eye, dvec3(1, 2, 3));
  EXPECT_EQ(pictures_.view.pose.up, dvec3(0, 1, 0));
}

TEST_F(TypedWordsTest, AxesMayBeCapitals) {
  parse("promin render a.glb --up Z");
  EXPECT_EQ(pictures_.view.pose.up, dvec3(0, 0, 1));
  parse("promin render a.glb --up -X");
  EXPECT_EQ(pictures_.view.pose.up, dvec3(-1, 0, 0));
}

TEST_F(TypedWordsTest, AnimationsMayHaveSeveralIndices) {
  EXPECT_EQ(spell("promin cast a.glb r.npy --animation 0 12 3 --time 4"),
            "promin cast a.glb r.npy --animation 0 --animation 12 --animation 3 --time 4");
  EXPECT_EQ(spell("promin cast --animation Walk 7 a.glb"), "promin cast --animation Walk 7 a.glb");
  EXPECT_EQ(spell("promin cast --animation 7 a.glb 5"), "promin cast --animation 7 a.glb 5");
}

TEST_F(TypedWordsTest, NormalsHaveOneNameOrTheOther) {
  for (const char* name : {"normal", "normals"}) {
    parse(std::string("promin render a.glb --shading ") + name + " --aov depth," + name);
    EXPECT_EQ(pictures_.view.debug_view, DebugView::kNormals) << name;
    EXPECT_TRUE(pictures_.aovs.normal) << name;
    pictures_ = {};
  }
}

TEST_F(TypedWordsTest, AFileIsRendered) {
  EXPECT_EQ(spell("promin a.glb -s 4"), "promin render a.glb -s 4");
  EXPECT_EQ(spell("promin -s 4 a.glb"), "promin render -s 4 a.glb");
  EXPECT_EQ(spell("promin a.glb --samples 4"), "promin render a.glb --spp 4");
  for (const char* line : {"promin rendr", "promin --help", "promin cast a.glb", "promin --version cast a.glb"}) {
    EXPECT_EQ(spell(line), line);
  }
}

TEST_F(TypedWordsTest, HelpAndVersionAreWordsToo) {
  EXPECT_EQ(spell("promin help"), "promin --help");
  EXPECT_EQ(spell("promin help render"), "promin render --help");
  EXPECT_EQ(spell("promin help rendr"), "promin rendr") << "which is refused";
  EXPECT_EQ(spell("promin help a.glb"), "promin a.glb");
  EXPECT_EQ(spell("promin version"), "promin --version");
  EXPECT_EQ(spell("promin render help"), "promin render help");
}

TEST_F(TypedWordsTest, SizesAreReadInEveryForm) {
  const std::pair<const char*, uvec2> sizes[] = {
      {"64x48", {64, 48}},      {"64 48", {64, 48}},  {"64,48", {64, 48}},      {"64", {64, 0}},
      {"x48", {0, 48}},         {"64*48", {64, 48}},  {"64\u00d748", {64, 48}}, {"hd", {1280, 720}},
      {"fullhd", {1920, 1080}}, {"4k", {3840, 2160}}, {"720p", {1280, 720}}};
  for (const auto& [words, size] : sizes) {
    parse(std::string("promin render a.glb --size ") + words);
    EXPECT_EQ(pictures_.view.size, size) << words;
  }
}

// The missing side follows from the camera.
TEST_F(TypedWordsTest, ASideFollowsFromTheCamera) {
  Scene scene;
  Camera camera;
  camera.aspect_ratio = 2.0F;
  scene.cameras = {camera};
  const Console silent(Verbosity::kQuiet);
  ViewOptions options;
  options.size = uvec2(64, 0);
  EXPECT_EQ(make_view(scene, options, silent).size, uvec2(64, 32));
  options.size = uvec2(0, 64);
  EXPECT_EQ(make_view(scene, options, silent).size, uvec2(128, 64));
  options.size = uvec2(0, kMaxSide);
  EXPECT_THROW(make_view(scene, options, silent), UsageError);
  scene.cameras.front().resolution = uvec2(30, 90);
  options.size = uvec2(10, 0);
  EXPECT_EQ(make_view(scene, options, silent).size, uvec2(10, 30));
}

// A suggestion must be an option of the command; another would not help.
TEST_F(TypedWordsTest, WhatIsMeantIsAnOptionOfTheCommand) {
  EXPECT_EQ(find_by_meaning(*render_, "--bg"), "--background");
  EXPECT_EQ(find_by_meaning(*render_, "--timeout"), "--time-limit");
  EXPECT_EQ(find_by_meaning(*render_, "--gpu"), "--device");
  EXPECT_EQ(find_by_meaning(*cast_, "--gpu"), "--device");
  EXPECT_EQ(find_by_meaning(*cast_, "--bg"), "");
  EXPECT_EQ(find_by_meaning(*render_, "--nothing-like-it"), "");
  EXPECT_EQ(find_by_meaning(*render_, "--transparent-background"), "--alpha");
  EXPECT_EQ(find_by_meaning(*render_, "--turntable"), "--path");
  EXPECT_EQ(find_command_by_meaning(program_, "diff"), "") << "this one compares nothing";
  add_command(program_, "compare", "");
  EXPECT_EQ(find_command_by_meaning(program_, "diff"), "compare");
}

}  // namespace
}  // namespace promin::app
