// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "core/error.h"
#include "scene/load_scene.h"

namespace promin {

/// A test with a folder of its own, in which it writes small scenes and loads them.
class SceneFolder : public testing::Test {
 protected:
  SceneFolder() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string("promin_") + test->test_suite_name() + "_" + test->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = std::filesystem::path(testing::TempDir()) / name;
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~SceneFolder() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    // A new file each time: truncating an old one makes some file systems flush.
    std::filesystem::remove(folder_ / name);
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  Scene load(const std::string& name, std::string_view bytes) const { return load_scene(write(name, bytes)); }

  /// What load_scene says when it refuses a file; empty if it does not.
  static std::string refusal(const std::filesystem::path& file) {
    try {
      load_scene(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string refusal(const std::string& name, std::string_view bytes) const { return refusal(write(name, bytes)); }

  std::filesystem::path folder_;
};

}  // namespace promin
