// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/spec_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "options/arguments.h"
#include "options/cast_options.h"
#include "options/render_options.h"
#include "promin/error.h"

namespace promin::work {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Returns the specification that a command line gives.
template <typename Spec>
Spec read_line(const std::string& name, void (*add_options)(CLI::App&, Spec&), const std::vector<std::string>& words) {
  CLI::App program("", "promin");
  Spec spec;
  CLI::App& command = app::add_command(program, name, "");
  add_options(command, spec);
  std::vector<const char*> argv = {"promin", name.c_str()};
  for (const std::string& word : words) argv.push_back(word.c_str());
  EXPECT_TRUE(app::parse_arguments(program, static_cast<int>(argv.size()), argv.data()));
  return spec;
}

RenderSpec of_render(std::vector<std::string> words) {
  words.insert(words.begin(), "scene.gltf");
  return read_line("render", app::add_render_options, words);
}

json write(const RenderSpec& spec) {
  return json::parse(write_spec(spec));
}

RenderSpec parse(const std::string& members) {
  return parse_spec<RenderSpec>(R"({"promin_render_spec": 1)" + (members.empty() ? "" : ", " + members) + "}",
                                "folder/spec.json");
}

std::string refusal(const std::string& members) {
  try {
    parse(members);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

const std::string kHere = std::filesystem::current_path().string() + "/";

/// Options with values, at least one for each kind and range, and the member that each option sets.
const std::pair<std::vector<std::string>, std::pair<const char*, json>> kOptions[] = {
    {{"-o", "a.exr", "-o", "-"}, {"output", {kHere + "a.exr", "-"}}},
    {{"--spp", "16"}, {"spp", 16}},
    {{"--quality", "high"}, {"quality", "high"}},
    {{"--target-error", "1/65536"}, {"target_error", 1.5258789e-05}},
    {{"--time-limit", "2min"}, {"time_limit", 120}},
    {{"--min-spp", "8"}, {"min_spp", 8}},
    {{"--max-spp", "64"}, {"max_spp", 64}},
    {{"--error-in", "display"}, {"error_in", "display"}},
    {{"--variant", "red"}, {"variant", "red"}},
    {{"--size", "640x480"}, {"size", {640, 480}}},
    {{"--size", "x480"}, {"size", {0, 480}}},
    {{"--filter", "tent"}, {"filter", "tent"}},
    {{"--filter-width", "0.1"}, {"filter_width", 0.1}},
    {{"--max-depth", "0"}, {"max_depth", 0}},
    {{"--seed", "4294967295"}, {"seed", 4294967295}},
    {{"--shading", "normals"}, {"shading", "normals"}},
    {{"--no-shadows"}, {"no_shadows", true}},
    {{"--lights-off", "2,0,2"}, {"lights_off", {0, 2}}},
    {{"--light", "headlight"}, {"light", "headlight"}},
    {{"--background", "environment"}, {"background", "environment"}},
    {{"--background", "0.1", "0.2", "1"}, {"background", {0.1, 0.2, 1}}},
    {{"--background", "linear:1,2,3.5"}, {"background", {{"linear", {1, 2, 3.5}}}}},
    {{"--exposure", "-0.7"}, {"exposure", -0.7}},
    {{"--exposure", "average"}, {"exposure", "average"}},
    {{"--tone-mapping", "none"}, {"tone_mapping", "none"}},
    {{"--dither"}, {"dither", true}},
    {{"--texture-memory", "64"}, {"texture_memory", 64}},
    {{"--camera", "0"}, {"camera", "0"}},
    {{"--from", "front"}, {"from", "front"}},
    {{"--fit", "0.5"}, {"fit", 0.5}},
    {{"--azimuth", "30"}, {"azimuth", 30}},
    {{"--elevation", "-30.25"}, {"elevation", -30.25}},
    {{"--roll", "1e-3"}, {"roll", 0.001}},
    {{"--zoom", "2"}, {"zoom", 2}},
    {{"--eye", "1", "2", "3e9"}, {"eye", {1, 2, 3e9}}},
    {{"--look-at", "1", "2", "3"}, {"look_at", {1, 2, 3}}},
    {{"--direction", "1", "2", "3"}, {"direction", {1, 2, 3}}},
    {{"--up", "-z"}, {"up", {0, 0, -1}}},
    {{"--fov", "33.3"}, {"fov", 33.3}},
    {{"--near", "0.1"}, {"near", 0.1}},
    {{"--environment", "sky.hdr"}, {"environment", kHere + "sky.hdr"}},
    {{"--environment-rotation", "90"}, {"environment_rotation", 90}},
    {{"--environment-intensity", "0.3"}, {"environment_intensity", 0.3}},
    {{"--light-rotation", "-90"}, {"light_rotation", -90}},
    {{"--crop", "1", "2", "3", "4"}, {"crop", {1, 2, 3, 4}}},
    {{"--path", "p.json"}, {"path", kHere + "p.json"}},
    {{"--frames", "3-7"}, {"frames", {3, 7}}},
    {{"--fps", "29.97"}, {"fps", 29.97}},
    {{"--fps", "stored"}, {"fps", "stored"}},
    {{"--pieces", "4"}, {"pieces", 4}},
    {{"--tiles", "4", "5"}, {"tiles", {4, 5}}},
    {{"--aov", "normal,depth,cryptomatte"}, {"aov", {"depth", "normal", "cryptomatte"}}},
    {{"--alpha"}, {"alpha", true}},
    {{"--depth", "plane"}, {"depth", "plane"}},
    {{"--half"}, {"half", true}},
    {{"--compression", "piz"}, {"compression", "piz"}},
    {{"--features", "all"}, {"features", "all"}},
    {{"--builder", "median"}, {"builder", "median"}},
    {{"--bvh", "a.pbvh"}, {"bvh", kHere + "a.pbvh"}},
    {{"--strict"}, {"strict", true}},
    {{"--root", "dir"}, {"root", kHere + "dir"}},
    {{"--time", "0"}, {"time", 0}},
    {{"--time", "0.1"}, {"time", 0.1}},
    {{"--animation", "Walk"}, {"animation", "Walk"}},
    {{"--animation", "0", "2", "--animation", "Run"}, {"animation", {"0", "2", "Run"}}},
    {{"--loop"}, {"loop", true}}};

TEST(SpecJsonTest, EachOptionIsAMemberThatReadsBack) {
  for (const auto& [words, member] : kOptions) {
    const RenderSpec spec = of_render(words);
    const json written = write(spec);
    EXPECT_EQ(written,
              json({{"promin_render_spec", 1}, {"scene", kHere + "scene.gltf"}, {member.first, member.second}}))
        << words.front();
    EXPECT_EQ(write(parse_spec<RenderSpec>(write_spec(spec), "elsewhere/spec.json")), written) << words.front();
  }
}

// A new option needs a row in the table of fields, or a place among the options that each process chooses.
TEST(SpecJsonTest, EveryOptionIsKnown) {
  const std::set<std::string> of_processes = {"explain",  "skip-existing", "job",     "piece",  "device",
                                              "threads",  "quiet",         "verbose", "repeat", "stats",
                                              "no-cache", "help",          "version", "look",   "framing"};
  CLI::App program("", "promin");
  RenderSpec pictures;
  CastSpec rays;
  CLI::App& render = app::add_command(program, "render", "");
  CLI::App& cast = app::add_command(program, "cast", "");
  app::add_render_options(render, pictures);
  app::add_cast_options(cast, rays);
  const auto check = [&](const CLI::App& command, const auto& parse_member) {
    for (const CLI::Option* option : command.get_options()) {
      if (option->get_lnames().empty() || of_processes.contains(option->get_lnames().back())) continue;
      std::string name = option->get_lnames().back();
      std::ranges::replace(name, '-', '_');
      try {
        parse_member("\"" + name + "\": null");
        ADD_FAILURE() << name << " takes null";
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr(name + " takes ")) << name;
      }
    }
  };
  check(render, parse);
  check(cast, [](const std::string& member) {
    parse_spec<CastSpec>(R"({"promin_cast_spec": 1, )" + member + "}", "spec.json");
  });
}

TEST(SpecJsonTest, TheTextIsCanonical) {
  EXPECT_EQ(
      write_spec(parse(R"("size": [64, 48], "aov": ["normal", "depth"], "scene": "/a.gltf", "quality": "normal")")),
      "{\n \"promin_render_spec\": 1,\n \"scene\": \"/a.gltf\",\n \"size\": [64,48],\n"
      " \"aov\": [\"depth\",\"normal\"]\n}\n");
  // write_spec_of_pieces() keeps exactly the members on which pieces depend.
  const RenderSpec spec = parse(R"("scene": "/a.gltf", "output": "a.exr", "pieces": 4)");
  EXPECT_THAT(write_spec(spec), HasSubstr("\"output\""));
  EXPECT_EQ(write_spec_of_pieces(spec),
            "{\n \"promin_render_spec\": 1,\n \"scene\": \"/a.gltf\",\n \"pieces\": 4\n}\n");
}

// A person may write these values as on a command line. They are written as numbers.
TEST(SpecJsonTest, ValuesMayBeInWords) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("size": "hd")", "\"size\": [1280,720]"},
      {R"("size": "640")", "\"size\": [640,0]"},
      {R"("size": "64\u00d748")", "\"size\": [64,48]"},
      {R"("background": "environment")", "\"background\": \"environment\""},
      {R"("background": "linear:0.5,2,8")", R"("background": {"linear":[0.5,2,8]})"},
      {R"("time_limit": "2min")", "\"time_limit\": 120"},
      {R"("time_limit": "500ms")", "\"time_limit\": 0.5"},
      {R"("up": "-z")", "\"up\": [0,0,-1]"}};
  for (const auto& [member, written] : cases) EXPECT_THAT(write_spec(parse(member)), HasSubstr(written)) << member;
  EXPECT_THAT(refusal(R"("filter": "gaus")"), HasSubstr("did you mean gauss?"));
  EXPECT_THAT(refusal(R"("size": "640:480")"), HasSubstr("size takes a size such as 640x480"));
  EXPECT_THAT(refusal(R"("size": "64x0")"),
              HasSubstr("size takes a whole number from 1 to 32768, not \"0\" in \"64x0\""));
  EXPECT_THAT(refusal(R"("background": "linear:1,nan,2")"), HasSubstr("background takes a number from 0 to 1e+09"));
  EXPECT_THAT(refusal(R"("time_limit": "2 parsecs")"), HasSubstr("time_limit takes a number from 0.001 to 1e+06"));
  EXPECT_THAT(refusal(R"("up": "w")"), HasSubstr("up takes three numbers, x, y, z"));
}

TEST(SpecJsonTest, NumbersKeepTheirBits) {
  std::mt19937 random(7);
  for (int i = 0; i < 2000; ++i) {
    RenderSpec spec;
    spec.view.look.exposure_ev = std::ldexp(std::uniform_real_distribution<float>(-64.0F, 64.0F)(random), -i % 100);
    spec.view.pose.near = std::ldexp(std::uniform_real_distribution<double>(0.0, 1.0)(random), -i % 200);
    const RenderSpec read = parse_spec<RenderSpec>(write_spec(spec), "spec.json");
    EXPECT_EQ(std::bit_cast<uint32_t>(*read.view.look.exposure_ev),
              std::bit_cast<uint32_t>(*spec.view.look.exposure_ev));
    EXPECT_EQ(std::bit_cast<uint64_t>(*read.view.pose.near), std::bit_cast<uint64_t>(*spec.view.pose.near));
  }
}

TEST(SpecJsonTest, FilesAreRelativeToTheSpecification) {
  EXPECT_EQ(parse(R"("scene": "a.gltf")").tracing.scene, "folder/a.gltf");
  EXPECT_EQ(parse(R"("scene": "/b/a.gltf")").tracing.scene, "/b/a.gltf");
  EXPECT_THAT(parse(R"("output": ["a.exr", "-"])").pictures, testing::ElementsAre("folder/a.exr", "-"));
  EXPECT_EQ(parse_spec<RenderSpec>(R"({"promin_render_spec": 1, "scene": "a.gltf"})", "-").tracing.scene, "a.gltf");
}

TEST(SpecJsonTest, WrongMembersAreRefusedTogether) {
  EXPECT_THAT(refusal(R"("max_dept": 3)"),
              HasSubstr("folder/spec.json: a specification has no member \"max_dept\"; did you mean max_depth?"));
  const std::string both = refusal(R"("spp": 0, "fit": 2)");
  EXPECT_THAT(both, HasSubstr("spp takes a whole number from 1 to 65535, not 0"));
  EXPECT_THAT(both, HasSubstr("fit takes a number from 0.05 to 1, not 2"));
  const std::pair<const char*, const char*> cases[] = {
      {R"("spp": 1.5)", "spp takes a whole number from 1 to 65535, not 1.5"},
      {R"("spp": "8")", "spp takes a whole number from 1 to 65535, not \"8\""},
      {R"("filter": "fox")", "filter takes box, tent, "},
      {R"("light": "auto")", "light takes studio, "},
      {R"("min_spp": 6)", "min_spp takes a power of two, not 6"},
      {R"("eye": [1, 2])", "eye takes three numbers, not [1,2]"},
      {R"("crop": [4, 0, 2, 2])", "crop takes X0, Y0, X1, Y1 with X0 < X1 and Y0 < Y1"},
      {R"("size": [0, 0])", "size takes a width and a height"},
      {R"("frames": [2, 1])", "frames takes the first frame and the last, not [2,1]"},
      {R"("aov": ["deep"])", "aov takes names from alpha, depth"},
      {R"("background": "lamp")", "background takes the name of a colour"},
      {R"("dither": 1)", "dither takes true or false, not 1"},
      {R"("scene": 1)", "scene takes a text, not 1"}};
  for (const auto& [members, sentence] : cases) EXPECT_THAT(refusal(members), HasSubstr(sentence));
  for (const char* text : {"{}", "[]", R"({"promin_cast_spec": 1})", R"({"promin_render_spec": 2})"}) {
    EXPECT_THROW(parse_spec<RenderSpec>(text, "spec.json"), InputError) << text;
  }
  EXPECT_THROW(parse_spec<RenderSpec>("{", "spec.json"), InputError);
}

TEST(SpecJsonTest, QualitiesStandForNumbersOfSamples) {
  const auto samples_of = [](const std::vector<std::string>& options) {
    RenderSpec spec = of_render(options);
    apply_quality(spec);
    return spec.view.samples_per_pixel;
  };
  EXPECT_EQ(samples_of({}), 8U);
  EXPECT_EQ(samples_of({"--quality", "draft"}), 1U);
  EXPECT_EQ(samples_of({"--quality", "high"}), 32U);
  EXPECT_EQ(samples_of({"--quality", "best"}), std::nullopt);
  EXPECT_EQ(samples_of({"--quality", "best", "--shading", "uv"}), 128U);
  EXPECT_EQ(samples_of({"--explain", "1", "2"}), 1U);
  for (const std::string integrator : {"direct", "path"}) {
    EXPECT_EQ(samples_of({"--integrator", integrator}), 32U);
    EXPECT_EQ(samples_of({"--integrator", integrator, "--quality", "draft"}), 4U);
    EXPECT_EQ(samples_of({"--integrator", integrator, "--quality", "high"}), 128U);
    EXPECT_EQ(samples_of({"--integrator", integrator, "--spp", "8"}), 8U);
    EXPECT_EQ(samples_of({"--integrator", integrator, "--explain", "1", "2"}), 1U);
    EXPECT_EQ(samples_of({"--integrator", integrator, "--shading", "uv"}), 8U) << "no noise";
  }
}

// The manual puts these options in brackets. A job with them equals a job without them.
TEST(SpecJsonTest, DefaultsCountAsNotGiven) {
  const std::vector<std::pair<std::string, std::string>> defaults = {
      {"--filter", "box"},       {"--shading", "full"},
      {"--exposure", "auto"},    {"--depth", "ray"},
      {"--compression", "zip"},  {"--error-in", "linear"},
      {"--quality", "normal"},   {"--environment-rotation", "0"},
      {"--light-rotation", "0"}, {"--environment-intensity", "1"}};
  for (const auto& [name, word] : defaults) {
    EXPECT_EQ(write_spec(of_render({name, word})), write_spec(of_render({}))) << name;
    EXPECT_TRUE(list_bits(of_render({name, word})).empty()) << name;
  }
}

TEST(SpecJsonTest, BitsHaveTheWordsOfOptions) {
  using Bits = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(
      list_bits(of_render({"--max-depth", "3", "--half", "--eye", "1", "2.5", "3", "--environment", "dir/a.hdr"})),
      (Bits{{"--max-depth", "3"}, {"--eye", "1 2.5 3"}, {"--environment", "a.hdr"}, {"--half", "given"}}));
  EXPECT_EQ(list_bits(of_render({"--time", "0.5", "--animation", "3", "1", "--loop"})),
            (Bits{{"--animation", "3 1"}, {"--time", "0.5"}, {"--loop", "given"}}));
  // These options change no bit.
  EXPECT_TRUE(list_bits(of_render({"-o", "a.exr", "--pieces", "3", "--builder", "median", "--root", "a"})).empty());
}

TEST(SpecJsonTest, AnOptionReplacesWhatItContradicts) {
  RenderSpec spec = of_render({"--target-error", "0.1", "--min-spp", "8"});
  clear_rivals(spec, "--spp");
  EXPECT_EQ(write_spec(spec), write_spec(of_render({})));
  spec = of_render({"--from", "top", "--fit", "0.5", "--alpha"});
  clear_rivals(spec, "--eye");
  clear_rivals(spec, "--background");
  clear_rivals(spec, "--device");
  EXPECT_EQ(write_spec(spec), write_spec(of_render({})));
}

}  // namespace
}  // namespace promin::work
