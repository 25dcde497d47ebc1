// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "promin/error.h"
#include "support/problems.h"

namespace promin {

/// A test with an empty folder of its own, which is removed after it.
class TempFolder : public testing::Test {
 protected:
  TempFolder() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name =
        std::string("promin_") + test->test_suite_name() + "_" + test->name() + "_" + std::to_string(getpid());
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TempFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
};

/// Returns the problems of the InputError that `read` throws, as list_problems does; empty if it throws none.
template <typename Read>
std::string message_of(const Read& read) {
  try {
    read();
  } catch (const InputError& error) {
    return list_problems(error);
  }
  return "";
}

}  // namespace promin
