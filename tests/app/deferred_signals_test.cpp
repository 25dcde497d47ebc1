// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/deferred_signals.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>

#include "core/file.h"

namespace promin::app {
namespace {

namespace fs = std::filesystem;

TEST(DeferredSignalsDeathTest, ASignalWaitsUntilTheFileIsWhole) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const fs::path file = fs::path(testing::TempDir()) / "promin_deferred_signals.txt";
    fs::remove(file);
    const auto write_while_interrupted = [&] {
      const DeferredSignals deferred;
      std::raise(signal);
      write_text_file(file, "whole");
    };
    EXPECT_EXIT(write_while_interrupted(), testing::KilledBySignal(signal), "");
    EXPECT_TRUE(fs::exists(file));
    fs::remove(file);
  }
}

TEST(DeferredSignalsDeathTest, AnIgnoredSignalStaysIgnored) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto run = [] {
    std::signal(SIGHUP, SIG_IGN);
    {
      const DeferredSignals deferred;
      std::raise(SIGHUP);
    }
    std::exit(7);
  };
  EXPECT_EXIT(run(), testing::ExitedWithCode(7), "");
}

}  // namespace
}  // namespace promin::app
