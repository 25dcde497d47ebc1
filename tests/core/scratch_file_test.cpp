// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/scratch_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "promin/error.h"
#include "support/file_size_limit.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

class ScratchFileTest : public TempFolder {
 protected:
  ptrdiff_t file_count() const { return std::distance(fs::directory_iterator(folder_), {}); }

  std::string failure(const fs::path& target, uint64_t byte_count) const {
    return failure_of([&] { ScratchFile file(target, byte_count); });
  }

  template <typename Step>
  static std::string failure_of(const Step& step) {
    try {
      step();
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

// The space is reserved immediately, before anything is written.
TEST_F(ScratchFileTest, RoomThatIsNotThereIsToldAtOnce) {
  EXPECT_THAT(failure(folder_ / "none" / "a.exr", 10), testing::HasSubstr("does not exist"));
  const std::string message = [&] {
    const FileSizeLimit limit(1 << 20);
    return failure(folder_ / "a.exr", 3 << 20);
  }();
  EXPECT_THAT(message,
              testing::HasSubstr("a.exr: there is no room for 4 MB beside the output file until it can be written ("));
  EXPECT_THAT(message, testing::HasSubstr("a.exr: "));
  EXPECT_EQ(file_count(), 0);
}

// The system writes as much as there is room for, and reports an error only when it is asked to write the rest.
TEST_F(ScratchFileTest, ADiskThatFillsIsToldByWhoeverWrites) {
  ScratchFile file(folder_ / "a.exr", 0);
  const std::vector<std::byte> bytes(3 << 20, std::byte{7});
  const std::string message = [&] {
    const FileSizeLimit limit(1 << 20);
    return failure_of([&] { file.write(0, bytes); });
  }();
  EXPECT_THAT(message,
              testing::HasSubstr("a.exr: there is no room for 1 MB beside the output file until it can be written ("));
  // The data that were written before still exist.
  std::vector<std::byte> read(1 << 20);
  file.read(0, read);
  EXPECT_TRUE(std::equal(read.begin(), read.end(), bytes.begin()));
}

}  // namespace
}  // namespace promin
