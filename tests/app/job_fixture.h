// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

#include "cli_fixture.h"
#include "device_scene/pack_scene.h"
#include "support/ply_builder.h"
#include "support/sheet.h"

namespace promin {

/// Runs commands with --job job.
class JobFixture : public CliTest {
 protected:
  void expect_done(const ProcessResult& result) const { EXPECT_EQ(result.exit_code, 0) << result.err; }

  /// Writes a mesh whose tree is kept for all processes that work on a job.
  void write_sheet(const std::string& file) const {
    const Mesh sheet = make_sheet(kLeastShared + kLeastShared / 10);
    PlyBuilder ply(std::endian::little);
    ply.header("element vertex " + std::to_string(sheet.positions.size()) +
               "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
               std::to_string(sheet.triangles.size()) + "\nproperty list uchar int vertex_indices\n");
    for (const vec3& position : sheet.positions) {
      for (int i = 0; i < 3; ++i) ply.add("float", position[i]);
    }
    for (const uvec3& triangle : sheet.triangles) {
      ply.add("uchar", 3);
      for (int i = 0; i < 3; ++i) ply.add("int", triangle[i]);
    }
    write(file, ply.bytes());
  }

  /// Returns the names of the files in the folder of the job's trees.
  std::vector<std::string> trees() const {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder() / "job" / "trees", error)) {
      names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
  }

  std::vector<std::filesystem::path> pieces() const {
    std::vector<std::filesystem::path> files(std::filesystem::directory_iterator(folder() / "job" / "pieces"),
                                             std::filesystem::directory_iterator());
    std::ranges::sort(files);
    return files;
  }

  /// Waits up to a minute until is_begun() returns true, sends a signal to a command, and waits for its end.
  template <typename IsBegun>
  ProcessResult signal_when(const IsBegun& is_begun, int signal, const OptionValues& command) const {
    Process program(PROMIN_EXECUTABLE, command, options_);
    for (int i = 0; i < 6000 && !is_begun(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    program.send(signal);
    return program.wait();
  }

  /// Cuts the first piece, empties the second and flips a bit of the third. Returns the names of all three.
  std::vector<std::filesystem::path> damage_pieces() const {
    const auto files = pieces();
    std::filesystem::resize_file(files[0], std::filesystem::file_size(files[0]) - 10);
    std::filesystem::resize_file(files[1], 0);
    const std::string third = "job/pieces/" + files[2].filename().string();
    std::string bytes = read(third);
    bytes[bytes.size() - 5] = static_cast<char>(bytes[bytes.size() - 5] ^ 4);
    write(third, bytes);
    return files;
  }

  /// Runs a command that makes `file` with a job, kills it repeatedly, and starts it again: `PROMIN_TEST_KILLS` times,
  /// 6 by default. Each time, the file must have the content `whole` or be absent.
  void expect_goes_on(const OptionValues& command, const std::string& file, const std::string& whole,
                      size_t piece_count) const {
    const char* const kills_word = std::getenv("PROMIN_TEST_KILLS");
    const int kills = kills_word == nullptr ? 6 : std::atoi(kills_word);
    const auto start_anew = [&] {
      std::filesystem::remove_all(folder() / "job");
      std::filesystem::remove(folder() / file);
    };
    const auto start = std::chrono::steady_clock::now();
    expect_done(run(command));
    const auto duration = std::chrono::steady_clock::now() - start;
    start_anew();
    int ended = 0;
    for (int i = 0; i < kills; ++i) {
      Process program(PROMIN_EXECUTABLE, command, options_);
      // The golden ratio spreads the times of the kills over a run.
      const double share = std::fmod(0.618033988749895 * (i + 1), 1.0);
      std::this_thread::sleep_for(std::chrono::duration_cast<std::chrono::microseconds>(duration * share));
      const int signal = i % 2 == 0 ? SIGKILL : SIGINT;
      program.send(signal);
      ended += program.wait().signal == signal ? 1 : 0;
      if (std::filesystem::exists(folder() / file)) {
        EXPECT_TRUE(read(file) == read(whole));
        start_anew();
      }
    }
    EXPECT_GT(ended, kills / 4);
    expect_done(run(command));
    EXPECT_TRUE(read(file) == read(whole));
    // The folder has no other files.
    EXPECT_EQ(pieces().size(), piece_count);
  }
};

}  // namespace promin
