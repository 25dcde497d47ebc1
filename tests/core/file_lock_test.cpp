// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/file_lock.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <future>
#include <optional>
#include <thread>

#include "promin/error.h"
#include "support/temp_folder.h"

namespace promin {
namespace {

using std::chrono::seconds;

class FileLockTest : public TempFolder {
 protected:
  const std::filesystem::path file_ = folder_ / "tree.lock";
};

TEST_F(FileLockTest, OneHoldsItAtATime) {
  std::optional<FileLock> first(std::in_place, file_, seconds(0), nullptr);
  EXPECT_TRUE(first->is_held());
  EXPECT_FALSE(FileLock(file_, seconds(0), nullptr).is_held());
  std::atomic<int> asked = 0;
  auto second = std::async(std::launch::async,
                           [&] { return FileLock(file_, seconds(60), [&](double) { return ++asked > 0; }).is_held(); });
  while (asked < 3) std::this_thread::yield();
  EXPECT_EQ(second.wait_for(seconds(0)), std::future_status::timeout);
  first.reset();
  EXPECT_TRUE(second.get());
}

TEST_F(FileLockTest, WhoeverIsKilledHoldsItNoMore) {
  const pid_t child = fork();
  if (child == 0) {
    const FileLock lock(file_, seconds(60), nullptr);
    raise(SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status));
  EXPECT_TRUE(FileLock(file_, seconds(0), nullptr).is_held());
}

TEST_F(FileLockTest, WaitingEndsWhenItIsAskedTo) {
  const FileLock lock(file_, seconds(0), nullptr);
  int asked = 0;
  EXPECT_THROW(FileLock(file_, seconds(60), [&](double) { return ++asked < 3; }), Cancelled);
  EXPECT_EQ(asked, 3);
}

TEST_F(FileLockTest, WhereThereIsNoneToBeHadItGoesOn) {
  EXPECT_FALSE(FileLock(folder_ / "nowhere" / "tree.lock", seconds(60), nullptr).is_held());
}

}  // namespace
}  // namespace promin
