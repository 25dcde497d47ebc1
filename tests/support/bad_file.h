// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

#include <ostream>
#include <string>

#include "support/scene_folder.h"

namespace promin {

/// A file, or a part of one, that is refused, with the problem and the place that the message must name.
struct BadFile {
  const char* name;
  std::string text;
  /// The problem, in the form that HasProblem takes.
  const char* what;
  /// The text that must follow the file's name.
  const char* where;
};

inline std::ostream& operator<<(std::ostream& stream, const BadFile& bad) {
  return stream << bad.name;
}

/// Runs a test for each bad file of a table.
class BadFileTest : public SceneFolder, public testing::WithParamInterface<BadFile> {
 protected:
  /// Loads a file of the test's folder and expects a refusal.
  void expect_refusal(const std::string& file, const std::string& text) const {
    const std::string message = refusal(file, text);
    EXPECT_THAT(message, HasProblem(GetParam().what));
    EXPECT_THAT(message, testing::HasSubstr(file + GetParam().where));
    EXPECT_THAT(message, testing::HasSubstr("; ")) << "no cure";
  }
};

inline std::string name_of_bad_file(const testing::TestParamInfo<BadFile>& bad) {
  return bad.param.name;
}

}  // namespace promin
