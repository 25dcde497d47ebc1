// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run promin-bvh, and promin with --bvh, as a user does.

#include <chrono>
#include <csignal>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "cli_fixture.h"
#include "core/hash.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

class BvhCliTest : public CliTest {
 protected:
  ProcessResult run_bvh(const OptionValues& arguments) const {
    return Process(PROMIN_BVH_EXECUTABLE, arguments, options_).wait();
  }

  void expect_bvh_failure(const OptionValues& arguments, int exit_code, const std::string& part) const {
    expect_failure(run_bvh(arguments), exit_code, part, "promin-bvh");
  }

  void build(const OptionValues& arguments) const {
    OptionValues words = {"build"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    words.emplace_back("--quiet");
    const ProcessResult result = run_bvh(words);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    ASSERT_THAT(result.out + result.err, IsEmpty());
  }

  /// Writes a scene of triangles in random order.
  void write_triangles(const std::string& file, size_t count) const {
    std::mt19937 random(1);
    const auto uniform = [&] { return std::to_string(static_cast<double>(random()) * 0x1p-32); };
    std::string text;
    for (size_t i = 0; i < 3 * count; ++i) text += "v " + uniform() + " " + uniform() + " " + uniform() + "\n";
    for (size_t i = 0; i < count; ++i)
      text += "f -" + std::to_string(3 * i + 1) + " -" + std::to_string(3 * i + 2) + " -" + std::to_string(3 * i + 3) +
              "\n";
    write(file, text);
  }

  /// Puts a byte into a file, and updates the file's checksum.
  void forge(const std::string& file, size_t place, char byte) const {
    std::string bytes = read(file);
    bytes.at(place) = byte;
    std::memset(bytes.data() + 16, 0, 8);
    Hash64 hash;
    hash.add(std::as_bytes(std::span(bytes)));
    const uint64_t checksum = hash.value();
    std::memcpy(bytes.data() + 16, &checksum, 8);
    std::ofstream(folder() / file, std::ios::binary) << bytes;
  }
};

TEST_F(BvhCliTest, HelpAndVersionEverywhere) {
  for (const OptionValues& command :
       {OptionValues{}, OptionValues{"build"}, OptionValues{"info"}, OptionValues{"verify"}}) {
    OptionValues with_help = command;
    with_help.emplace_back("--help");
    EXPECT_THAT(run_bvh(with_help).out, HasSubstr("Usage: promin-bvh"));
    OptionValues with_version = command;
    with_version.emplace_back("--version");
    EXPECT_THAT(run_bvh(with_version).out, MatchesRegex("promin-bvh [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  }
}

TEST_F(BvhCliTest, BuildsTellsAndVerifies) {
  for (const std::string builder : {"sah", "median"}) {
    const ProcessResult built = run_bvh({"build", "square.gltf", "-o", "a.pbvh", "--builder", builder});
    ASSERT_EQ(built.exit_code, 0) << built.err;
    EXPECT_THAT(built.out, MatchesRegex("2 references to 2 primitives by " + builder + ", SAH cost .* a.pbvh\n"));

    const ProcessResult info = run_bvh({"info", "a.pbvh"});
    EXPECT_EQ(info.exit_code, 0) << info.err;
    EXPECT_THAT(info.out, ContainsRegex("builder +" + builder + "\n"));
    EXPECT_THAT(info.out, ContainsRegex("primitives +2\n"));
    EXPECT_THAT(info.out, ContainsRegex("references +2 \\(1.000 a primitive\\)"));
    EXPECT_THAT(info.out, ContainsRegex("SAH cost +2\n"));
    EXPECT_THAT(info.out, ContainsRegex("depth +1; the traversal stack takes 1\n"));
    EXPECT_THAT(info.out, ContainsRegex("leaves +1 \\(by size: 2: 1\\)"));
    EXPECT_THAT(info.out, ContainsRegex("memory +96.0 bytes per primitive on the device: 32.0 of nodes, 64.0 "));
    EXPECT_THAT(info.out, ContainsRegex("geometry +[0-9a-f]{16}\n"));

    const ProcessResult verified = run_bvh({"verify", "square.gltf", "a.pbvh"});
    EXPECT_EQ(verified.exit_code, 0) << verified.err;
    EXPECT_EQ(verified.out, "1 nodes, 2 references to 2 primitives, no fault: a.pbvh\n");
    EXPECT_THAT(verified.err, IsEmpty());
  }
  EXPECT_THAT(files(), ElementsAre("a.pbvh"));
}

TEST_F(BvhCliTest, TheFileDoesNotDependOnTheThreads) {
  write_triangles("many.obj", 40'000);
  for (const std::string builder : {"sah", "median"}) {
    build({"many.obj", "-o", "one.pbvh", "--threads", "1", "--builder", builder});
    build({"many.obj", "-o", "three.pbvh", "--threads", "3", "--builder", builder});
    EXPECT_TRUE(read("one.pbvh") == read("three.pbvh"));
  }
}

TEST_F(BvhCliTest, PicturesAndHitsTakeTheFile) {
  const OptionValues view = {"square.gltf", "--size", "64", "36"};
  const auto with = [&](const OptionValues& more) {
    OptionValues words = view;
    words.insert(words.end(), more.begin(), more.end());
    return words;
  };
  build({"square.gltf", "-o", "a.pbvh", "--builder", "median"});
  EXPECT_EQ(render(with({"--bvh", "a.pbvh", "--stats", "s.json"}), "a.exr").pixels, render(with({}), "b.exr").pixels);
  const json stats = json::parse(read("s.json"));
  EXPECT_EQ(stats.at("bvh").at("builder"), "median");
  EXPECT_EQ(stats.at("bvh").at("sah_cost"), 2.0);
  EXPECT_GT(stats.at("times_ms").at("bvh"), 0.0);

  write_rays("rays.npy", {{vec3(0.5F, 0.25F, 4), 0, vec3(0, 0, -1), 10}});
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "a.npy", "--bvh", "a.pbvh"}).exit_code, 0);
  ASSERT_EQ(run({"cast", "square.gltf", "rays.npy", "-o", "b.npy"}).exit_code, 0);
  EXPECT_TRUE(read("a.npy") == read("b.npy"));
  expect_failure(run({"cast", "square.gltf", "rays.npy", "-o", "c.npy", "--bvh", "a.pbvh", "--builder", "sah"}), 2,
                 "usage.options.contradict");
  expect_failure(run({"cast", "triangle.obj", "rays.npy", "-o", "c.npy", "--bvh", "a.pbvh"}), 3, "bvh.file.stale");
}

TEST_F(BvhCliTest, WrongUsageIsRefusedInOneLine) {
  build({"square.gltf", "-o", "a.pbvh"});
  expect_bvh_failure({"--quiet"}, 2, "there is no option --quiet");
  expect_bvh_failure({"biuld"}, 2, "there is no command biuld");
  expect_bvh_failure({"build"}, 2, "SCENE is required");
  expect_bvh_failure({"build", "square.gltf"}, 2, "--output is required");
  expect_bvh_failure({"build", "square.gltf", "-o", "a.bvh"}, 2, "output.extension a.bvh: .pbvh");
  expect_bvh_failure({"build", "square.gltf", "-o", "b.pbvh", "--builder", "best"}, 2, "--builder takes ");
  expect_bvh_failure({"build", "square.gltf", "-o", "b.pbvh", "--threads", "0"}, 2, "--threads takes a whole number");
  expect_bvh_failure({"build", "square.gltf", "-o", "b.pbvh", "--quiet", "-v"}, 2, "usage.options.contradict");
  expect_bvh_failure({"build", "a.pbvh", "-o", "a.pbvh"}, 2, "overwrite an input");
  expect_bvh_failure({"build", "square.gltf", "-o", "none/b.pbvh"}, 1, "output.folder.missing none/b.pbvh:");
  expect_bvh_failure({"info"}, 2, "FILE.pbvh is required");
  expect_bvh_failure({"info", "a.pbvh", "b.pbvh"}, 2, "the argument b.pbvh is not expected");
  expect_bvh_failure({"verify", "square.gltf"}, 2, "FILE.pbvh is required");
  const OptionValues contradiction = {"render", "square.gltf", "-o", "a.exr", "--bvh", "a.pbvh", "--builder", "sah"};
  expect_failure(run(contradiction), 2, "usage.options.contradict --bvh --builder");
  EXPECT_THAT(files(), ElementsAre("a.pbvh"));
}

TEST_F(BvhCliTest, FilesThatCannotBeTrustedAreRefusedWithThree) {
  build({"square.gltf", "-o", "good.pbvh"});
  const std::string good = read("good.pbvh");
  write("cut.pbvh", good.substr(0, good.size() - 3));
  write("foreign.pbvh", read("square.gltf"));
  write("empty.pbvh", "");
  std::string flipped = good;
  flipped[150] = static_cast<char>(flipped[150] ^ 4);
  write("flipped.pbvh", flipped);
  build({"triangle.obj", "-o", "stale.pbvh"});
  write("out.exr", "old");
  const std::pair<std::string, std::string> cases[] = {
      {"cut.pbvh", "bvh.file.short cut.pbvh:"},    {"foreign.pbvh", "bvh.file.kind foreign.pbvh:"},
      {"empty.pbvh", "file.empty empty.pbvh:"},    {"flipped.pbvh", "bvh.file.damaged flipped.pbvh:"},
      {"none.pbvh", "file.missing none.pbvh:"},    {".", "file.kind .:"},
      {"stale.pbvh", "bvh.file.stale stale.pbvh:"}};
  for (const auto& [file, sentence] : cases) {
    SCOPED_TRACE(file);
    expect_failure(run({"render", "square.gltf", "-o", "out.exr", "--bvh", file}), 3, sentence);
    expect_bvh_failure({"verify", "square.gltf", file}, 3, sentence);
  }
  expect_bvh_failure({"info", "flipped.pbvh"}, 3, "bvh.file.damaged");
  EXPECT_EQ(read("out.exr"), "old");
}

TEST_F(BvhCliTest, VerifyFindsABoxThatIsTooSmall) {
  build({"square.gltf", "-o", "a.pbvh"});
  // This byte belongs to the lower x of the first child's box, in the node after the header.
  forge("a.pbvh", 128 + 16, 9);
  EXPECT_EQ(run_bvh({"info", "a.pbvh"}).exit_code, 0);
  expect_bvh_failure(
      {"verify", "square.gltf", "a.pbvh"}, 3,
      "a.pbvh: the tree is wrong in 2 places, and the first is: primitive 0 of object 0 extends outside the box of its "
      "leaf or of a node above it; build it again with promin-bvh build");
}

TEST_F(BvhCliTest, AFullDiskLeavesTheOldFile) {
  write_triangles("many.obj", 1000);
  write("old.pbvh", "old");
  fill_disk(2000);
  expect_bvh_failure({"build", "many.obj", "-o", "old.pbvh", "--quiet"}, 1, "the output file cannot be written");
  EXPECT_EQ(read("old.pbvh"), "old");
  EXPECT_THAT(files(), ElementsAre("many.obj", "old.pbvh"));
}

/// If a program is killed at any time, either the complete old file or the complete new file exists.
TEST_F(BvhCliTest, AKillLeavesAWholeFile) {
  write_triangles("many.obj", 20'000);
  build({"many.obj", "-o", "new.pbvh", "--builder", "median"});
  const std::string new_file = read("new.pbvh");
  build({"square.gltf", "-o", "old.pbvh"});
  const std::string old_file = read("old.pbvh");
  // The next lines measure how long a run takes.
  const auto start = std::chrono::steady_clock::now();
  build({"many.obj", "-o", "new.pbvh", "--builder", "median"});
  const auto whole = std::chrono::steady_clock::now() - start;
  for (const int signal : {SIGKILL, SIGTERM}) {
    for (const int tenth : {1, 5, 8, 9, 10}) {
      write("old.pbvh", old_file);
      Process program(PROMIN_BVH_EXECUTABLE, {"build", "many.obj", "-o", "old.pbvh", "--builder", "median", "--quiet"},
                      options_);
      std::this_thread::sleep_for(whole * tenth / 10);
      program.send(signal);
      const ProcessResult result = program.wait();
      const std::string left = read("old.pbvh");
      EXPECT_TRUE(left == old_file || left == new_file) << tenth;
      EXPECT_TRUE(result.exit_code != 0 || left == new_file) << tenth;
      const bool has_leftover = files().size() > 3;
      EXPECT_TRUE(signal == SIGKILL || !has_leftover) << tenth;
      for (const std::string& file : files()) {
        if (file.find(".tmp") != std::string::npos) std::filesystem::remove(folder() / file);
      }
    }
  }
}

TEST_F(BvhCliTest, WithoutADeviceAllOfItWorks) {
  options_.environment = {{"VK_ICD_FILENAMES", "/nonexistent.json"}, {"VK_DRIVER_FILES", "/nonexistent.json"}};
  build({"square.gltf", "-o", "a.pbvh"});
  EXPECT_EQ(run_bvh({"info", "a.pbvh"}).exit_code, 0);
  EXPECT_EQ(run_bvh({"verify", "square.gltf", "a.pbvh"}).exit_code, 0);
}

}  // namespace
}  // namespace promin
