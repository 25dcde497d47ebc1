// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests run the programs with few system resources. Each run must give a picture or a sentence; none may hang or
// end by a signal.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "cli_fixture.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using testing::AnyOf;
using testing::HasSubstr;

/// Returns how often each limit is tried. The long test tries more often, because chance decides which thread meets the
/// limit first.
int count_runs() {
  const char* text = std::getenv("PROMIN_TEST_LIMIT_RUNS");
  return text == nullptr ? 1 : std::atoi(text);
}

class LimitsCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    // The validation layers are off, because they report each object that a device without threads leaves in use.
    options_.environment["PROMIN_VALIDATION"] = "";
  }

  void limit_threads(int count) {
    options_.environment["LD_PRELOAD"] = PROMIN_FEW_THREADS_LIBRARY;
    options_.environment["ASAN_OPTIONS"] = "verify_asan_link_order=0";
    options_.environment["PROMIN_TEST_THREADS"] = std::to_string(count);
  }

  /// Runs the program after the shell has removed the current folder.
  ProcessResult run_in_removed_folder(const std::string& arguments) const {
    ProcessOptions options = options_;
    options.folder = folder() / "gone";
    fs::create_directory(options.folder);
    const std::string command = std::string("rmdir ../gone; exec ") + PROMIN_EXECUTABLE + " " + arguments;
    return Process("/bin/sh", {"-c", command}, options).wait();
  }

  /// Compares a picture with itself. Expects the figures, or one sentence with the part.
  void compare_or_say(const std::string& file, const std::string& part) const {
    SCOPED_TRACE(file);
    const ProcessResult result = run({"compare", "--pixels-per-degree", "5", file, file});
    EXPECT_EQ(result.signal, 0) << result.err;
    if (result.exit_code == 0) {
      EXPECT_THAT(result.out, HasSubstr("largest     0"));
    } else {
      EXPECT_EQ(result.exit_code, 1);
      EXPECT_THAT(result.err, HasSubstr(part));
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
  }

  /// Renders a picture and returns the exit code. The test fails if the command writes neither a picture nor a message
  /// with one of the parts.
  int render_or_say(const std::string& part, const std::string& other_part, const std::string& features = "scene") {
    fs::remove(folder() / "a.png");
    const ProcessResult result =
        run({"render", "square.gltf", "--size", "8", "8", "-o", "a.png", "--quiet", "--features", features});
    EXPECT_EQ(result.signal, 0) << result.err;
    if (result.exit_code == 0) {
      EXPECT_TRUE(fs::exists(folder() / "a.png"));
    } else {
      EXPECT_THAT(result.exit_code, AnyOf(1, 4));
      EXPECT_THAT(result.err, AnyOf(HasSubstr(part), HasSubstr(other_part)));
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    }
    return result.exit_code;
  }
};

TEST_F(LimitsCliTest, FewThreadsGiveAPictureOrASentence) {
  for (int threads = 0; threads <= 16; ++threads) {
    limit_threads(threads);
    for (int i = 0; i < count_runs(); ++i) {
      SCOPED_TRACE(std::to_string(threads) + " threads");
      const int code = render_or_say("the system refuses to start another thread", "raise pids.max or ulimit -u");
      if (threads == 16) {
        EXPECT_EQ(code, 0) << "they suffice on machines of few cores";
      }
    }
  }
}

TEST_F(LimitsCliTest, LittleAddressSpaceGivesAPictureOrASentence) {
  for (const size_t mib : {128U, 192U, 256U, 384U, 512U, 768U, 1024U, 1536U, 2048U}) {
    options_.max_address_bytes = mib << 20;
    for (int i = 0; i < count_runs(); ++i) {
      SCOPED_TRACE(std::to_string(mib) + " MiB");
      const int code = render_or_say("ulimit -v", "ulimit -v");
      if (mib == 2048) {
        EXPECT_EQ(code, 0) << "it suffices on machines of few cores";
      }
    }
  }
}

TEST_F(LimitsCliTest, LittleAddressSpaceForLargeKernelsGivesAPictureOrASentence) {
  options_.environment["MESA_SHADER_CACHE_DISABLE"] = "true";
  for (const size_t mib : {448U, 576U, 704U}) {
    options_.max_address_bytes = mib << 20;
    for (int i = 0; i < count_runs(); ++i) {
      SCOPED_TRACE(std::to_string(mib) + " MiB");
      render_or_say("to compile the scene's kernels", "to compile the scene's kernels", "all");
    }
  }
}

TEST_F(LimitsCliTest, LibrariesOfPicturesGiveFiguresOrASentence) {
  const Image image{uvec2(4, 3), std::vector<vec3>(4 * 3, vec3(0.5F))};
  for (const char* file : {"a.exr", "a.png"}) {
    write_image(folder() / file, image);
    for (int i = 0; i < count_runs(); ++i) {
      for (int threads = 0; threads <= 16; ++threads) {
        SCOPED_TRACE(std::to_string(threads) + " threads");
        limit_threads(threads);
        compare_or_say(file, "the system refuses to start another thread");
      }
      options_.environment.erase("LD_PRELOAD");
      for (const size_t mib : {64U, 128U, 192U, 256U, 384U, 512U, 640U, 768U, 1024U, 1536U, 2048U}) {
        SCOPED_TRACE(std::to_string(mib) + " MiB");
        options_.max_address_bytes = mib << 20;
        compare_or_say(file, "ulimit -v");
      }
      options_.max_address_bytes.reset();
    }
  }
}

TEST_F(LimitsCliTest, ARemovedFolderIsNamedAsTheCause) {
  const std::string scene = (folder() / "square.gltf").string();
  const std::string picture = (folder() / "a.png").string();
  for (const auto& [arguments, named] : {std::pair("render " + scene + " -o a.png", "a.png"),
                                         {"render " + scene + " --job job -o " + picture, "job"},
                                         {"render " + scene + " --job ./a/job -o " + picture, "./a/job"},
                                         {"merge job -o " + picture, "job"},
                                         {"compare a.exr " + picture, "a.exr"}}) {
    const ProcessResult result = run_in_removed_folder(arguments);
    expect_failure(result, 1, "folder.lost " + std::string(named) + ":");
  }
}

TEST_F(LimitsCliTest, AManifestThatIsNoneIsNamed) {
  write("bad.json", "{");
  for (const char* variable : {"VK_DRIVER_FILES", "VK_ICD_FILENAMES"}) {
    options_.environment = {{"VK_DRIVER_FILES", ""}, {"VK_ICD_FILENAMES", ""}};
    for (const std::string other : {"", ":none.json"}) {
      options_.environment[variable] = "bad.json" + other;
      const std::string said = std::string("bad.json: there is no Vulkan device: the manifest of a driver, which ") +
                               variable + " names, is not JSON; ";
      expect_failure(run({"render", "square.gltf", "-o", "a.png"}), 4, said);
      expect_failure(run({"devices"}), 4, said);
    }
    options_.environment[variable] = "none.json";
    expect_failure(run({"devices"}), 4,
                   std::string("none.json: there is no Vulkan device: the manifest of a driver, which ") + variable +
                       " names, does not exist; ");
  }
}

TEST_F(LimitsCliTest, AnOutputKeepsItsMode) {
  fs::create_directory(folder() / "store");
  fs::create_symlink("store/new.png", folder() / "link.png");
  const std::string longest = std::string(251, 'n') + ".exr";
  const OptionValues arguments = {"render", "square.gltf", "--size", "8",     "8",       "-o",     "a.exr",
                                  "-o",     "link.png",    "-o",     longest, "--stats", "s.json", "--quiet"};
  for (const char* name : {"a.exr", "s.json"}) {
    write(name, "old");
    fs::permissions(folder() / name, fs::perms(0600));
  }
  const ProcessResult result = run(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  for (const char* name : {"a.exr", "s.json"}) {
    EXPECT_EQ(fs::status(folder() / name).permissions(), fs::perms(0600)) << name;
    EXPECT_GT(fs::file_size(folder() / name), 3U) << name;
  }
  EXPECT_TRUE(fs::is_symlink(folder() / "link.png"));
  EXPECT_TRUE(fs::is_regular_file(folder() / "store/new.png"));
  EXPECT_TRUE(fs::is_regular_file(folder() / longest));
}

}  // namespace
}  // namespace promin
