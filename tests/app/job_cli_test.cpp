// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests run `promin render --job` and `promin merge`, which make pictures in pieces, and end the work in
// different ways.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <memory>
#include <thread>

#include "job_fixture.h"
#include "support/moving_gltf.h"

namespace promin {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr const char* kPath = R"({"format": "promin camera path", "version": 1, "frames": [
  {"time_s": 0.0, "eye": [0, 0, 4], "look": [0, 0, -1], "up": [0, 1, 0], "fov_deg": 45},
  {"time_s": 0.1, "eye": [1, 0.5, 3], "look": [-0.28, 0, -0.96], "up": [0, 1, 0], "fov_deg": 60}]})";

class JobCliTest : public JobFixture {
 protected:
  ProcessResult render(OptionValues more) const {
    more.insert(more.begin(), {"render", "square.gltf", "--size", "61", "47", "--quiet"});
    return run(more);
  }
};

TEST_F(JobCliTest, AnyCutGivesTheFilesOfTheSingleRun) {
  for (const OptionValues& how : {OptionValues{"--spp", "4", "--aov", "depth,normal,object,albedo"},
                                  OptionValues{"--target-error", "0.03", "--aov", "samples,error"},
                                  OptionValues{"--target-error", "0.03", "--error-in", "display"},
                                  OptionValues{"--crop", "5", "3", "40", "41", "--dither"}}) {
    const auto with = [&](OptionValues words) {
      words.insert(words.end(), how.begin(), how.end());
      return words;
    };
    expect_done(render(with({"-o", "whole.exr", "-o", "whole.png"})));
    for (const OptionValues& cut : {OptionValues{"--pieces", "1"}, OptionValues{"--pieces", "7"},
                                    OptionValues{"--tiles", "8", "8"}, OptionValues{}}) {
      std::filesystem::remove_all(folder() / "job");
      OptionValues words = with({"--job", "job", "-o", "cut.exr", "-o", "cut.png"});
      words.insert(words.end(), cut.begin(), cut.end());
      expect_done(render(words));
      EXPECT_EQ(read("cut.exr") == read("whole.exr"), true);
      EXPECT_EQ(read("cut.png") == read("whole.png"), true);
    }
  }
}

// The pieces record which surfaces are unlit, so that these are shown unchanged, regardless of the files with which the
// job begins.
TEST_F(JobCliTest, PiecesTellOfUnlitSurfaces) {
  write("square.gltf", make_mixed_gltf());
  expect_done(render({"--spp", "4", "-o", "whole.exr", "-o", "whole.png"}));
  expect_done(render({"--spp", "4", "--job", "job", "--pieces", "3", "-o", "cut.exr"}));
  expect_done(run({"merge", "job", "-o", "again.exr", "-o", "again.png"}));
  EXPECT_EQ(read("cut.exr") == read("whole.exr"), true);
  EXPECT_EQ(read("again.exr") == read("whole.exr"), true);
  EXPECT_EQ(read("again.png") == read("whole.png"), true);
}

// A floor under a lamp that is bright enough is rendered with the integrator direct, also in jobs and for --explain.
TEST_F(JobCliTest, FilesThatGlowLightThemselves) {
  write("glow.mtl", "newmtl floor\nKd 0.8 0.8 0.8\nnewmtl lamp\nKd 0 0 0\nKe 12 9 6\n");
  write("glow.obj",
        "mtllib glow.mtl\nv -2 0 -2\nv 2 0 -2\nv 2 0 2\nv -2 0 2\nv -.5 1 -.5\nv .5 1 -.5\nv .5 1 .5\nv -.5 1 .5\n"
        "usemtl floor\nf 4 3 2 1\nusemtl lamp\nf 5 6 7 8\n");
  const auto render_glow = [&](OptionValues more) {
    more.insert(more.begin(), {"render", "glow.obj", "--size", "24", "18"});
    const ProcessResult result = run(more);
    expect_done(result);
    return result;
  };
  const std::string note = "light from emissive surfaces (--integrator direct)";
  EXPECT_THAT(render_glow({"-o", "whole.exr"}).err, HasSubstr(note));
  EXPECT_THAT(render_glow({"-o", "direct.exr", "--integrator", "direct"}).err, Not(HasSubstr(note)));
  EXPECT_EQ(read("direct.exr") == read("whole.exr"), true);
  render_glow({"-o", "cut.exr", "--job", "job", "--pieces", "3"});
  EXPECT_EQ(read("cut.exr") == read("whole.exr"), true);
  // Its lamp is so bright that the file gets no sun.
  render_glow({"-o", "fill.exr", "--light", "fill"});
  EXPECT_EQ(read("fill.exr") == read("whole.exr"), true);
  render_glow({"-o", "studio.exr", "--light", "studio"});
  EXPECT_EQ(read("studio.exr") == read("whole.exr"), false);
  const auto expect_entry = [&](const std::string& file, const std::string& name, const std::string& value) {
    // The header of an EXR has the length of a text before the text.
    const std::string entry =
        name + '\0' + "string" + '\0' + static_cast<char>(value.size()) + std::string(3, '\0') + value;
    EXPECT_THAT(read(file), HasSubstr(entry)) << name;
  };
  expect_entry("whole.exr", "promin:spp", "32");
  render_glow({"-o", "draft.exr", "--quality", "draft"});
  expect_entry("draft.exr", "promin:spp", "4");
  render_glow({"-o", "path.exr", "--integrator", "path", "--target-error", "1/8", "--min-spp", "4"});
  expect_entry("path.exr", "promin:min_spp", "16");
  render_glow({"-o", "error.exr", "--target-error", "1/8", "--min-spp", "4"});
  expect_entry("error.exr", "promin:min_spp", "4");
  // With more than 16 lamps, each sample chooses one of them.
  std::string lamps = read("glow.obj");
  for (int i = 0; i < 17; ++i) lamps += fmt::format("o lamp{}\nusemtl lamp\nf 5 6 7 8\n", i);
  write("lamps.obj", lamps);
  expect_done(run({"render", "lamps.obj", "--size", "24", "18", "-o", "lamps.exr", "--target-error", "1/8"}));
  expect_entry("lamps.exr", "promin:min_spp", "16");
  expect_done(run({"render", "lamps.obj", "--size", "24", "18", "-o", "cut_lamps.exr", "--target-error", "1/8", "--job",
                   "lamps", "--pieces", "3"}));
  expect_entry("cut_lamps.exr", "promin:min_spp", "16");
  render_glow({"-o", "old.exr", "--integrator", "whitted"});
  expect_entry("old.exr", "promin:spp", "8");
  render_glow({"-o", "sun.exr", "--integrator", "whitted", "--light", "studio"});
  EXPECT_EQ(read("sun.exr") == read("old.exr"), true);
  EXPECT_EQ(read("old.exr") == read("whole.exr"), false);
  EXPECT_THAT(read("old.exr"), HasSubstr("promin:integrator")) << "it is not the usual one";
  EXPECT_THAT(run({"render", "glow.obj", "--size", "24", "18", "--explain", "12", "9"}).out,
              HasSubstr("emissive surface"));
  EXPECT_THAT(run({"info", "glow.obj", "--json"}).out, HasSubstr(note));
}

// The integrator of a film is that of its brightest pose. A lamp that moves is no brighter than one that rests.
TEST_F(JobCliTest, FilmsHaveOneIntegrator) {
  const auto write_lamp = [&](const std::string& file, float half, const std::string& target,
                              const std::vector<float>& times, const std::vector<float>& values,
                              const std::string& type) {
    GltfBuilder gltf;
    const auto add_square = [&](float side, float height, size_t material) {
      const size_t corners =
          gltf.add<float>({-side, height, -side, side, height, -side, side, height, side, -side, height, side}, "VEC3");
      const size_t triangles = gltf.add<uint16_t>({2, 1, 0, 3, 2, 0}, "SCALAR");
      gltf.json["meshes"].push_back(
          {{"primitives",
            {{{"attributes", {{"POSITION", corners}}}, {"indices", triangles}, {"material", material}}}}});
      gltf.add_node({{"mesh", gltf.json["meshes"].size() - 1}});
    };
    gltf.json["extensionsUsed"] = {"KHR_materials_emissive_strength", "KHR_animation_pointer"};
    gltf.json["materials"] = {{{"name", "floor"}},
                              {{"emissiveFactor", {1, 1, 1}},
                               {"doubleSided", true},
                               {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1.5}}}}}}};
    add_square(2.0F, 0.0F, 0);
    add_square(half, 1.0F, 1);
    test::animate(gltf, 0, target, times, values, type);
    write(file, gltf.text());
  };
  const auto make_film = [&](const std::string& file, OptionValues more) {
    more.insert(more.begin(), {"render", file, "--frames", "0-1", "--fps", "1", "--size", "24", "18"});
    const ProcessResult result = run(more);
    expect_done(result);
    return result.err;
  };
  const std::string note = "light from emissive surfaces (--integrator direct)";
  write_lamp("fade.gltf", 0.5F, "/materials/1/extensions/KHR_materials_emissive_strength/emissiveStrength", {0, 1},
             {0, 9}, "SCALAR");
  // The lamp lights the last frame strongly, so no frame gets the studio's sun.
  const std::string fill = "weak studio light";
  EXPECT_THAT(make_film("fade.gltf", {"-o", "fade_#.exr"}), AllOf(HasSubstr(note), HasSubstr(fill)));
  for (const char* frame : {"fade_0.exr", "fade_1.exr"}) {
    EXPECT_THAT(read(frame), HasSubstr("promin:integrator")) << frame;
  }
  make_film("fade.gltf", {"-o", "cut_#.exr", "--job", "job", "--pieces", "3"});
  EXPECT_THAT(read("job/job.json"), HasSubstr("\"integrator\": \"direct\""));
  EXPECT_EQ(read("cut_0.exr") == read("fade_0.exr"), true);

  std::vector<float> times;
  std::vector<float> places;
  for (int i = 0; i < 20; ++i) {
    times.push_back(0.05F * static_cast<float>(i));
    for (const float coordinate : {0.05F * static_cast<float>(i), 0.0F, 0.0F}) places.push_back(coordinate);
  }
  write_lamp("dim.gltf", 0.05F, "/nodes/1/translation", times, places, "VEC3");
  EXPECT_THAT(make_film("dim.gltf", {"-o", "dim_#.exr"}), Not(HasSubstr(note)));
  // This lamp is not strong, although its places together are.
  write_lamp("slide.gltf", 0.3F, "/nodes/1/translation", times, places, "VEC3");
  EXPECT_THAT(make_film("slide.gltf", {"-o", "slide_#.exr"}), AllOf(HasSubstr(note), Not(HasSubstr(fill))));
}

TEST_F(JobCliTest, SharesAreMergedWhereverTheyWereMade) {
  expect_done(render({"-o", "whole.exr"}));
  expect_done(render({"--job", "job", "--pieces", "5", "--piece", "1/2"}));
  EXPECT_EQ(pieces().size(), 2U);
  ProcessResult result = run({"merge", "job", "-o", "merged.exr"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr("3 of 5 pieces are missing or bad: y00000-00009_x00000-00061, y00018-00028_"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "merged.exr"));
  expect_done(render({"--job", "job", "--pieces", "5", "--piece", "0/2"}));
  expect_done(run({"merge", "job", "-o", "merged.exr", "-o", "merged.png"}));
  EXPECT_TRUE(read("merged.exr") == read("whole.exr"));
}

// A kill loses one piece.
TEST_F(JobCliTest, WithoutAWordThereAreSixteenPiecesOrWhatTheRowsAreWorth) {
  const auto count_pieces = [&](const OptionValues& how) {
    std::filesystem::remove_all(folder() / "job");
    OptionValues words = {"render", "square.gltf", "--spp", "1", "--job", "job", "--piece", "0/1", "--quiet"};
    words.insert(words.end(), how.begin(), how.end());
    expect_done(run(words));
    return pieces().size();
  };
  EXPECT_EQ(count_pieces({"--size", "64x128"}), 16U);
  EXPECT_EQ(count_pieces({"--size", "40x64"}), 8U);
  EXPECT_EQ(count_pieces({"--size", "40x64", "--crop", "0", "8", "40", "40"}), 4U);
  EXPECT_EQ(count_pieces({"--size", "40x7"}), 1U);
  write("path.json", kPath);
  EXPECT_EQ(count_pieces({"--size", "64x128", "--path", "path.json"}), 16U);
}

TEST_F(JobCliTest, FramesOfAPathAreAJob) {
  write("path.json", kPath);
  expect_done(render({"--path", "path.json", "-o", "whole.##.exr"}));
  expect_done(render({"--path", "path.json", "--job", "job", "--tiles", "2", "1", "-o", "cut.##.exr"}));
  EXPECT_EQ(pieces().size(), 4U);
  const ProcessResult one_file = run({"merge", "job", "-o", "one.exr"});
  EXPECT_EQ(one_file.exit_code, 2);
  EXPECT_THAT(one_file.err, HasSubstr("promin: one.exr: several frames would be written to one file"));
  EXPECT_FALSE(std::filesystem::exists(folder() / "one.exr"));
  EXPECT_THAT(run({"merge", "job", "-o", "cut.##.exr", "--offsets", "o.npy"}).err,
              HasSubstr("job: --offsets needs a job of rays, but this is a job of pictures; remove --offsets"));
  for (const char* number : {"00", "01"}) {
    EXPECT_TRUE(read(std::string("cut.") + number + ".exr") == read(std::string("whole.") + number + ".exr"));
  }
}

// The pictures have default names, and a second run finds them there.
TEST_F(JobCliTest, AJobThatIsDoneMayBeAskedForAgain) {
  expect_done(render({"--job", "job"}));
  const ProcessResult again = run({"render", "square.gltf", "--size", "61", "47", "--job", "job"});
  expect_done(again);
  EXPECT_THAT(again.out, testing::StartsWith("all 5 pieces were made before: "));
  EXPECT_THAT(files(), testing::IsSupersetOf({"square.exr", "square.png"}));
  // If the command is refused, it does not report that it wrote a file.
  const ProcessResult refused = run({"render", "square.gltf", "--job", "job", "--aov", "normal"});
  expect_failure(refused, 2, "job: the folder belongs to another job: ");
  EXPECT_THAT(refused.err, testing::Not(HasSubstr("writing")));
}

TEST_F(JobCliTest, PixelsThatMissTheErrorAreToldWithoutAJobAndWithOne) {
  OptionValues command = {"render", "square.gltf", "--size", "61", "47", "--target-error", "1/1000", "--max-spp", "16"};
  command.insert(command.end(), {"-o", "a.exr"});
  const std::string missed = "error 0.001 but for ";
  const ProcessResult alone = run(command);
  const size_t at = alone.out.find(missed);
  ASSERT_NE(at, std::string::npos) << alone.out;
  const size_t end = alone.out.find(',', at);
  const std::string told = alone.out.substr(at, end - at);
  command.insert(command.end(), {"--job", "job", "--pieces", "3"});
  EXPECT_THAT(run(command).out, HasSubstr("a.exr, " + told + "\n"));
  EXPECT_THAT(run({"merge", "job", "-o", "b.exr"}).out, HasSubstr("b.exr, " + told + "\n"));
}

TEST_F(JobCliTest, SeveralMayBeginAtOnce) {
  expect_done(render({"-o", "whole.exr"}));
  std::vector<std::unique_ptr<Process>> programs;
  for (const char* share : {"0/4", "1/4", "2/4", "3/4"}) {
    programs.push_back(std::make_unique<Process>(
        PROMIN_EXECUTABLE,
        OptionValues{"render", "square.gltf", "--size", "61", "47", "--job", "job", "--pieces", "8", "--piece", share},
        options_));
  }
  for (const auto& program : programs) expect_done(program->wait());
  expect_done(run({"merge", "job", "-o", "merged.exr"}));
  EXPECT_TRUE(read("merged.exr") == read("whole.exr"));
}

TEST_F(JobCliTest, OfALargeSceneAllTakeTheTreeOfTheFirst) {
  write_sheet("sheet.ply");
  const OptionValues picture = {"render", "sheet.ply", "--size", "40", "30"};
  const auto with = [&](OptionValues words) {
    words.insert(words.begin(), picture.begin(), picture.end());
    return words;
  };
  expect_done(run(with({"-o", "whole.exr"})));
  std::vector<std::unique_ptr<Process>> programs;
  for (const char* share : {"0/3", "1/3", "2/3"}) {
    programs.push_back(std::make_unique<Process>(PROMIN_EXECUTABLE,
                                                 with({"--job", "job", "--pieces", "6", "--piece", share}), options_));
  }
  for (const auto& program : programs) expect_done(program->wait());
  const std::string tree = read("job/trees/sah.pbvh");
  EXPECT_THAT(trees(), ElementsAre("sah.lock", "sah.pbvh"));
  expect_done(run({"merge", "job", "-o", "merged.exr"}));
  EXPECT_TRUE(read("merged.exr") == read("whole.exr"));

  // Another builder makes another tree for the same job; a tree file that the user gives is used.
  const auto make_first_again = [&](OptionValues words) {
    std::filesystem::remove(pieces().front());
    words.insert(words.end(), {"--job", "job", "--pieces", "6", "-o", "cut.exr"});
    return run(with(words));
  };
  expect_done(make_first_again({"--builder", "median"}));
  EXPECT_THAT(trees(), ElementsAre("median.lock", "median.pbvh", "sah.lock", "sah.pbvh"));
  std::filesystem::copy(folder() / "job" / "trees" / "median.pbvh", folder() / "given.pbvh");
  std::filesystem::remove_all(folder() / "job" / "trees");
  expect_done(make_first_again({"--bvh", "given.pbvh"}));
  EXPECT_THAT(trees(), IsEmpty());

  std::filesystem::create_directory(folder() / "job" / "trees");
  write("job/trees/sah.pbvh", tree.substr(0, tree.size() / 2));
  const ProcessResult result = make_first_again({});
  expect_done(result);
  EXPECT_THAT(result.err, ContainsRegex("job/trees/sah.pbvh: [^\n]*; it is built again\n"));
  EXPECT_TRUE(read("job/trees/sah.pbvh") == tree);
  EXPECT_TRUE(read("cut.exr") == read("whole.exr"));
}

TEST_F(JobCliTest, WhoIsKilledAtTheTreeLeavesNothingHalf) {
  write_sheet("sheet.ply");
  const OptionValues command = {"render", "sheet.ply", "--size", "40", "30", "--job", "job", "-o", "cut.exr"};
  expect_done(run(command));
  const std::string tree = read("job/trees/sah.pbvh");
  int without = 0;
  for (int i = 0; i < 6; ++i) {
    std::filesystem::remove_all(folder() / "job");
    Process program(PROMIN_EXECUTABLE, command, options_);
    // The program is ended while the tree is built or written.
    for (int k = 0; k < 6000 && trees().empty(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    std::this_thread::sleep_for(std::chrono::milliseconds(12 * i));
    program.send(SIGKILL);
    program.wait();
    const bool is_there = std::filesystem::exists(folder() / "job" / "trees" / "sah.pbvh");
    EXPECT_TRUE(!is_there || read("job/trees/sah.pbvh") == tree);
    without += is_there ? 0 : 1;
    expect_done(run(command));
    EXPECT_TRUE(read("job/trees/sah.pbvh") == tree);
    EXPECT_THAT(trees(), ElementsAre("sah.lock", "sah.pbvh"));
  }
  EXPECT_GT(without, 0);
}

TEST_F(JobCliTest, WhatIsBadIsMadeAnew) {
  expect_done(render({"-o", "whole.exr"}));
  const OptionValues words = {"--job", "job", "--pieces", "4", "-o", "cut.exr"};
  expect_done(render(words));
  const auto files = damage_pieces();
  const ProcessResult refused = run({"merge", "job", "-o", "cut.exr"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err,
              ContainsRegex("3 of 4 pieces are missing or bad: y[0-9_x-]* [(]the (piece|file) is [a-z ]*[)], "));
  const ProcessResult result =
      run({"render", "square.gltf", "--size", "61", "47", "--job", "job", "--pieces", "4", "-o", "cut.exr"});
  expect_done(result);
  EXPECT_THAT(result.err, HasSubstr(files[0].filename().string() + ": the piece is incomplete; promin makes it again"));
  EXPECT_THAT(result.err, HasSubstr(files[2].filename().string() + ": the piece is damaged; promin makes it again"));
  EXPECT_THAT(result.err, HasSubstr("promin: note: the job continues: 1 of 4 pieces are complete"));
  EXPECT_THAT(result.out, HasSubstr("made 3 of 4 pieces now"));
  EXPECT_TRUE(read("cut.exr") == read("whole.exr"));
}

TEST_F(JobCliTest, WhatIsAssumedAnywayMayBeSaid) {
  ASSERT_EQ(render({"--job", "job", "-o", "cut.exr", "--pieces", "2"}).exit_code, 0);
  const ProcessResult again =
      render({"--job", "job", "-o", "again.exr", "--pieces", "2", "--spp", "8", "--filter", "box"});
  EXPECT_EQ(again.exit_code, 0) << again.err;
  EXPECT_TRUE(read("cut.exr") == read("again.exr"));
}

TEST_F(JobCliTest, AnotherJobIsRefused) {
  expect_done(render({"--job", "job", "-o", "cut.exr"}));
  const ProcessResult other_samples = render({"--job", "job", "-o", "cut.exr", "--spp", "2"});
  EXPECT_EQ(other_samples.exit_code, 2);
  EXPECT_THAT(
      other_samples.err,
      HasSubstr(
          "the folder belongs to another job: its --spp is not given or has its default value, but now it is \"2\""));
  expect_done(render({"--job", "fine", "-o", "cut.exr", "--spp", "2"}));
  expect_failure(render({"--job", "fine", "-o", "cut.exr", "--spp", "8"}), 2,
                 "its --spp is \"2\", but now it is not given or has its default value");
  expect_failure(render({"--job", "fine", "-o", "cut.exr", "--spp", "2", "--time", "0.5"}), 2,
                 "its --time is not given or has its default value, but now it is \"0.5\"");
  const OptionValues refined = {"--job", "refined", "-o", "cut.exr", "--target-error", "0.25", "--error-in"};
  const auto in = [&](const char* space) {
    OptionValues words = refined;
    words.emplace_back(space);
    return render(words);
  };
  expect_done(in("linear"));
  const ProcessResult other_space = in("display");
  EXPECT_EQ(other_space.exit_code, 2);
  EXPECT_THAT(other_space.err,
              HasSubstr("its --error-in is not given or has its default value, but now it is \"display\""));
  write("square.gltf", std::string(kSquareGltf) + "\n");
  const ProcessResult other_scene = render({"--job", "job", "-o", "cut.exr"});
  EXPECT_EQ(other_scene.exit_code, 2);
  EXPECT_THAT(other_scene.err, HasSubstr("the file \"square.gltf\" has changed since"));
}

TEST_F(JobCliTest, WrongUseIsRefused) {
  const std::pair<OptionValues, std::string> cases[] = {
      {{"-o", "a.exr", "--pieces", "4"}, "usage.option.needs --pieces"},
      {{"-o", "a.exr", "--job", "job", "--pieces", "4", "--tiles", "2", "2"},
       "usage.options.contradict --pieces --tiles"},
      {{"-o", "a.exr", "--job", "job", "--pieces", "48"}, "job.pieces.many 48 61x47"},
      {{"-o", "a.exr", "--job", "job", "--piece", "0/4"}, "usage.options.contradict --piece --output"},
      {{"--job", "job", "--piece", "4/4"}, "--piece takes a whole number from 0 to 3, not \"4\" in \"4/4\""},
      {{"--job", "job", "--piece", "4"}, "--piece takes I/N, such as 0/4, not \"4\""},
      {{"-o", "a.exr", "--job", "job", "--time-limit", "1"}, "usage.options.contradict --job --time-limit"},
      {{"-o", "a.exr", "--job", "job", "--stats", "s.json"}, "usage.options.contradict --job --stats"},
      {{"-o", "a.exr", "--job", "job", "--exposure", "average"}, "usage.options.contradict --job --exposure average"}};
  for (const auto& [words, problem] : cases) {
    expect_failure(render(words), 2, problem);
    EXPECT_FALSE(std::filesystem::exists(folder() / "job")) << problem;
  }
  expect_failure(run({"merge", "nowhere", "-o", "a.exr"}), 3, "job.folder.missing nowhere:");
}

TEST_F(JobCliTest, ASignalEndsItWithThePieceAtHandAndSaysHow) {
  for (const int signal : {SIGINT, SIGTERM}) {
    std::filesystem::remove_all(folder() / "job");
    const auto is_begun = [&] {
      return std::filesystem::is_directory(folder() / "job" / "ledger") && !pieces().empty();
    };
    const ProcessResult result = signal_when(is_begun, signal,
                                             {"render", "square.gltf", "--size", "400", "300", "--spp", "256", "--job",
                                              "job", "--tiles", "10", "10", "-o", "cut.exr"});
    EXPECT_EQ(result.signal, signal);
    EXPECT_THAT(result.err, HasSubstr("of 100; the same command continues the job"));
    EXPECT_GT(pieces().size(), 0U);
    EXPECT_LT(pieces().size(), 100U);
    for (const auto& piece : pieces()) EXPECT_EQ(piece.string().find(".tmp"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder() / "cut.exr"));
  }
}

// The signal arrives during the last piece. The command reports that it stopped, although no piece remains.
TEST_F(JobCliTest, ASignalInTheLastPieceIsToldToo) {
  const auto is_begun = [&] {
    const std::filesystem::path ledgers = folder() / "job" / "ledger";
    return std::filesystem::is_directory(ledgers) && !std::filesystem::is_empty(ledgers);
  };
  const ProcessResult result = signal_when(is_begun, SIGINT,
                                           {"render", "square.gltf", "--size", "400", "300", "--spp", "256", "--job",
                                            "job", "--pieces", "1", "-o", "cut.exr"});
  EXPECT_EQ(result.signal, SIGINT);
  EXPECT_THAT(result.err, HasSubstr("stopped after the last piece; the same command continues the job"));
  EXPECT_EQ(pieces().size(), 1U);
  EXPECT_FALSE(std::filesystem::exists(folder() / "cut.exr"));
}

TEST_F(JobCliTest, WhateverEndsItTheSameCommandGoesOn) {
  const OptionValues picture = {"render", "square.gltf", "--size", "160", "120", "--spp", "16", "--quiet"};
  const auto with = [&](OptionValues words) {
    words.insert(words.begin(), picture.begin(), picture.end());
    return words;
  };
  expect_done(run(with({"-o", "whole.exr"})));
  expect_goes_on(with({"--job", "job", "--tiles", "5", "5", "-o", "cut.exr"}), "cut.exr", "whole.exr", 25);
}

}  // namespace
}  // namespace promin
