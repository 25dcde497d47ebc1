// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// The tools' programs end as promin itself does: a sentence, and a code that tells whose fault it is.

#include "cli_fixture.h"

namespace promin {
namespace {

using testing::HasSubstr;

class ToolCliTest : public CliTest {
 protected:
  ProcessResult run_tool(const std::string& program, const OptionValues& arguments) const {
    return Process(std::filesystem::path(PROMIN_TOOL_FOLDER) / program, arguments, options_).wait();
  }
};

TEST_F(ToolCliTest, HelpAndVersionEverywhere) {
  for (const char* program :
       {"promin-bench", "promin-check-hits", "promin-peer-difference", "promin-honesty", "promin-report"}) {
    const ProcessResult help = run_tool(program, {"--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr(std::string("Usage: ") + program));
    const ProcessResult version = run_tool(program, {"--version"});
    EXPECT_EQ(version.exit_code, 0);
    EXPECT_THAT(version.out, testing::StartsWith(program));
  }
}

TEST_F(ToolCliTest, WhatIsWrongIsToldInOneLineAndByTheExitCode) {
  options_.environment = {{"VK_ICD_FILENAMES", "/nonexistent.json"}, {"VK_DRIVER_FILES", "/nonexistent.json"}};
  struct Case {
    const char* program;
    OptionValues arguments;
    int exit_code;
    const char* part;
  };
  const Case cases[] = {
      {"promin-bench", {}, 2, "SCENE is required, on the command line; see promin-bench --help"},
      {"promin-bench", {"wavy:none"}, 2, "no number of triangles"},
      {"promin-bench", {"wavy:500", "--runs", "1001"}, 2, "--runs takes a whole number"},
      {"promin-bench", {"wavy:500", "--builder", "none"}, 2, "--builder takes "},
      {"promin-bench", {"wavy:500", "--device", ""}, 2, "--device takes a part of a device's name"},
      // Before a device is asked for, and all of them before the first is measured.
      {"promin-bench", {"wavy:500", "none.gltf"}, 3, "none.gltf"},
      {"promin-bench", {"wavy:500"}, 4, ";"},
      {"promin-check-hits", {}, 2, "SCENE is required"},
      {"promin-check-hits", {"square.gltf", "triangle.obj"}, 2, "unexpected argument triangle.obj"},
      {"promin-check-hits", {"square.gltf", "--rays", "0"}, 2, "--rays takes a whole number"},
      {"promin-check-hits", {"square.gltf", "--builder", "none"}, 2, "--builder takes "},
      {"promin-check-hits", {"none.gltf"}, 3, "none.gltf"},
      {"promin-check-hits", {"square.gltf"}, 4, ";"},
      {"promin-peer-difference", {}, 2, "FIRST is required"},
      {"promin-peer-difference", {"a.exr"}, 2, "SECOND is required"},
      {"promin-peer-difference", {"a.exr", "b.exr", "--fail", "few"}, 2, "--fail takes a number"},
      {"promin-peer-difference", {"a.exr", "b.exr", "--file", "c"}, 2, "unknown option --file"},
      {"promin-peer-difference", {"a.exr", "b.exr"}, 3, "a.exr"},
      {"promin-honesty", {}, 2, "SCENE is required"},
      {"promin-honesty", {"square.gltf", "--truth", "63"}, 2, "--truth takes a whole number"},
      {"promin-honesty", {"square.gltf"}, 4, ";"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.program + testing::PrintToString(c.arguments));
    expect_failure(run_tool(c.program, c.arguments), c.exit_code, c.part, c.program);
  }
}

}  // namespace
}  // namespace promin
