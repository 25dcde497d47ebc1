// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "device_scene/pack_scene.h"
#include "support/temp_folder.h"
#include "view/display/screenshot.h"
#include "view/flight.h"
#include "view/keys.h"
#include "view/panel/describe_command.h"
#include "view/panel/screen_area.h"
#include "view/scene/file_dialog.h"
#include "view/scene/scene_preparer.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;

TEST(DescribeCommand, NamesTheViewForAShell) {
  View view;
  view.size = uvec2(640, 360);
  view.samples_per_pixel = 4;
  view.camera.eye = vec3(0.1F, -2.0F, 1e-7F);
  view.camera.yfov = 0.7F;
  const std::string command = describe_command({.file = "it's a scene.gltf"}, view);
  EXPECT_THAT(command, testing::StartsWith("promin render 'it'\\''s a scene.gltf' -o view.exr --size 640 360 --spp 4"));
  EXPECT_THAT(command, testing::HasSubstr("--eye 0.1 -2 1e-07 --direction 0 0 -1 --up 0 1 0 --fov "));
}

TEST(DescribeCommand, LeavesOutWhatTheWindowDoes) {
  View view;
  view.mode.debug_view = DebugView::kSteps;
  view.camera.projection = Projection::kOrthographic;
  const std::string command =
      describe_command({.file = "s", .has_shadows = false, .lights_off = {0, 2}, .camera_index = 1}, view);
  EXPECT_THAT(command, testing::HasSubstr(" --shading steps --no-shadows --lights-off 0,2 --camera 1 --eye "));
  EXPECT_THAT(command, testing::Not(testing::HasSubstr("--fov")));
}

TEST(DescribeCommand, NamesWhatChangesBits) {
  View view;
  view.seed = 3;
  view.occlusion_distance = 2.5F;
  view.camera.aperture_radius = 0.25F;
  view.camera.focus_distance = 4.0F;
  LookOptions look;
  look.has_ground = false;
  const std::string command = describe_command({.file = "s", .look = look, .instances = Instancing::kAll}, view);
  for (const char* words : {" --seed 3 --occlusion-distance 2.5 ", " --ground off ",
                            " --aperture-radius 0.25 --focus-distance 4 --instances all"}) {
    EXPECT_THAT(command, testing::HasSubstr(words));
  }
}

TEST(DescribeCommand, NamesHowTheSceneIsLitAndShown) {
  const View view;
  EXPECT_THAT(describe_command({.file = "s"}, view), testing::HasSubstr(" --max-depth 5 --eye "));
  LookOptions look{.light = LightChoice::kHeadlight,
                   .background = BackgroundChoice{.color = vec3(0.1F, 0.0F, 1.0F)},
                   .exposure_ev = -1.1F,
                   .tone_mapping = ToneMapping::kAces};
  EXPECT_THAT(describe_command({.file = "s", .look = look}, view),
              testing::HasSubstr(" --light headlight --background 0.1 0 1 --exposure -1.1 --tone-mapping "
                                 "aces --eye "));
  look = {.background = BackgroundChoice{.is_environment = true}, .texture_memory_mib = 64};
  EXPECT_THAT(describe_command({.file = "s", .look = look}, view),
              testing::HasSubstr(" --background environment --texture-memory 64 --eye"));
}

TEST(DescribeCommand, NamesTheIntegratorIfItIsNotTheUsualOne) {
  View view;
  EXPECT_THAT(describe_command({.file = "s"}, view), testing::Not(testing::HasSubstr("--integrator")));
  EXPECT_THAT(describe_command({.file = "s", .usual_integrator = Integrator::kDirect}, view),
              testing::HasSubstr(" --integrator whitted"));
  view.mode.integrator = Integrator::kDirect;
  EXPECT_THAT(describe_command({.file = "s"}, view), testing::HasSubstr(" --integrator direct"));
}

TEST(DescribeCommand, NamesTheErrorThatAPictureHas) {
  View view;
  view.error_target = ErrorTarget{.error = 0.125F / 1.41421356F, .min_samples = 4, .max_samples = 64};
  const std::string command = describe_command({.file = "s"}, view);
  EXPECT_THAT(command, testing::HasSubstr(" --target-error 0.088388346 --min-spp 4 --max-spp 64 --max-depth"));
  EXPECT_THAT(command, testing::Not(testing::HasSubstr("--spp 1")));
  EXPECT_THAT(command, testing::Not(testing::HasSubstr("--error-in")));
  view.error_target->display.emplace();
  EXPECT_THAT(describe_command({.file = "s"}, view),
              testing::HasSubstr(" --max-spp 64 --error-in display --max-depth"));
}

TEST(DescribeCommand, NamesTheSurroundingsAndTheVariant) {
  DescribedScene scene{.file = "s"};
  scene.environment.panorama = "a sky.hdr";
  scene.environment.rotation_deg = 12.5;
  scene.environment.intensity = 0.3;
  scene.environment.light_rotation_deg = -60.125;
  scene.variant = "red one";
  scene.root = "the store";
  EXPECT_THAT(describe_command(scene, View()),
              testing::HasSubstr(" --environment 'a sky.hdr' --environment-rotation 12.5 --environment-intensity 0.3 "
                                 "--light-rotation -60.125 --variant 'red one' --root 'the store' --eye"));
}

TEST(DescribeCommand, NamesThePose) {
  DescribedScene scene{.file = "s"};
  scene.motion = {.animations = {"Run fast", "2"}, .time_s = 0.1, .loops = true};
  EXPECT_THAT(describe_command(scene, View()),
              testing::HasSubstr(" --time 0.1 --animation 'Run fast' --animation '2' --loop --eye"));
}

TEST(DescribeCommand, NamesThePictureThatIsSaved) {
  EXPECT_THAT(describe_command({.file = "s", .output = "a box.png"}, View()),
              testing::StartsWith("promin render 's' -o 'a box.png' --size"));
}

TEST(TurnLight, TurnsTheSkyAndWhatShinesAlongADirection) {
  Environment environment;
  environment.rotation = 0.5F;
  Light directional;
  directional.kind = LightKind::kDirectional;
  directional.direction = vec3(0.0F, -0.6F, -0.8F);
  Light spot = directional;
  spot.kind = LightKind::kSpot;
  std::vector<Light> lights = {directional, spot};
  turn_light(0.0, environment, lights);
  EXPECT_EQ(lights[0].direction, directional.direction);
  turn_light(90.0, environment, lights);
  EXPECT_FLOAT_EQ(environment.rotation, 0.5F + glm::radians(90.0F));
  EXPECT_LT(glm::distance(lights[0].direction, vec3(-0.8F, -0.6F, 0.0F)), 1e-6F);
  EXPECT_EQ(lights[1].direction, spot.direction) << "it has a place";
}

/// A folder with programs that replace the programs of the desktop. PATH contains only this folder.
class FileDialogTest : public TempFolder {
 protected:
  void SetUp() override { setenv("PATH", folder_.c_str(), 1); }
  void TearDown() override { setenv("PATH", path_.c_str(), 1); }
  void write_program(const std::string& name, const std::string& lines) const {
    std::ofstream(folder_ / name) << "#!/bin/sh\n" << lines;
    fs::permissions(folder_ / name, fs::perms::owner_all);
  }
  /// Returns the user's choice after the dialog has closed.
  static std::optional<std::string> wait(FileDialog& dialog) {
    std::optional<std::string> file;
    while (dialog.is_open() && !file) file = dialog.take();
    return file;
  }

  const std::string path_ = std::getenv("PATH");
};

TEST_F(FileDialogTest, GivesTheFileThatIsChosen) {
  FileDialog dialog;
  EXPECT_FALSE(dialog.ask(FileUse::kOpen, "a/")) << "there is no program";
  EXPECT_FALSE(dialog.is_open());
  write_program("kdialog", "echo \"$1 of $2\"\n");
  ASSERT_TRUE(dialog.ask(FileUse::kSave, "a picture.png"));
  EXPECT_EQ(dialog.use(), FileUse::kSave);
  EXPECT_EQ(wait(dialog), "--getsavefilename of a picture.png");
  write_program("zenity", "echo chosen; exit 1\n");
  ASSERT_TRUE(dialog.ask(FileUse::kOpen, "a/"));
  EXPECT_EQ(wait(dialog), std::nullopt) << "it was cancelled";
}

TEST_F(FileDialogTest, IsClosedWithItsOwner) {
  write_program("zenity", "while :; do :; done\n");
  FileDialog dialog;
  ASSERT_TRUE(dialog.ask(FileUse::kOpen, "a/"));
  EXPECT_EQ(dialog.take(), std::nullopt);
  dialog.close();
  EXPECT_FALSE(dialog.is_open());
}

TEST(DescribeCommand, NamesTheTreeWhoseStepsItShows) {
  View view;
  EXPECT_THAT(describe_command({.file = "s", .builder = "median"}, view), testing::Not(testing::HasSubstr("median")));
  view.mode.debug_view = DebugView::kSteps;
  EXPECT_THAT(describe_command({.file = "s", .builder = "median"}, view), testing::EndsWith(" --builder median"));
  EXPECT_THAT(describe_command({.file = "s", .bvh = "a tree"}, view), testing::EndsWith(" --bvh 'a tree'"));
}

TEST(DescribeCommand, HasNoneForAnOrthographicViewOfNoCamera) {
  Scene scene;
  View view;
  EXPECT_TRUE(can_describe({.file = "s"}, view));
  view.camera.projection = Projection::kOrthographic;
  view.camera.ymag = 3.0F;
  EXPECT_FALSE(can_describe({.file = "s", .camera_index = find_half_height(scene, view.camera)}, view));
  scene.cameras = {Camera{}, view.camera};
  EXPECT_EQ(find_half_height(scene, view.camera), 1U);
  EXPECT_TRUE(can_describe({.file = "s", .camera_index = 1}, view));
}

// The angle of every float can be recovered from nine digits of degrees.
TEST(DescribeCommand, AnglesComeBackToTheBit) {
  View view;
  for (float yfov = 0.001F; yfov < 3.1F; yfov *= 1.0037F) {
    view.camera.yfov = yfov;
    const std::string command = describe_command({.file = "s"}, view);
    const double degrees = std::stod(command.substr(command.find("--fov ") + 6));
    ASSERT_EQ(static_cast<float>(glm::radians(degrees)), yfov) << command;
  }
}

class FindFreeNameTest : public TempFolder {};

TEST_F(FindFreeNameTest, TakesTheNextNumberOfBothEndings) {
  EXPECT_EQ(find_free_name(folder_), "promin-0001");
  std::ofstream(folder_ / "promin-0001.png") << "x";
  std::ofstream(folder_ / "promin-0002.exr") << "x";
  std::ofstream(folder_ / "promin-0004.exr") << "x";
  EXPECT_EQ(find_free_name(folder_), "promin-0003");
}

TEST(FlightRecorder, KeepsTheEndsOfARest) {
  FlightRecorder recorder;
  Camera camera;
  recorder.add(10.0, camera);
  for (const double time : {10.5, 11.0, 12.0}) recorder.add(time, camera);
  camera.eye.x = 1.0F;
  recorder.add(12.5, camera);
  std::vector<double> times;
  for (const TimedCamera& frame : recorder.path().frames) times.push_back(frame.time_s);
  EXPECT_EQ(times, (std::vector<double>{0.0, 2.0, 2.5}));
  EXPECT_EQ(recorder.path().frames.back().camera.eye.x, 1.0F);
}

TEST(FlightReplay, TellsMedianAndPercentile) {
  FlightReplay replay(PathPictures({{{0.0, Camera{}}, {1.0, Camera{}}}, std::nullopt}));
  for (int i = 1; i <= 101; ++i) {
    FinishedFrame frame;
    frame.time_ms = i;
    frame.stages.trace = 0.5 * i;
    frame.rays.primary = 51000;
    replay.add(frame);
  }
  EXPECT_EQ(replay.summarize(),
            "101 frames: median 51.00 ms, 99th percentile 100.00 ms, tracing 50.0 % of the time, "
            "1.00 million camera rays a second");
  EXPECT_TRUE(replay.is_due(7.0));
  replay.next_camera(7.0);
  EXPECT_TRUE(replay.is_due(7.0)) << "stored frames wait for nothing";
  EXPECT_FALSE(replay.is_done());
  replay.next_camera(7.0);
  EXPECT_TRUE(replay.is_done());
  EXPECT_FALSE(replay.is_due(8.0));
}

TEST(FlightReplay, PlaysSecondsInSeconds) {
  FlightReplay replay(PathPictures({{{0.0, Camera{}}, {10.0, Camera{}}}, 4.0}));
  ASSERT_TRUE(replay.is_due(100.0));
  replay.next_camera(100.0);
  EXPECT_FALSE(replay.is_due(100.24));
  ASSERT_TRUE(replay.is_due(100.25));
  replay.next_camera(100.3);  // late, but the next frame is in time
  EXPECT_FALSE(replay.is_due(100.49));
  ASSERT_TRUE(replay.is_due(100.5));
  replay.next_camera(107.0);  // much too late: the frames after it keep their distance
  EXPECT_FALSE(replay.is_due(107.24));
  EXPECT_TRUE(replay.is_due(107.25));
}

TEST(FindDisplay, TakesTheOneWithMostOfTheWindow) {
  const ScreenArea displays[] = {{0, 0, 1000, 800}, {1000, 0, 2000, 1000}, {0, 800, 1000, 200}};
  EXPECT_EQ(find_display(displays, {100, 100, 300, 200}), 0U);
  EXPECT_EQ(find_display(displays, {900, 100, 300, 200}), 1U);
  EXPECT_EQ(find_display(displays, {800, 100, 300, 200}), 0U);
  EXPECT_EQ(find_display(displays, {100, 750, 100, 200}), 2U);
  EXPECT_EQ(find_display(displays, {-500, -500, 100, 100}), 0U);
}

class SceneWatchTest : public TempFolder {};

TEST_F(SceneWatchTest, TellsOfWhatIsWrittenAfterItWasReadAndLeftAlone) {
  const auto write = [&](const char* name, const char* text) { std::ofstream(folder_ / name) << text; };
  write("a", "1");
  const auto read = [&] {
    return std::vector<SourceFile>{{folder_ / "a", stamp_of(folder_ / "a")}, {folder_ / "b", stamp_of(folder_ / "b")}};
  };
  SceneWatch watch(read());
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(watch.has_changed());
  write("b", "appears");
  EXPECT_FALSE(watch.has_changed()) << "it may still be written";
  write("b", "appears whole");
  EXPECT_FALSE(watch.has_changed());
  EXPECT_TRUE(watch.has_changed());
  EXPECT_FALSE(watch.has_changed()) << "once is enough";
  fs::remove(folder_ / "a");
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(watch.has_changed()) << "an editor replaces it";
  write("a", "new");
  watch.has_changed();
  EXPECT_TRUE(watch.has_changed());
  // The file is written after it has been read, but before reading ends.
  const std::vector<SourceFile> sources = read();
  write("a", "newer");
  watch.follow(sources);
  watch.has_changed();
  EXPECT_TRUE(watch.has_changed());
}

// The window cancels the construction of a tree with an exception from the progress function. No builder may continue
// after the exception.
TEST(PackChoice, EndsByWhatItsProgressThrows) {
  world::Scene scene;
  scene.materials.resize(1);
  Mesh mesh;
  for (uint32_t i = 0; i < 30000; ++i) {
    const auto x = static_cast<float>(i);
    for (const vec3& corner : {vec3(x, 0, 0), vec3(x + 1, 0, 0), vec3(x, 1, x)}) mesh.positions.push_back(corner);
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  scene.objects.push_back({"", mesh, 0});
  for (const std::string_view builder : builder_names()) {
    int calls = 0;
    const auto stop = [&](double) -> bool {
      ++calls;
      throw std::domain_error("stop");
    };
    EXPECT_THROW(pack_scene(scene, builder, {.progress = stop}), std::domain_error) << builder;
    EXPECT_LE(calls, 8) << builder << ": of each thread one at most";
  }
}

TEST(Keys, NoneHasTwoEffects) {
  for (const KeyBinding& binding : key_bindings()) {
    EXPECT_TRUE(binding.hold.has_value() != binding.press.has_value()) << binding.name;
    const auto same = [&](const KeyBinding& other) { return other.key == binding.key; };
    EXPECT_EQ(std::count_if(key_bindings().begin(), key_bindings().end(), same), 1) << binding.name;
  }
}

}  // namespace
}  // namespace promin::app
