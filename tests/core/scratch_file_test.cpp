// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/scratch_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "promin/error.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

class ScratchFileTest : public TempFolder {
 protected:
  ptrdiff_t file_count() const { return std::distance(fs::directory_iterator(folder_), {}); }

  std::string failure(const fs::path& target, uint64_t byte_count) const {
    try {
      ScratchFile file(target, byte_count);
    } catch (const RunError& error) {
      return error.what();
    }
    return "";
  }
};

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST_F(ScratchFileTest, HoldsWhatIsWrittenInAnyOrderAndHasNoName) {
  ScratchFile file(folder_ / "a.exr", 10);
  EXPECT_EQ(file_count(), 0);
  file.write(5, bytes_of("world"));
  file.write(0, bytes_of("hello"));
  std::vector<std::byte> read(7);
  file.read(3, read);
  EXPECT_EQ(read, bytes_of("loworld"));
  std::vector<std::byte> beyond(2);
  EXPECT_THROW(file.read(9, beyond), RunError);
}

TEST_F(ScratchFileTest, ReplacesNothing) {
  std::ofstream(folder_ / "a.exr") << "old";
  { const ScratchFile file(folder_ / "a.exr", 10); }
  EXPECT_EQ(fs::file_size(folder_ / "a.exr"), 3U);
  EXPECT_EQ(file_count(), 1);
}

// Before anything is written: the room is taken at once.
TEST_F(ScratchFileTest, RoomThatIsNotThereIsToldAtOnce) {
  EXPECT_THAT(failure(folder_ / "none" / "a.exr", 10), testing::HasSubstr("does not exist"));
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const auto handler = signal(SIGXFSZ, SIG_IGN);
  const rlimit small{1 << 20, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string message = failure(folder_ / "a.exr", 3 << 20);
  setrlimit(RLIMIT_FSIZE, &old);
  signal(SIGXFSZ, handler);
  EXPECT_THAT(message, testing::StartsWith("cannot keep 4 MB beside the output file until it can be written ("));
  EXPECT_THAT(message, testing::HasSubstr("a.exr; check the disk"));
  EXPECT_EQ(file_count(), 0);
}

}  // namespace
}  // namespace promin
