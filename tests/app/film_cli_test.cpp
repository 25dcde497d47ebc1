// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests render films: frames of a scene's animation.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cli_fixture.h"
#include "promin/device.h"
#include "promin/framing.h"
#include "promin/motion.h"
#include "scene/framing.h"
#include "support/moving_gltf.h"
#include "work/pictures/frame_plan.h"
#include "work/pictures/frame_renderers.h"
#include "work/pictures/tracing_run.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

/// Returns a scene whose triangle turns, grows through 0 and changes its material, in one second. A light appears.
GltfBuilder make_film() {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["materials"] = {{{"doubleSided", true}, {"pbrMetallicRoughness", {{"roughnessFactor", 1}}}}};
  gltf.json["meshes"][0]["primitives"][0]["material"] = 0;
  gltf.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}, {"intensity", 20}}};
  gltf.add_node({{"translation", {0, 0, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf.add_node(
      {{"translation", {0, 2, 3}},
       {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}, {"KHR_node_visibility", {{"visible", false}}}}}});
  using test::animate;
  animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 2, 0, 0}, "VEC3");
  animate(gltf, 0, "/nodes/0/scale", {0, 1}, {1, 1, 1, -1, -1, -1}, "VEC3");
  animate(gltf, 0, "/materials/0/pbrMetallicRoughness/roughnessFactor", {0, 1}, {1, 0}, "SCALAR");
  animate(gltf, 0, "/nodes/2/extensions/KHR_node_visibility/visible", {0, 0.5F}, gltf.add<uint8_t>({0, 1}, "SCALAR"),
          "STEP");
  return gltf;
}

class FilmCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("film.gltf", make_film().text());
  }

  void expect_film(OptionValues more) const {
    more.insert(more.begin(), {"render", "film.gltf", "--fps", "4", "--size", "24x16", "-s", "2"});
    const ProcessResult result = run(more);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(FilmCliTest, FramesHaveTheSameBytesInAnyOrder) {
  expect_film({"-o", "a.#.exr", "-o", "a.#.png"});
  EXPECT_THAT(files(), UnorderedElementsAre("film.gltf", "a.0.exr", "a.1.exr", "a.2.exr", "a.3.exr", "a.4.exr",
                                            "a.0.png", "a.1.png", "a.2.png", "a.3.png", "a.4.png"));
  for (const char* frame : {"4", "3", "2", "1", "0"}) {
    expect_film({"-o", "b.#.exr", "-o", "b.#.png", "--frames", frame});
    for (const std::string ending : {".exr", ".png"}) {
      EXPECT_EQ(read("b." + std::string(frame) + ending), read("a." + std::string(frame) + ending)) << frame << ending;
    }
  }
  EXPECT_NE(read("a.0.png"), read("a.1.png"));
  EXPECT_NE(read("a.1.png"), read("a.3.png"));
}

TEST_F(FilmCliTest, JobsGiveTheSameBytes) {
  expect_film({"-o", "a.#.exr", "--frames", "0-2"});
  expect_film({"--job", "job", "--pieces", "2", "--frames", "0-2", "--piece", "1/2"});
  expect_film({"--job", "job", "--pieces", "2", "--frames", "0-2", "--piece", "0/2"});
  const ProcessResult merged = run({"merge", "job", "-o", "b.#.exr"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  for (const char* frame : {"0", "1", "2"}) {
    EXPECT_EQ(read_image(folder() / (std::string("b.") + frame + ".exr")).pixels,
              read_image(folder() / (std::string("a.") + frame + ".exr")).pixels)
        << frame;
  }
}

TEST_F(FilmCliTest, AFrameIsThePoseOfItsTime) {
  // Framing and light belong to the whole film, so the camera is given, and the scene has its own light.
  const OptionValues camera = {"--eye", "1", "0", "6", "--look-at", "1", "0", "0", "--exposure", "0"};
  OptionValues film = {"-o", "a.#.exr", "--frames", "3"};
  film.insert(film.end(), camera.begin(), camera.end());
  expect_film(film);
  OptionValues still = {"render", "film.gltf", "--time", "0.75", "--size", "24x16", "-s", "2", "-o", "b.exr"};
  still.insert(still.end(), camera.begin(), camera.end());
  const ProcessResult result = run(still);
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read_image(folder() / "a.3.exr").pixels, read_image(folder() / "b.exr").pixels);
}

TEST_F(FilmCliTest, ACameraPathAndTheSceneShareTheTime) {
  write("path.json", R"({"format": "promin camera path", "version": 1, "fps": 4, "frames": [
    {"time_s": 0, "eye": [1, 0, 6], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45},
    {"time_s": 1, "eye": [1, 0, 6], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45}]})");
  const auto render_path = [&](OptionValues more) {
    more.insert(more.begin(), {"render", "film.gltf", "--path", "path.json", "--size", "24x16", "--frames", "0-3"});
    const ProcessResult result = run(more);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  };
  render_path({"-o", "rest.#.png"});
  EXPECT_EQ(read("rest.0.png"), read("rest.3.png")) << "without --animation the scene rests";
  render_path({"-o", "move.#.png", "--animation", "0"});
  EXPECT_NE(read("move.0.png"), read("move.3.png"));
}

TEST_F(FilmCliTest, ATurntableMovesTheCameraAroundTheScene) {
  const auto turn = [&](OptionValues more) {
    more.insert(more.begin(), {"render", "film.gltf", "--turntable", "4", "--size", "24x16", "-s", "1"});
    const ProcessResult result = run(more);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  };
  turn({"-o", "a.#.exr"});
  EXPECT_THAT(files(), UnorderedElementsAre("film.gltf", "a.0.exr", "a.1.exr", "a.2.exr", "a.3.exr"));
  turn({"-o", "b.#.exr", "--frames", "2"});
  EXPECT_EQ(read("b.2.exr"), read("a.2.exr"));
  EXPECT_NE(read("a.0.exr"), read("a.2.exr"));
  turn({"--job", "job", "--frames", "2-3", "-o", "c.#.exr"});
  EXPECT_EQ(read_image(folder() / "c.3.exr").pixels, read_image(folder() / "a.3.exr").pixels);
  // An animation that the user names moves meanwhile.
  turn({"-o", "d.#.exr", "--animation", "0", "--fps", "4"});
  turn({"-o", "e.#.exr", "--animation", "0", "--time", "0.5"});
  EXPECT_NE(read("d.1.exr"), read("e.1.exr"));
  turn({"-o", "f.#.exr", "--animation", "0", "--fps", "4", "--frames", "3"});
  EXPECT_EQ(read("f.3.exr"), read("d.3.exr"));
}

TEST_F(FilmCliTest, ATurntableKeepsTheDistance) {
  work::RenderSpec spec;
  spec.tracing.scene = folder() / "film.gltf";
  spec.turntable = 8;
  // The first frame shows the edge of the flat scene.
  spec.view.pose.orbit.azimuth_deg = 90.0;
  spec.pictures = {"f.#.png"};
  const work::Messages messages;
  const work::PictureRun run = work::prepare_pictures(spec, work::plan_frames(spec), messages);
  ASSERT_EQ(run.frames.size(), 8U);
  const dvec3 middle = middle_of(frame_of(run.scene));
  const Camera& first = *run.frames[0].camera;
  for (const work::PlannedFrame& frame : run.frames) {
    const double degrees = 45.0 * *frame.number;
    const Camera expected = orbit_camera(first, middle, {.azimuth_deg = degrees});
    EXPECT_EQ(frame.camera->eye, expected.eye);
    EXPECT_EQ(frame.camera->look, expected.look);
    EXPECT_LT(covered_share(run.scene, *frame.camera, 16.0F / 9.0F), 1.0);
    EXPECT_NEAR(glm::distance(dvec3(frame.camera->eye), middle), glm::distance(dvec3(first.eye), middle), 1e-5);
  }
}

TEST_F(FilmCliTest, TheCameraOfTheFileMoves) {
  GltfBuilder gltf = make_film();
  gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}}}}};
  const size_t node = gltf.add_node({{"camera", 0}, {"translation", {0, 0, 6}}});
  gltf.json.erase("animations");
  test::animate(gltf, 0, "/nodes/" + std::to_string(node) + "/translation", {0, 1}, {0, 0, 6, 1, 0, 9}, "VEC3");
  write("film.gltf", gltf.text());
  expect_film({"-o", "a.#.png", "--frames", "0-4"});
  EXPECT_NE(read("a.0.png"), read("a.4.png"));
  expect_film({"-o", "b.#.png", "--frames", "4"});
  EXPECT_EQ(read("a.4.png"), read("b.4.png"));
}

TEST_F(FilmCliTest, FramesThatExistAreSkipped) {
  expect_film({"-o", "a.#.png", "--frames", "1-2"});
  const ProcessResult result =
      run({"render", "film.gltf", "--fps", "4", "--size", "24x16", "-s", "2", "-o", "a.#.png", "--skip-existing"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.err, HasSubstr("skipped 2 of 5 frames"));
}

TEST_F(FilmCliTest, NoKernelIsCompiledAfterTheFirstFrame) {
  work::RenderSpec spec;
  spec.tracing.scene = folder() / "film.gltf";
  spec.fps = 8.0;
  spec.view.size = uvec2(16, 12);
  spec.pictures = {"f.#.png"};
  const work::Messages messages;
  work::PictureRun run = work::prepare_pictures(spec, work::plan_frames(spec), messages);
  ASSERT_EQ(run.frames.size(), 9U);
  const gpu::DeviceHandle device = gpu::open_device(std::nullopt);
  work::FrameRenderers renderers(*device, run, work::make_renderer_options(run.options, 100));
  uint64_t compiled_first = 0;
  for (const work::PlannedFrame& frame : run.frames) {
    Renderer& renderer = renderers.at(frame);
    View view = *run.stats.view;
    renderers.describe(frame, view, run.stats);
    renderer.render(view);
    if (*frame.number == 0) compiled_first = renderer.work_done().pipelines_compiled;
    EXPECT_EQ(renderer.work_done().pipelines_compiled, compiled_first) << "frame " << *frame.number;
  }
}

}  // namespace
}  // namespace promin
