// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests check the options `--spec` and `--print-spec`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "job_fixture.h"
#include "jobs/job.h"

namespace promin {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

class SpecCliTest : public JobFixture {
 protected:
  std::string print(OptionValues words) const {
    words.emplace_back("--print-spec");
    const ProcessResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_THAT(result.err, IsEmpty());
    return result.out;
  }
};

const OptionValues kPicture = {"render", "square.gltf", "--size", "31x17", "--spp", "2",     "--eye", "1",  "0.5",
                               "3",      "--look-at",   "0",      "0",     "0.1",   "--aov", "depth", "-o", "a.exr"};

TEST_F(SpecCliTest, PrintedAndReadItIsTheSame) {
  const std::string spec = print(kPicture);
  write("spec.json", spec);
  EXPECT_EQ(print({"render", "--spec", "spec.json"}), spec);
  write("rays.npy", "");
  const std::string cast = print({"cast", "square.gltf", "rays.npy", "--count", "-o", "counts.npy"});
  write("cast.json", cast);
  EXPECT_EQ(print({"cast", "--spec", "cast.json"}), cast);
  // Printing a specification reads and writes no other file.
  EXPECT_EQ(print({"render", "none.gltf"}), print({"render", "none.gltf"}));
}

TEST_F(SpecCliTest, OptionsOverrideIt) {
  write("spec.json", R"({"promin_render_spec": 1, "scene": "square.gltf", "quality": "high", "aov": ["depth"],
                         "alpha": true, "bvh": "a.pbvh"})");
  EXPECT_EQ(print({"render", "--spec", "spec.json", "--spp", "2", "--aov", "normal", "--builder", "median"}),
            print({"render", "square.gltf", "--spp", "2", "--aov", "normal", "--alpha", "--builder", "median"}));
  EXPECT_EQ(print({"render", "triangle.obj", "--spec", "spec.json"}),
            print({"render", "triangle.obj", "--quality", "high", "--aov", "depth", "--alpha", "--bvh", "a.pbvh"}));
}

TEST_F(SpecCliTest, WrongOnesAreRefused) {
  write("spec.json", R"({"promin_render_spec": 1, "spp": 0})");
  expect_failure(run({"render", "square.gltf", "--spec", "spec.json"}), 3,
                 "promin: spec.json: spp takes a whole number from 1 to 65535, not 0; correct it or remove it");
  expect_failure(run({"render", "--spec", "none.json"}), 3, "promin: none.json: the file does not exist");
  write("spec.json", R"({"promin_render_spec": 1})");
  expect_failure(run({"render", "--spec", "spec.json"}), 2, "SCENE is required");
  expect_failure(run({"cast", "--spec", "spec.json"}), 3, "the file has no member \"promin_cast_spec\"");
  write("spec.json", R"({"promin_render_spec": 1, "scene": "square.gltf", "spp": 2, "quality": "high"})");
  expect_failure(run({"render", "--spec", "spec.json"}), 2, "--quality and --spp contradict each other");
}

class SpecPictureCliTest : public SpecCliTest {};

TEST_F(SpecPictureCliTest, PicturesAndHitsAreThoseOfTheOptions) {
  expect_done(run(kPicture));
  const std::string picture = read("a.exr");
  const std::string spec = print(kPicture);
  std::filesystem::remove(folder() / "a.exr");
  std::filesystem::create_directory(folder() / "specs");
  write("specs/spec.json", spec);
  expect_done(run({"render", "--spec", "specs/spec.json", "--quiet"}));
  EXPECT_TRUE(read("a.exr") == picture);
  // A job accepts the same specification and stores it without the outputs.
  expect_done(run({"render", "--spec", "specs/spec.json", "-o", "b.exr", "--job", "job", "--pieces", "2", "--quiet"}));
  EXPECT_TRUE(read("b.exr") == picture);
  EXPECT_THAT(read("job/spec.json"), testing::AllOf(HasSubstr("\"pieces\": 2"), testing::Not(HasSubstr("output"))));
  expect_done(run({"render", "--spec", "job/spec.json", "-o", "c.exr", "--job", "job", "--quiet"}));
  EXPECT_TRUE(read("c.exr") == picture);
}

/// Changes the record of the process that made a piece.
void claim(const jobs::Job& job, size_t piece, const std::string& build, std::byte change) {
  jobs::Content content = job.read(piece);
  jobs::Maker maker = *job.maker_of(piece);
  maker.build = build;
  content.bytes.front() ^= change;
  job.write(piece, content, 1.0, maker);
}

TEST_F(SpecPictureCliTest, AnotherBuildGoesOnIfItGivesTheSameBits) {
  const OptionValues command = {"render", "square.gltf", "--size",   "31x17", "--spp", "2",    "-v",
                                "--job",  "job",         "--pieces", "3",     "-o",    "a.exr"};
  expect_done(run(command));
  const std::string picture = read("a.exr");
  const jobs::Job job = jobs::Job::open(folder() / "job");
  EXPECT_EQ(job.maker_of(0)->build.size(), 40U);
  const auto take_from_other = [&](std::byte change) {
    std::filesystem::remove(job.file_of(1));
    claim(job, 0, "another", change);
    claim(job, 2, "another", std::byte{0});
  };
  take_from_other(std::byte{0});
  const ProcessResult same = run(command);
  expect_done(same);
  EXPECT_THAT(same.err, HasSubstr("of another build again, with the same bits"));
  EXPECT_TRUE(read("a.exr") == picture);
  take_from_other(std::byte{1});
  const ProcessResult other = run(command);
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_THAT(
      other.err,
      HasSubstr(
          "the job's pieces were made by another build of promin, and this build computes different bits for piece "));
  EXPECT_FALSE(std::filesystem::exists(job.file_of(1)));
  // Pieces of another device are refused before a piece is made.
  job.write(0, job.read(0), 1.0, {"another device", "", "another"});
  const ProcessResult device = run(command);
  EXPECT_EQ(device.exit_code, 2);
  EXPECT_THAT(device.err, HasSubstr("the job's pieces were made on another device, but the chosen device is "));
}

}  // namespace
}  // namespace promin
