// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0

// These tests check that promin-lab reports errors as promin does: with one sentence, and an exit code for the kind of
// error.

#include "cli_fixture.h"

namespace promin {
namespace {

using testing::HasSubstr;

class ToolCliTest : public CliTest {
 protected:
  ProcessResult run_lab(const OptionValues& arguments) const {
    return Process(PROMIN_LAB_EXECUTABLE, arguments, options_).wait();
  }
};

TEST_F(ToolCliTest, HelpAndVersionEverywhere) {
  for (const char* command : {"rates", "growth", "robustness", "methods", "honesty", "check-hits", "difference"}) {
    const ProcessResult help = run_lab({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_THAT(help.out, HasSubstr(std::string("Usage: promin-lab ") + command));
  }
  const ProcessResult version = run_lab({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, testing::StartsWith("promin-lab"));
}

TEST_F(ToolCliTest, WhatIsWrongIsToldInOneLineAndByTheExitCode) {
  options_.environment = {{"VK_ICD_FILENAMES", "/nonexistent.json"}, {"VK_DRIVER_FILES", "/nonexistent.json"}};
  struct Case {
    OptionValues arguments;
    int exit_code;
    const char* part;
  };
  const Case cases[] = {
      {{"rates"}, 2, "SCENE is required; see promin-lab rates --help"},
      {{"rates", "wavy:none"}, 2, "wavy:none: this is no number of triangles"},
      {{"rates", "wavy:500", "--runs", "1001"}, 2, "--runs takes a whole number"},
      {{"rates", "wavy:500", "--builder", "none"}, 2, "--builder takes "},
      {{"rates", "wavy:500", "--device", ""}, 2, "--device takes a part of a device's name"},
      // The scenes are refused before a device is opened, and all scenes are read before the first is measured.
      {{"rates", "wavy:500", "none.gltf"}, 3, "none.gltf"},
      {{"rates", "wavy:500"}, 4, ";"},
      {{"check-hits"}, 2, "SCENE is required"},
      {{"check-hits", "square.gltf", "triangle.obj"}, 2, "the argument triangle.obj is not expected"},
      {{"check-hits", "square.gltf", "--rays", "0"}, 2, "--rays takes a whole number"},
      {{"check-hits", "square.gltf", "--builder", "none"}, 2, "--builder takes "},
      {{"check-hits", "none.gltf"}, 3, "none.gltf"},
      {{"check-hits", "square.gltf"}, 4, ";"},
      {{"difference"}, 2, "FIRST is required"},
      {{"difference", "a.exr"}, 2, "SECOND is required"},
      {{"difference", "a.exr", "b.exr", "--fail", "few"}, 2, "--fail takes a number"},
      {{"difference", "a.exr", "b.exr", "--file", "c"}, 2, "there is no option --file"},
      {{"difference", "a.exr", "b.exr"}, 3, "a.exr"},
      {{"honesty"}, 2, "SCENE is required"},
      {{"honesty", "square.gltf", "--truth", "63"}, 2, "--truth takes a whole number"},
      {{"honesty", "square.gltf"}, 4, ";"},
      {{"honesty", "square.gltf", "--size", "100", "75", "--integrator", "path", "--light", "none"}, 4, ";"},
      {{"honesty", "square.gltf", "--integrator", "none"}, 2, "--integrator takes "},
      {{"growth", "--runs", "0"}, 2, "--runs takes a whole number"},
      {{"growth"}, 4, ";"},
      {{"robustness"}, 2, "SCENE is required"},
      {{"methods", "square.gltf"}, 2, "--output is required"},
      {{"methods", "square.gltf", "-o", "none"}, 1, "none: the folder does not exist"},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::PrintToString(c.arguments));
    expect_failure(run_lab(c.arguments), c.exit_code, c.part, "promin-lab");
  }
}

}  // namespace
}  // namespace promin
