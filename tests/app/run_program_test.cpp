// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "trace/cut_loops.h"

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
  EXPECT_THAT(message_of_cut_loops(), EndsWith(", on this device; take another --device"));
  const auto message = [](const char* where, const char* cure, Setting setting) {
    return message_of(RunError({"bad", where, cure, setting}));
  };
  EXPECT_EQ(message("asked for as the device", "choose one", Setting::kDevice),
            "bad, asked for by --device; choose one");
  EXPECT_EQ(message("x", "try again, or another device", Setting::kDevice), "bad, x; try again, or another --device");
  EXPECT_EQ(message("x", "take the builder sah", Setting::kBuilder), "bad, x; take --builder sah");
  EXPECT_EQ(message("x", "raise the memory of textures", Setting::kTextureMemory), "bad, x; raise --texture-memory");
  EXPECT_EQ(message_of(Problem{"bad", "x", "take the builder sah", Setting::kBuilder}), "bad, x; take --builder sah");
  EXPECT_EQ(message("x", "bounce less", Setting::kDepth), "bad, x; bounce less (--max-depth)") << "other words";
  EXPECT_EQ(message("another device.gltf", "take another device", Setting::kNone),
            "bad, another device.gltf; take another device");
}

TEST(MessageTest, EachProblemHasItsOption) {
  const InputError error({{"one", "", "take a smaller depth", Setting::kDepth}, {"two", "there", ""}});
  EXPECT_EQ(message_of(error), "one; lower --max-depth (1 of 2 problems)\n  two, there");
}

}  // namespace
}  // namespace promin::app
