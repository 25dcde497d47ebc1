// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/file.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <functional>

#include "promin/error.h"
#include "support/temp_folder.h"

namespace {
/// The number of files that are renamed before the process ends as if it were killed; a negative number means that it
/// does not end.
int renames_to_the_end = -1;
constexpr int kKilled = 99;
}  // namespace

/// This function replaces the C library's.
extern "C" int rename(const char* from, const char* to) noexcept {
  if (renames_to_the_end >= 0 && renames_to_the_end-- == 0) _exit(kKilled);
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

namespace promin {
namespace {

namespace fs = std::filesystem;

class FileTest : public TempFolder {};

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string message_of_reading(const fs::path& file) {
  return message_of([&] { read_file(file); });
}

TEST_F(FileTest, WhatIsWrittenIsRead) {
  write_text_file(folder_ / "a.txt", "one");
  write_text_file(folder_ / "a.txt", "two");
  EXPECT_EQ(text_of(folder_ / "a.txt"), "two");
  EXPECT_EQ(read_file(folder_ / "a.txt").size(), 3U);
}

TEST_F(FileTest, WithoutCommitTheOldFileStays) {
  write_text_file(folder_ / "a.txt", "old");
  {
    AtomicFile output(folder_ / "a.txt");
    std::ofstream(output.temporary()) << "half";
  }
  EXPECT_EQ(text_of(folder_ / "a.txt"), "old");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "the temporary file was left behind";
}

TEST_F(FileTest, FilesThatBelongTogetherAppearTogetherOrNotAtAll) {
  const auto commit = [&](const std::function<void()>& before) {
    AtomicFile a(folder_ / "a.txt");
    AtomicFile b(folder_ / "b.txt");
    AtomicFile c(folder_ / "c.txt");
    AtomicFile* const files[] = {&a, &b, &c};
    for (const AtomicFile* file : files) std::ofstream(file->temporary()) << "new";
    before();
    AtomicFile::commit_together(files);
  };
  write_text_file(folder_ / "a.txt", "old");
  // The last file cannot be renamed, because meanwhile a folder has its name.
  EXPECT_THROW(commit([&] { fs::create_directory(folder_ / "c.txt"); }), RunError);
  EXPECT_EQ(text_of(folder_ / "a.txt"), "old");
  EXPECT_FALSE(fs::exists(folder_ / "b.txt"));
  fs::remove(folder_ / "c.txt");
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1) << "something was left behind";
  // If a file cannot be read after it was written, no file is renamed.
  EXPECT_THROW(commit([&] {
                 for (const auto& entry : fs::directory_iterator(folder_)) {
                   if (entry.path().string().find("c.tmp") != std::string::npos) fs::remove(entry.path());
                 }
               }),
               RunError);
  EXPECT_EQ(text_of(folder_ / "a.txt"), "old");
  commit([] {});
  for (const char* name : {"a.txt", "b.txt", "c.txt"}) EXPECT_EQ(text_of(folder_ / name), "new") << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3) << "something was left behind";
}

// The old files are also kept if the first of the new ones cannot be renamed.
TEST_F(FileTest, OldFilesOfACommitThatFailsAreBack) {
  for (const char* name : {"b.txt", "c.txt"}) write_text_file(folder_ / name, "old");
  {
    AtomicFile a(folder_ / "a.txt");
    AtomicFile b(folder_ / "b.txt");
    AtomicFile c(folder_ / "c.txt");
    AtomicFile* const files[] = {&a, &b, &c};
    for (const AtomicFile* file : files) std::ofstream(file->temporary()) << "new";
    fs::create_directory(folder_ / "a.txt");
    EXPECT_THROW(AtomicFile::commit_together(files), RunError);
  }
  for (const char* name : {"b.txt", "c.txt"}) EXPECT_EQ(text_of(folder_ / name), "old") << name;
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 3) << "something was left behind";
}

// A new file never exists beside an old one, even if the process is killed at any time.
TEST_F(FileTest, AKillLeavesNoFilesThatDoNotBelongTogether) {
  const std::string states[] = {"old, ", "new, ", "new, new"};
  for (int renames = 0; renames < 3; ++renames) {
    for (const char* name : {"a.txt", "b.txt"}) write_text_file(folder_ / name, "old");
    const pid_t child = fork();
    if (child == 0) {
      AtomicFile a(folder_ / "a.txt");
      AtomicFile b(folder_ / "b.txt");
      AtomicFile* const files[] = {&a, &b};
      for (const AtomicFile* file : files) std::ofstream(file->temporary()) << "new";
      renames_to_the_end = renames;
      AtomicFile::commit_together(files);
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_EQ(WEXITSTATUS(status), renames < 2 ? kKilled : 0);
    EXPECT_EQ(text_of(folder_ / "a.txt") + ", " + text_of(folder_ / "b.txt"), states[renames]);
    clear_leftovers(folder_);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), renames < 2 ? 1 : 2) << "something was left behind";
  }
}

// Temporary files of ended processes of this machine are removed. Files of other processes and of users stay.
TEST_F(FileTest, LeftoversOfTheDeadAreCleared) {
  // This number is larger than any process number.
  const std::string dead = "a.tmp99999999-" + host_name() + ".exr";
  const std::string others[] = {"a.tmp1-" + host_name() + ".exr", "a.tmp99999999-elsewhere.exr", "a.tmp.exr",
                                "a.tmp99999999.exr", "a.exr"};
  write_text_file(folder_ / dead, "half");
  for (const std::string& name : others) write_text_file(folder_ / name, "whole");
  clear_leftovers(folder_);
  EXPECT_FALSE(fs::exists(folder_ / dead));
  for (const std::string& name : others) EXPECT_TRUE(fs::exists(folder_ / name)) << name;
  clear_leftovers(folder_ / "nowhere");
}

// An earlier process with the same number has left a file; the file that this process is writing stays.
TEST_F(FileTest, ThreadsMayWriteOneFileAtATime) {
  AtomicFile first(folder_ / "a.exr");
  AtomicFile second(folder_ / "a.exr");
  EXPECT_NE(first.temporary(), second.temporary());
  std::ofstream(first.temporary()) << "first";
  std::ofstream(second.temporary()) << "second";
  const fs::path left = folder_ / ("b.tmp" + std::to_string(getpid()) + "-" + host_name() + ".exr");
  std::ofstream(left) << "half";
  clear_leftovers(folder_);
  EXPECT_FALSE(fs::exists(left));
  second.commit();
  EXPECT_EQ(text_of(folder_ / "a.exr"), "second");
  first.commit();
  EXPECT_EQ(text_of(folder_ / "a.exr"), "first");
}

TEST_F(FileTest, UnreadableFilesSayWhy) {
  std::ofstream(folder_ / "empty.obj").close();
  EXPECT_THAT(message_of_reading(folder_ / "none.obj"), HasProblem("file.missing"));
  EXPECT_THAT(message_of_reading(folder_), HasProblem("file.folder"));
  EXPECT_THAT(message_of_reading(folder_ / "empty.obj"), HasProblem("file.empty"));
}

TEST_F(FileTest, UnwritableTargetsAreRefused) {
  EXPECT_THROW(write_text_file(folder_ / "none" / "a.txt", "x"), RunError);
  EXPECT_THROW(write_text_file(folder_, "x"), RunError);
  EXPECT_THROW(write_text_file("/dev/null", "x"), RunError);
}

TEST_F(FileTest, ASymbolicLinkIsFollowed) {
  write_text_file(folder_ / "a.txt", "old");
  fs::create_symlink("a.txt", folder_ / "link.txt");
  write_text_file(folder_ / "link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_EQ(text_of(folder_ / "a.txt"), "new");
}

TEST_F(FileTest, ADanglingLinkIsFollowed) {
  fs::create_directory(folder_ / "store");
  fs::create_symlink("store/new.txt", folder_ / "link.txt");
  fs::create_symlink("link.txt", folder_ / "link_of_link.txt");
  write_text_file(folder_ / "link_of_link.txt", "new");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link.txt"));
  EXPECT_TRUE(fs::is_symlink(folder_ / "link_of_link.txt"));
  EXPECT_EQ(text_of(folder_ / "store/new.txt"), "new");

  fs::create_symlink("circle.txt", folder_ / "circle.txt");
  EXPECT_EQ(follow_links(folder_ / "circle.txt"), folder_ / "circle.txt");
}

TEST_F(FileTest, AFileKeepsTheModeOfTheOneItReplaces) {
  const auto mode_of = [](const fs::path& file) { return static_cast<unsigned>(fs::status(file).permissions()); };
  for (const unsigned mode : {0600U, 0640U, 0664U, 0755U, 0444U}) {
    const fs::path file = folder_ / "a.txt";
    fs::remove(file);
    write_text_file(file, "old");
    fs::permissions(file, static_cast<fs::perms>(mode));
    AtomicFile output(file);
    // A user who must not read the complete file must not be able to read it while it is written.
    EXPECT_EQ(mode_of(output.temporary()), mode | 0200U);
    std::ofstream(output.temporary()) << "new";
    output.commit();
    EXPECT_EQ(mode_of(file), mode);
    EXPECT_EQ(text_of(file), "new");
  }
}

TEST_F(FileTest, NamesMayBeAsLongAsTheFileSystemAllows) {
  constexpr size_t kMost = 255;
  std::string umlauts;
  while (umlauts.size() + 6 <= kMost) umlauts += "\xC3\xA4";
  for (const std::string& stem : {std::string(kMost - 4, 'n'), umlauts}) {
    const fs::path file = folder_ / (stem + ".txt");
    write_text_file(file, "old");
    AtomicFile first(file);
    AtomicFile second(file);
    const std::string name = first.temporary().filename();
    EXPECT_LE(name.size() + 4, kMost) << "commit_together puts old- before it";
    EXPECT_NE(first.temporary(), second.temporary());
    EXPECT_EQ(name.find("\xC3."), std::string::npos) << "half a character";
    EXPECT_EQ(first.temporary().extension(), ".txt");
    for (const AtomicFile* output : {&first, &second}) std::ofstream(output->temporary()) << "new";
    AtomicFile* const files[] = {&first};
    AtomicFile::commit_together(files);
    EXPECT_EQ(text_of(file), "new");
  }
  // The extension of this name is longer than the rest of the name.
  write_text_file(folder_ / ("a." + std::string(kMost - 2, 'e')), "new");
}

TEST_F(FileTest, ARemovedFolderIsNamedAsTheCause) {
  const fs::path old_folder = fs::current_path();
  fs::create_directory(folder_ / "gone");
  fs::current_path(folder_ / "gone");
  fs::remove(folder_ / "gone");
  const auto refusal_of = [](const std::function<void()>& work) -> std::string {
    try {
      work();
    } catch (const RunError& error) {
      return list_problems(error);
    }
    return "";
  };
  const std::string reading = refusal_of([] { read_file("a.obj"); });
  const std::string writing = refusal_of([] { write_text_file("a.txt", "x"); });
  write_text_file(folder_ / "elsewhere.txt", "x");
  fs::current_path(old_folder);
  EXPECT_THAT(reading, HasProblem("folder.lost a.obj"));
  EXPECT_THAT(writing, HasProblem("folder.lost a.txt"));
}

TEST(ErrorTest, SeveralProblemsAreCountedAndIndented) {
  const InputError error({Problem{"file.missing", "a", "b", "c"}, Problem{"file.open", "d", "", ""}});
  EXPECT_STREQ(error.what(), "b: a; c (1 of 2 problems)\n  d");
}

}  // namespace
}  // namespace promin
