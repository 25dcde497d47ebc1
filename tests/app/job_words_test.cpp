// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "job_words.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>

#include "arguments.h"
#include "cast_options.h"
#include "render_options.h"

namespace promin::app {
namespace {

/// The command with each option that takes a file given "here", and what it cannot do without.
std::vector<std::string> arguments_of_files(CLI::App& program, CLI::App& command) {
  std::vector<std::string> words = {"promin", command.get_name()};
  for (const CLI::Option* option : command.get_options()) {
    const bool is_file = option->get_positional() || option->get_type_name().find("FILE") != std::string::npos ||
                         option->get_type_name().find(".npy") != std::string::npos ||
                         option->get_type_name().find("DIR") != std::string::npos;
    if (!is_file) continue;
    if (!option->get_positional()) words.push_back("--" + option->get_lnames().front());
    words.emplace_back("here");
  }
  std::vector<const char*> argv;
  for (const std::string& word : words) argv.push_back(word.c_str());
  EXPECT_TRUE(parse_arguments(program, static_cast<int>(argv.size()), argv.data()));
  return keep_arguments(command);
}

// A job is planned again from any folder, so that a new option that takes a file has to be among those that are kept by
// their absolute paths, or not kept.
TEST(JobWordsTest, EveryFileIsKeptByItsAbsolutePath) {
  CLI::App of_pictures("", "promin");
  RenderOptions pictures;
  CLI::App& render = add_command(of_pictures, "render", "");
  add_render_options(render, pictures);
  CLI::App of_rays("", "promin");
  CastOptions rays;
  CLI::App& cast = add_command(of_rays, "cast", "");
  add_cast_options(cast, rays);

  const std::string here = (std::filesystem::current_path() / "here").string();
  const std::vector<std::string> of_render = arguments_of_files(of_pictures, render);
  const std::vector<std::string> of_cast = arguments_of_files(of_rays, cast);
  EXPECT_THAT(of_render, testing::Not(testing::Contains("here")));
  EXPECT_THAT(of_cast, testing::Not(testing::Contains("here")));
  // The scene, --bvh, --environment, --path and --root; the scene, the rays, --bvh and --root.
  EXPECT_EQ(std::ranges::count(of_render, here), 5) << testing::PrintToString(of_render);
  EXPECT_EQ(std::ranges::count(of_cast, here), 4) << testing::PrintToString(of_cast);
}

/// The manifest's options of a picture's job, but for the first two, and what is kept of its arguments.
std::pair<jobs::Manifest, std::vector<std::string>> plan(const std::vector<std::string>& arguments) {
  CLI::App program("", "promin");
  RenderOptions options;
  CLI::App& render = add_command(program, "render", "");
  add_render_options(render, options);
  std::vector<const char*> words = {"promin", "render", "scene.gltf"};
  for (const std::string& argument : arguments) words.push_back(argument.c_str());
  EXPECT_TRUE(parse_arguments(program, static_cast<int>(words.size()), words.data()));
  return {begin_manifest("render", given_options(render)), keep_arguments(render)};
}

// What the manual has in brackets; the job is that of whoever does not say it.
TEST(JobWordsTest, DefaultsCountAsNotGiven) {
  const auto nothing = plan({});
  const std::vector<std::pair<std::string, std::string>> defaults = {{"--spp", "8"},
                                                                     {"--filter", "box"},
                                                                     {"--shading", "full"},
                                                                     {"--exposure", "auto"},
                                                                     {"--depth", "ray"},
                                                                     {"--compression", "zip"},
                                                                     {"--error-in", "linear"},
                                                                     {"-s", "8"},
                                                                     {"--environment-rotation", "0"},
                                                                     {"--light-rotation", "0"},
                                                                     {"--environment-intensity", "1"}};
  CLI::App program("", "promin");
  RenderOptions options;
  CLI::App& render = add_command(program, "render", "");
  add_render_options(render, options);
  for (const auto& [name, word] : defaults) {
    EXPECT_THAT(render.get_option(name)->get_description(), testing::HasSubstr("[" + word)) << name;
    const auto given = plan({name, word});
    EXPECT_EQ(given.first.options, nothing.first.options) << name;
    EXPECT_EQ(given.second, nothing.second) << name;
  }
  EXPECT_NE(plan({"--spp", "2"}).first.options, nothing.first.options);
  EXPECT_NE(plan({"--camera", "0"}).second, nothing.second) << "a camera may have that name";
}

}  // namespace
}  // namespace promin::app
