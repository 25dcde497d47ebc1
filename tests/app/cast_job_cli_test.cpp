// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests run `promin cast --job`, which answers rays in pieces, and end the work in different ways.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <thread>

#include "job_fixture.h"

namespace promin {
namespace {

using testing::HasSubstr;

class CastJobCliTest : public JobFixture {
 protected:
  void SetUp() override {
    JobFixture::SetUp();
    write_rays("rays.npy", make_rays(1000));
  }

  /// Returns rays at the square and around it, some along its plane.
  static std::vector<Ray> make_rays(size_t count) {
    std::vector<Ray> rays(count);
    for (size_t i = 0; i < count; ++i) {
      const auto place = [&](double step) { return static_cast<float>(3.0 * std::fmod(step * (i + 1), 1.0) - 1.5); };
      rays[i].origin = {place(0.618033988749895), place(0.754877666246693), i % 7 == 0 ? 0.0F : 2.0F};
      rays[i].direction = {0.1F * place(0.569840290998053), 0.0F, i % 7 == 0 ? 0.0F : -1.0F};
    }
    return rays;
  }

  ProcessResult cast(OptionValues more) const {
    more.insert(more.begin(), {"cast", "square.gltf", "rays.npy", "--quiet"});
    return run(more);
  }
};

TEST_F(CastJobCliTest, AnyCutGivesTheFilesOfTheSingleRun) {
  for (const char* query : {"", "--any", "--count", "--all"}) {
    const bool is_all = std::string(query) == "--all";
    const auto words = [&](const std::string& name, OptionValues more) {
      if (*query != '\0') more.emplace_back(query);
      more.insert(more.end(), {"-o", name + ".npy"});
      if (is_all) more.insert(more.end(), {"--offsets", name + "_offsets.npy"});
      return more;
    };
    expect_done(cast(words("whole", {})));
    for (const OptionValues& cut : {OptionValues{}, OptionValues{"--pieces", "7"}}) {
      std::filesystem::remove_all(folder() / "job");
      OptionValues more = cut;
      more.insert(more.end(), {"--job", "job"});
      expect_done(cast(words("cut", more)));
      EXPECT_EQ(pieces().size(), cut.empty() ? 1U : 7U);
      EXPECT_TRUE(read("cut.npy") == read("whole.npy")) << query;
      if (is_all) {
        EXPECT_TRUE(read("cut_offsets.npy") == read("whole_offsets.npy"));
      }
    }
  }
  EXPECT_THAT(run({"merge", "job", "-o", "merged.npy"}).err, HasSubstr("the results of this job need two files"));
  expect_done(run({"merge", "job", "-o", "merged.npy", "--offsets", "merged_offsets.npy"}));
  EXPECT_TRUE(read("merged.npy") == read("whole.npy") && read("merged_offsets.npy") == read("whole_offsets.npy"));
}

TEST_F(CastJobCliTest, WithoutAWordManyRaysAreSixteenPieces) {
  write_rays("rays.npy", make_rays(size_t{1} << 20));
  expect_done(cast({"-o", "whole.npy"}));
  expect_done(cast({"--job", "job", "-o", "cut.npy"}));
  EXPECT_EQ(pieces().size(), 16U);
  EXPECT_TRUE(read("cut.npy") == read("whole.npy"));
}

TEST_F(CastJobCliTest, OfALargeSceneAllTakeTheTreeOfTheFirst) {
  write_sheet("sheet.ply");
  const auto cast_sheet = [&](OptionValues more) {
    more.insert(more.begin(), {"cast", "sheet.ply", "rays.npy", "--quiet"});
    return run(more);
  };
  expect_done(cast_sheet({"-o", "whole.npy"}));
  for (const char* share : {"0/2", "1/2"}) {
    expect_done(cast_sheet({"--job", "job", "--pieces", "4", "--piece", share}));
    EXPECT_THAT(trees(), testing::ElementsAre("sah.lock", "sah.pbvh"));
  }
  expect_done(run({"merge", "job", "-o", "cut.npy"}));
  EXPECT_TRUE(read("cut.npy") == read("whole.npy"));
}

TEST_F(CastJobCliTest, SharesAreMergedAndPiecesWithoutRaysAreWhole) {
  expect_done(cast({"-o", "whole.npy"}));
  expect_done(cast({"--job", "job", "--pieces", "5", "--piece", "1/2"}));
  const ProcessResult early = run({"merge", "job", "-o", "merged.npy"});
  expect_failure(early, 1, "3 of 5 pieces are missing or bad: r000000000000-000000000200, r000000000400-");
  expect_done(cast({"--job", "job", "--pieces", "5", "--piece", "0/2"}));
  expect_done(run({"merge", "job", "-o", "merged.npy", "--quiet"}));
  EXPECT_TRUE(read("merged.npy") == read("whole.npy"));
  write_rays("rays.npy", {});
  expect_done(cast({"-o", "none.npy"}));
  expect_done(cast({"--job", "empty", "-o", "cut.npy"}));
  EXPECT_TRUE(read("cut.npy") == read("none.npy"));
}

TEST_F(CastJobCliTest, WhatIsBadIsMadeAnewAndOthersAreRefused) {
  expect_done(cast({"-o", "whole.npy"}));
  const OptionValues words = {"--job", "job", "--pieces", "4", "-o", "cut.npy"};
  expect_done(cast(words));
  const auto files = damage_pieces();
  EXPECT_THAT(run({"merge", "job", "-o", "cut.npy"}).err, HasSubstr("3 of 4 pieces are missing or bad"));
  const ProcessResult result =
      run({"cast", "square.gltf", "rays.npy", "--job", "job", "--pieces", "4", "-o", "cut.npy"});
  EXPECT_THAT(result.err, HasSubstr(files[0].filename().string() + ": the piece is incomplete; promin makes it again"));
  EXPECT_THAT(result.err, HasSubstr(files[2].filename().string() + ": the piece is damaged; promin makes it again"));
  EXPECT_THAT(result.out, HasSubstr("made 3 of 4 pieces now: cut.npy"));
  EXPECT_TRUE(read("cut.npy") == read("whole.npy"));

  expect_failure(
      cast({"--job", "job", "--pieces", "4", "--any", "-o", "cut.npy"}), 2,
      "the folder belongs to another job: its --any is not given or has its default value, but now it is \"given\"");
  expect_failure(cast({"--job", "job", "--pieces", "3", "-o", "cut.npy"}), 2,
                 "it has 4 pieces, but the number is now 3");
  write_rays("rays.npy", make_rays(999));
  expect_failure(cast(words), 2, "its rays is \"1000\", but now it is \"999\"");
  std::vector<Ray> rays = make_rays(1000);
  rays[17].tmin = 0.5F;
  write_rays("rays.npy", rays);
  expect_failure(cast(words), 2, "the file \"rays.npy\" has changed since");
}

TEST_F(CastJobCliTest, WhatTheJobIsMadeOfIsNotOverwritten) {
  const std::string rays = read("rays.npy");
  expect_done(cast({"--job", "job", "--pieces", "2", "--piece", "0/1"}));
  expect_failure(run({"merge", "job", "-o", "rays.npy"}), 2, "output.input rays.npy:");
  EXPECT_TRUE(read("rays.npy") == rays);
}

TEST_F(CastJobCliTest, WrongUseIsRefused) {
  const std::pair<OptionValues, std::string> cases[] = {
      {{}, "usage.option.required --output"},
      {{"-o", "a.npy", "--pieces", "4"}, "usage.option.needs --pieces"},
      {{"--piece", "0/2"}, "usage.option.needs --piece"},
      {{"--job", "job"}, "usage.option.required --output"},
      {{"--job", "job", "--all", "-o", "a.npy"}, "usage.option.needs --all --offsets"},
      {{"-o", "a.npy", "--job", "job", "--pieces", "1001"}, "1001 pieces are more than 1000 rays"},
      {{"-o", "a.npy", "--job", "job", "--piece", "0/4"}, "usage.options.contradict --piece --output"},
      {{"-o", "a.npy", "--job", "job", "--repeat", "2"}, "usage.options.contradict --job --repeat"},
      {{"-o", "a.npy", "--job", "job", "--stats", "s.json"}, "usage.options.contradict --job --stats"}};
  for (const auto& [words, sentence] : cases) {
    expect_failure(cast(words), 2, sentence);
    EXPECT_FALSE(std::filesystem::exists(folder() / "job")) << sentence;
  }
  expect_done(run({"render", "square.gltf", "--size", "8", "8", "--job", "job", "--piece", "0/1", "--quiet"}));
  expect_failure(run({"merge", "job", "-o", "a.npy"}), 2, "output.extension \".npy\"");
}

// The piece that was being written does not exist. The earlier pieces exist.
TEST_F(CastJobCliTest, AFullDiskLeavesWholePieces) {
  write_rays("rays.npy", make_rays(20000));
  expect_done(cast({"-o", "whole.npy"}));
  fill_disk(400'000);
  // The test does not use Mesa's cache.
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  expect_failure(cast({"--job", "job", "--pieces", "1", "-o", "cut.npy"}), 1, "the output file cannot be written");
  EXPECT_TRUE(pieces().empty());
  options_.max_file_bytes.reset();
  options_.environment.clear();
  expect_done(cast({"--job", "job", "--pieces", "1", "-o", "cut.npy"}));
  EXPECT_TRUE(read("cut.npy") == read("whole.npy"));
}

TEST_F(CastJobCliTest, ASignalEndsItWithThePieceAtHandAndSaysHow) {
  write_rays("rays.npy", make_rays(200'000));
  const auto is_begun = [&] {
    return std::filesystem::is_directory(folder() / "job" / "pieces") && pieces().size() > 1;
  };
  const ProcessResult result = signal_when(
      is_begun, SIGTERM, {"cast", "square.gltf", "rays.npy", "--job", "job", "--pieces", "2000", "-o", "cut.npy"});
  EXPECT_EQ(result.signal, SIGTERM);
  EXPECT_THAT(result.err, HasSubstr("of 2000; the same command continues the job"));
  EXPECT_LT(pieces().size(), 2000U);
  EXPECT_FALSE(std::filesystem::exists(folder() / "cut.npy"));
}

TEST_F(CastJobCliTest, WhateverEndsItTheSameCommandGoesOn) {
  write_rays("rays.npy", make_rays(100'000));
  expect_done(cast({"-o", "whole.npy"}));
  expect_goes_on({"cast", "square.gltf", "rays.npy", "--quiet", "--job", "job", "--pieces", "40", "-o", "cut.npy"},
                 "cut.npy", "whole.npy", 40);
}

}  // namespace
}  // namespace promin
