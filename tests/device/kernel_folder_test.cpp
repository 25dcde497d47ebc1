// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device/kernel_folder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <numeric>

#include "support/temp_folder.h"

namespace promin::gpu {
namespace {

namespace fs = std::filesystem;
using Key = std::vector<uint32_t>;
using Bytes = std::vector<std::byte>;

Key key_of(uint32_t number) {
  Key key(100);
  std::iota(key.begin(), key.end(), 1000 * number);
  return key;
}

/// Returns a binary that belongs to this number.
Bytes binary_of_number(uint32_t number) {
  return Bytes(1000 + number, std::byte(number));
}

class KernelFolderTest : public TempFolder {
 protected:
  fs::path path() const { return folder_ / "cache" / "kernels"; }
  KernelFolder open(uint64_t most_bytes = KernelFolder::kMostBytes) const { return KernelFolder(path(), most_bytes); }

  static void store(const KernelFolder& folder, uint32_t number) {
    folder.store(key_of(number), binary_of_number(number));
    EXPECT_EQ(folder.problem(), "");
  }
  static bool has(const KernelFolder& folder, uint32_t number) {
    const Bytes binary = folder.find(key_of(number));
    EXPECT_TRUE(binary.empty() || binary == binary_of_number(number)) << number;
    return !binary.empty();
  }

  std::vector<fs::path> files() const {
    std::error_code missing;
    return {fs::directory_iterator(path(), missing), fs::directory_iterator()};
  }
  static std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
  static void write(const fs::path& file, const std::string& text) { std::ofstream(file, std::ios::binary) << text; }
};

TEST_F(KernelFolderTest, FindsWhatAnotherObjectStored) {
  EXPECT_FALSE(has(open(), 1));
  EXPECT_FALSE(fs::exists(path()));
  store(open(), 1);
  EXPECT_TRUE(has(open(), 1));
  EXPECT_FALSE(has(open(), 2));
  EXPECT_EQ(files().size(), 1U);
}

// The name of a file is only a hash of its key.
TEST_F(KernelFolderTest, AFileOfAnotherKeyIsNotFound) {
  store(open(), 1);
  const std::string first = read(files().front());
  fs::remove(files().front());
  store(open(), 2);
  write(files().front(), first);
  EXPECT_FALSE(has(open(), 2));
  EXPECT_FALSE(has(open(), 1));
}

TEST_F(KernelFolderTest, ADamagedFileCountsAsAbsent) {
  store(open(), 1);
  const fs::path file = files().front();
  const std::string whole = read(file);
  constexpr size_t kHead = 32;
  for (size_t i = 0; i < whole.size(); i += i < kHead ? 1 : 37) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 1 << i % 8);
    write(file, damaged);
    EXPECT_FALSE(has(open(), 1)) << i;
  }
  for (const size_t size : {size_t{0}, size_t{8}, size_t{31}, size_t{32}, size_t{100}, size_t{432}, whole.size() - 1}) {
    write(file, whole.substr(0, size));
    EXPECT_FALSE(has(open(), 1)) << size;
  }
  for (const std::string& foreign : {whole + 'x', whole + whole, std::string(5000, '\xff')}) {
    write(file, foreign);
    EXPECT_FALSE(has(open(), 1));
  }
  // The kernel is then compiled and stored again.
  store(open(), 1);
  EXPECT_TRUE(has(open(), 1));
}

TEST_F(KernelFolderTest, WhatIsNoFileCountsAsAbsent) {
  store(open(), 1);
  const fs::path file = files().front();
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_FALSE(has(open(), 1));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_FALSE(has(open(), 1));
  open().store(key_of(1), binary_of_number(1));
  EXPECT_FALSE(has(open(), 1));
}

TEST_F(KernelFolderTest, AnUnusableFolderIsAProblemAndNoError) {
  write(folder_ / "cache", "a file in place of the folder");
  const KernelFolder folder = open();
  EXPECT_FALSE(has(folder, 1));
  folder.store(key_of(1), binary_of_number(1));
  EXPECT_THAT(folder.problem(), testing::HasSubstr(path().string()));
  EXPECT_FALSE(has(folder, 1));
  fs::remove(folder_ / "cache");
  store(folder, 1);
  EXPECT_TRUE(has(folder, 1));
}

TEST_F(KernelFolderTest, AReadOnlyFolderIsStillRead) {
  store(open(), 1);
  fs::permissions(path(), static_cast<fs::perms>(0555));
  const KernelFolder folder = open();
  // The superuser may write to any folder.
  constexpr uid_t kNobody = 65534;
  const uid_t user = geteuid();
  ASSERT_TRUE(user != 0 || seteuid(kNobody) == 0);
  EXPECT_TRUE(has(folder, 1));
  folder.store(key_of(2), binary_of_number(2));
  EXPECT_THAT(folder.problem(), testing::HasSubstr("Permission denied"));
  EXPECT_TRUE(has(folder, 1));
  ASSERT_EQ(seteuid(user), 0);
  fs::permissions(path(), fs::perms::owner_all);
  EXPECT_EQ(files().size(), 1U);
}

TEST_F(KernelFolderTest, TheLeastRecentlyUsedKernelsLeave) {
  // A file has 1432 bytes and its number.
  const KernelFolder folder = open(4 * 1450);
  const auto make_older = [&] {
    for (const fs::path& file : files()) fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(1));
  };
  for (const uint32_t number : {1U, 2U, 3U, 4U}) {
    make_older();
    store(folder, number);
  }
  make_older();
  EXPECT_TRUE(has(folder, 1));
  // Only kernels are removed.
  write(path() / "another file", std::string(10'000, ' '));
  store(folder, 5);
  EXPECT_FALSE(has(folder, 2));
  for (const uint32_t number : {1U, 3U, 4U, 5U}) EXPECT_TRUE(has(folder, number)) << number;
  EXPECT_EQ(files().size(), 5U);
}

TEST_F(KernelFolderTest, AKernelAboveTheBoundIsNotKept) {
  const KernelFolder folder = open(1000);
  store(folder, 1);
  EXPECT_TRUE(files().empty());
}

// Processes store, read and remove the same kernels. has() checks that each kernel is found whole or not at all.
TEST_F(KernelFolderTest, SeveralProcessesShareIt) {
  constexpr uint32_t kKernels = 8;
  std::vector<pid_t> children;
  for (uint32_t process = 0; process < 4; ++process) {
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      const KernelFolder folder = open(kKernels / 2 * 1450);
      for (uint32_t i = 0; i < 100; ++i) {
        const uint32_t number = (i * 5 + process) % kKernels;
        if (!has(folder, number)) store(folder, number);
      }
      _exit(testing::Test::HasFailure() ? 1 : 0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  for (const fs::path& file : files()) EXPECT_THAT(file.filename().string(), testing::MatchesRegex("[0-9a-f]+.kernel"));
  for (uint32_t number = 0; number < kKernels; ++number) has(open(), number);
}

TEST_F(KernelFolderTest, TheUsualFolderIsInTheCacheOfTheUser) {
  const auto usual = [](const char* cache, const char* home) {
    for (const auto& [name, value] : {std::pair("XDG_CACHE_HOME", cache), std::pair("HOME", home)}) {
      if (value == nullptr) {
        unsetenv(name);
      } else {
        setenv(name, value, 1);
      }
    }
    return KernelFolder::usual().value_or("none").string();
  };
  const std::string cache = std::getenv("XDG_CACHE_HOME") == nullptr ? "" : std::getenv("XDG_CACHE_HOME");
  const std::string home = std::getenv("HOME") == nullptr ? "" : std::getenv("HOME");
  EXPECT_EQ(usual("/c", "/h"), "/c/promin/kernels");
  EXPECT_EQ(usual(nullptr, "/h"), "/h/.cache/promin/kernels");
  EXPECT_EQ(usual("", "/h"), "/h/.cache/promin/kernels");
  EXPECT_EQ(usual("relative", "/h"), "/h/.cache/promin/kernels");
  EXPECT_EQ(usual(nullptr, nullptr), "none");
  EXPECT_EQ(usual("", "relative"), "none");
  usual(cache.empty() ? nullptr : cache.c_str(), home.empty() ? nullptr : home.c_str());
}

}  // namespace
}  // namespace promin::gpu
