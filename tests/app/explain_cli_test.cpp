// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run `promin render --explain`, and the debug shadings of `--shading`.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "output/explanation.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

vec3 vector_of(const json& v) {
  return {v.at(0).get<float>(), v.at(1).get<float>(), v.at(2).get<float>()};
}

TEST_F(CliTest, ExplainPrintsWhatThePixelIsMadeOf) {
  write("square.gltf", make_default_gltf());
  const Image picture = render({"square.gltf", "--size", "64", "36", "-s", "2"}, "a.exr");
  for (const auto& [x, y] : {std::pair(32U, 18U), std::pair(0U, 0U)}) {
    const ProcessResult result = run(
        {"render", "square.gltf", "--size", "64", "36", "-s", "2", "--explain", std::to_string(x), std::to_string(y)});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, MatchesRegex("promin: note: assumed: [^\n]*\n(promin: note: compiling ...\n)?"));
    const json explanation = json::parse(result.out);
    EXPECT_EQ(explanation.at("pixel"), json({x, y}));
    EXPECT_EQ(vector_of(explanation.at("color")), picture.at(x, y));
    ASSERT_EQ(explanation.at("samples").size(), 2U);
    const json& ray = explanation.at("samples")[0].at("rays")[0];
    EXPECT_EQ(ray.at("kind"), "camera");
    EXPECT_EQ(vector_of(ray.at("origin")), vec3(0, 0, 4));
    EXPECT_EQ(ray.at("tmax"), nullptr) << "infinite";
    if (x == 0) {
      EXPECT_EQ(ray.at("hit"), nullptr);
      EXPECT_THAT(ray.at("sources"), IsEmpty());
      continue;
    }
    EXPECT_EQ(ray.at("hit").at("object"), 0);
    EXPECT_EQ(ray.at("hit").at("position")[2], 0.0);
    const json& source = ray.at("sources").at(0);
    EXPECT_EQ(source.at("visible"), true);
    EXPECT_EQ(source.at("shadow_ray").at("tmax").get<double>(), 1.0);
    EXPECT_EQ(source.at("shadow_ray").at("blocker"), nullptr);
    EXPECT_EQ(vector_of(ray.at("own")) + vector_of(source.at("contribution")), vector_of(ray.at("radiance")));
  }
}

TEST_F(CliTest, ExplainNamesInstances) {
  nlohmann::json gltf = json::parse(kSquareGltf);
  gltf["nodes"][0] = {{"name", "left"}, {"mesh", 0}, {"translation", {-1, 0, 0}}, {"scale", {0.75, 0.75, 0.75}}};
  gltf["nodes"].push_back({{"name", "right"}, {"mesh", 0}, {"translation", {1, 0, 0.5}}, {"scale", {-0.75, 0.75, 2}}});
  gltf["scenes"][0]["nodes"].push_back(4);
  write("pair.gltf", gltf.dump());
  for (const auto& [x, object, name, z] : {std::tuple(20, 0, "left", 0.0), std::tuple(44, 1, "right", 0.5)}) {
    const ProcessResult result = run({"render", "pair.gltf", "--size", "64", "36", "-s", "1", "--instances", "all",
                                      "--explain", std::to_string(x), "18"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json ray = json::parse(result.out).at("samples")[0].at("rays")[0];
    const json& hit = ray.at("hit");
    EXPECT_EQ(hit.at("object"), object);
    EXPECT_EQ(hit.at("object_name"), name);
    EXPECT_EQ(hit.at("position")[2], z);
    EXPECT_EQ(std::abs(hit.at("normal")[2].get<double>()), 1.0);
    // The point lies on the ray.
    const double t = hit.at("t").get<double>();
    for (size_t axis = 0; axis < 3; ++axis) {
      const double at = ray.at("origin")[axis].get<double>() + t * ray.at("direction")[axis].get<double>();
      EXPECT_NEAR(hit.at("position")[axis].get<double>(), at, 1e-5);
    }
  }
}

TEST_F(CliTest, ExplainGoesAloneAndStaysInThePicture) {
  const std::pair<OptionValues, std::string> cases[] = {
      {{"--explain", "64", "0"}, "view.pixel.outside 64x36"},
      {{"--explain", "0", "36"}, "view.pixel.outside"},
      {{"--explain", "1"}, "usage.option.few --explain"},
      {{"--explain", "-1", "0"}, "usage.option.value --explain"},
      {{"--explain", "1", "1", "-o", "a.exr"}, "usage.options.contradict --explain --output"},
      {{"--explain", "1", "1", "--path", "p.json"}, "usage.options.contradict --explain --path"},
      {{"--explain", "1", "1", "--aov", "depth"}, "usage.options.contradict --explain --aov"},
      {{"--explain", "1", "1", "--shading", "uv"}, "usage.options.contradict --explain --shading"},
      {{"--explain", "1", "1", "--stats", "s.json"}, "usage.options.contradict --explain --stats"},
      {{"--explain", "1", "1", "--repeat", "2"}, "usage.options.contradict --explain --repeat"},
      {{"--explain", "1", "1", "--crop", "0", "0", "2", "2"}, "usage.options.contradict --explain --crop"},
  };
  for (const auto& [more, part] : cases) {
    SCOPED_TRACE(testing::PrintToString(more));
    OptionValues arguments = {"render", "square.gltf", "--size", "64", "36"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_failure(run(arguments), 2, part);
    EXPECT_THAT(files(), IsEmpty());
  }
}

TEST_F(CliTest, ShadingsShowOtherThanLight) {
  const Image normals = render({"square.gltf", "--size", "64", "36", "--shading", "normals"}, "a.exr");
  EXPECT_EQ(normals.at(32, 18), vec3(0.5F, 0.5F, 1.0F));
  EXPECT_EQ(normals.at(0, 0), vec3(0.0F));
  expect_failure(run({"render", "square.gltf", "-o", "b.exr", "--shading", "light"}), 2, "--shading takes full, ");
}

TEST(ExplanationTest, TextNamesWhatIsHitAndWhatIsInTheWay) {
  Scene scene;
  scene.materials.resize(1);
  scene.materials[0].name = "matt";
  scene.add("ball", Sphere{});
  scene.lights = {Light{"key"}, Light{}, make_headlight()};
  Explanation explanation;
  explanation.pixel = uvec2(3, 4);
  explanation.color = vec3(0.25F);
  ExplainedRay ray;
  ray.hit.object = 0;
  ray.hit.primitive = 0;
  ray.hit.t = 2.0F;
  ExplainedSource visible{0, Ray{}, Hit{}, vec3(0.25F)};
  ExplainedSource blocked{1, Ray{}, ray.hit, vec3(0.0F)};
  ray.sources = {visible, blocked, {2, std::nullopt, Hit{}, vec3(0.0F)}};
  ExplainedRay mirrored;
  mirrored.kind = RayKind::kReflection;
  ExplainedRay refracted;
  refracted.kind = RayKind::kRefraction;
  explanation.samples = {{{ray, mirrored, refracted}}};
  const std::string text = app::explain_text(explanation, scene);
  for (const char* part :
       {"pixel 3 4: (0.25 0.25 0.25)\nsample 0\n  camera ray", "\n    hits object 0 \"ball\" primitive 0 at t 2,",
        "material 0 \"matt\"\n", "\n    light 0 \"key\": visible, adds (0.25 0.25 0.25)\n",
        "\n    light 1: blocked by object 0 \"ball\" primitive 0 at t 2\n",
        "\n    light 2 \"headlight\": adds nothing from where it is\n", "\n    mirror ray from",
        "\n      misses: ", "\n    refracted ray from"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

}  // namespace
}  // namespace promin
