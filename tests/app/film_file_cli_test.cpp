// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests write films: files that hold all frames. Most of them replace ffmpeg by a script that keeps the frames.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "cli_fixture.h"
#include "support/moving_gltf.h"

namespace promin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

/// A program in place of ffmpeg whose film is its input.
constexpr const char* kKeepInput = "#!/bin/sh\nfor last; do :; done\nexec cat > \"${last#file:}\"\n";
constexpr const char* kFail = "#!/bin/sh\necho 'a detail' >&2\necho 'Unknown encoder' >&2\nexit 1\n";

class FilmFileCliTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    GltfBuilder gltf = triangle_gltf();
    test::animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 2, 0, 0}, "VEC3");
    write("film.gltf", gltf.text());
    put_ffmpeg(kKeepInput);
  }

  /// Makes the programs find this script as ffmpeg.
  void put_ffmpeg(const std::string& script) {
    std::filesystem::create_directory(folder() / "bin");
    write("bin/ffmpeg", script);
    std::filesystem::permissions(folder() / "bin/ffmpeg", std::filesystem::perms::all);
    options_.environment["PATH"] = (folder() / "bin").string() + ":/usr/bin:/bin";
  }

  ProcessResult film(OptionValues more) const {
    more.insert(more.begin(), {"render", "film.gltf", "--fps", "4", "--size", "23x15", "-s", "1", "--quiet"});
    return run(more);
  }

  void expect_film(const OptionValues& more) const {
    const ProcessResult result = film(more);
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }

  /// Returns the bytes of a frame that ffmpeg should receive: those of the picture, with even sides if requested.
  std::string bytes_of(const std::string& picture, bool is_even) const {
    const Image image = read_image(folder() / picture);
    const uvec2 size = is_even ? image.size + image.size % 2U : image.size;
    std::string bytes;
    for (uint32_t y = 0; y < size.y; ++y) {
      for (uint32_t x = 0; x < size.x; ++x) {
        const vec3& pixel = image.at(std::min(x, image.size.x - 1), std::min(y, image.size.y - 1));
        for (int i = 0; i < 3; ++i) bytes += static_cast<char>(std::lround(255.0F * pixel[i]));
      }
    }
    return bytes;
  }
};

TEST_F(FilmFileCliTest, AFilmHasTheFramesOfThePictures) {
  expect_film({"-o", "a.#.png", "-o", "a.mp4", "-o", "a.gif", "-o", "a.png", "--frames", "1-3"});
  std::string even;
  std::string same;
  for (const char* picture : {"a.1.png", "a.2.png", "a.3.png"}) {
    even += bytes_of(picture, true);
    same += bytes_of(picture, false);
  }
  EXPECT_EQ(read("a.mp4"), even);
  EXPECT_EQ(read("a.gif"), same);
  EXPECT_EQ(read("a.png"), same);
  EXPECT_THAT(files(),
              UnorderedElementsAre("bin", "film.gltf", "a.1.png", "a.2.png", "a.3.png", "a.mp4", "a.gif", "a.png"));
}

TEST_F(FilmFileCliTest, AFilmWithoutFramesShowsTheWholeAnimation) {
  expect_film({"-o", "all.gif"});
  EXPECT_EQ(read("all.gif").size(), 5U * 23 * 15 * 3);
  const ProcessResult result = run({"render", "film.gltf", "--size", "4x4", "-s", "1", "-o", "usual.webm", "--alpha"});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(read("usual.webm").size(), 25U * 4 * 4 * 4);
}

TEST_F(FilmFileCliTest, JobsGiveTheSameFilm) {
  expect_film({"-o", "a.gif", "--frames", "0-2"});
  expect_film({"--job", "job", "--pieces", "2", "--frames", "0-2", "--piece", "1/2"});
  expect_film({"--job", "job", "--pieces", "2", "--frames", "0-2", "-o", "b.gif", "-o", "b.png"});
  const ProcessResult merged = run({"merge", "job", "-o", "c.#.png", "-o", "c.gif"});
  ASSERT_EQ(merged.exit_code, 0) << merged.err;
  EXPECT_EQ(read("b.gif"), read("a.gif"));
  EXPECT_EQ(read("c.gif"), read("a.gif"));
  EXPECT_EQ(read("b.png"), read("a.gif"));
}

TEST_F(FilmFileCliTest, AFailureOfFfmpegLeavesNoFilm) {
  put_ffmpeg(kFail);
  const std::set<std::string> before = files();
  expect_failure(film({"-o", "a.mp4", "--frames", "0-2"}), 1, "ffmpeg cannot write the film (Unknown encoder)");
  put_ffmpeg("#!/bin/sh\ncat > /dev/null\necho 'No space' >&2\nexit 1\n");
  expect_failure(film({"-o", "a.mp4", "--frames", "0-2"}), 1, "ffmpeg cannot write the film (No space)");
  options_.environment["PATH"] = "/nowhere";
  expect_failure(film({"-o", "a.mp4", "--frames", "0-2"}), 1, "film.ffmpeg.missing");
  EXPECT_EQ(files(), before);
}

TEST_F(FilmFileCliTest, ASignalLeavesNoFilm) {
  Process process(PROMIN_EXECUTABLE,
                  {"render", "film.gltf", "--frames", "0-99999", "--size", "16x12", "-s", "1", "-o", "a.mp4"},
                  options_);
  const auto has_begun = [&] {
    const std::set<std::string> names = files();
    return std::ranges::any_of(names, [](const std::string& name) { return name.starts_with("a.tmp"); });
  };
  for (int i = 0; i < 3000 && !has_begun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  ASSERT_TRUE(has_begun()) << process.err();
  process.send(SIGINT);
  EXPECT_EQ(process.wait().signal, SIGINT);
  EXPECT_THAT(files(), UnorderedElementsAre("bin", "film.gltf"));
}

TEST_F(FilmFileCliTest, FfmpegGivesTheSameBytesTwice) {
  options_.environment["PATH"] = std::getenv("PATH");
  if (film({"-o", "a.mp4", "--frames", "0"}).exit_code != 0) GTEST_SKIP() << "ffmpeg is not installed";
  const OptionValues files = {"-o", "a.mp4", "-o", "a.webm", "-o", "a.gif", "-o", "a.png", "--frames", "0-2"};
  expect_film(files);
  std::vector<std::string> first;
  for (const char* file : {"a.mp4", "a.webm", "a.gif", "a.png"}) first.push_back(read(file));
  EXPECT_THAT(first,
              ElementsAre(HasSubstr("avc1"), HasSubstr("webm"), testing::StartsWith("GIF89a"), HasSubstr("acTL")));
  expect_film(files);
  size_t i = 0;
  for (const char* file : {"a.mp4", "a.webm", "a.gif", "a.png"}) EXPECT_EQ(read(file), first[i++]) << file;
}

}  // namespace
}  // namespace promin
