// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/run_program.h"
#include "output/message_of.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "trace/kernels/cut_loops.h"

namespace promin::app {
namespace {

using testing::EndsWith;

std::string message_of_cut_loops() {
  try {
    refuse_cut_loops(true);
  } catch (const RunError& error) {
    return message_of(error);
  }
  return "";
}

TEST(MessageTest, OptionsAreNamedForTheSettingsOfTheLibrary) {
  EXPECT_THAT(message_of_cut_loops(), EndsWith("; use another --device, or remove coincident surfaces"));
  const auto message = [](const char* where, const char* cure, Setting setting) {
    return message_of(RunError({"device.lost", "bad", where, cure, setting}));
  };
  EXPECT_EQ(message("x", "try again, or another device", Setting::kDevice), "x: bad; try again, or another --device");
  EXPECT_EQ(message("x", "use the builder sah", Setting::kBuilder), "x: bad; use --builder sah");
  EXPECT_EQ(message("x", "raise the memory for textures", Setting::kTextureMemory), "x: bad; raise --texture-memory");
  EXPECT_EQ(message_of(Problem{"device.lost", "bad", "x", "use the builder sah", Setting::kBuilder}),
            "x: bad; use --builder sah");
  EXPECT_EQ(message("x", "bounce less", Setting::kDepth), "x: bad; bounce less (--max-depth)") << "other words";
  EXPECT_EQ(message("another device.gltf", "use another device", Setting::kNone),
            "another device.gltf: bad; use another device");
}

TEST(MessageTest, EachProblemHasItsOption) {
  const InputError error({Problem{"view.depth.range", "one", "", "use a smaller depth", Setting::kDepth},
                          Problem{"file.missing", "two", "there", ""}});
  EXPECT_EQ(message_of(error), "one; lower --max-depth (1 of 2 problems)\n  there: two");
}

/// Returns the message and the exit code of a program that does this work.
std::pair<int, std::string> run_work(const std::function<void()>& work) {
  static std::function<void()> does;
  does = work;
  const auto add = [](CLI::App& program) {
    CLI::App& command = add_command(program, "work", "Work");
    return Command{&command, [] { does(); }};
  };
  const char* const arguments[] = {"promin", "work"};
  testing::internal::CaptureStderr();
  const int code = run_program("promin", "", {add}, 2, arguments);
  return {code, testing::internal::GetCapturedStderr()};
}

// Only unexpected exceptions are called a bug.
TEST(RunProgramTest, WhatTheSystemRefusesIsNoBug) {
  const auto system_error = [](std::errc code) { return std::system_error(std::make_error_code(code)); };
  EXPECT_EQ(
      run_work([&] { throw system_error(std::errc::resource_unavailable_try_again); }),
      std::pair(1, std::string("promin: the system refuses to start another thread; raise pids.max or ulimit -u\n")));
  EXPECT_EQ(run_work([] {
              throw std::filesystem::filesystem_error("cannot", "there", std::make_error_code(std::errc::io_error));
            }).second,
            "promin: there: the system refused a request (Input/output error); check its limits and "
            "permissions\n");
  EXPECT_THAT(run_work([] { throw std::bad_alloc(); }).second,
              testing::HasSubstr("promin: promin has not enough memory"));
  EXPECT_THAT(run_work([] { throw std::logic_error("x"); }).second, testing::HasSubstr("report it as a bug"));
}

}  // namespace
}  // namespace promin::app
