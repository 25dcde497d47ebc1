// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "console.h"
#include "promin/progress.h"

namespace promin::app {

/// Shows how far long work is, on the standard error stream: a bar with the time left on a terminal, a plain line
/// after a second and every 10 % in a pipe. Work of less than a second shows nothing.
class Progress {
 public:
  /// A quiet one shows nothing at all.
  explicit Progress(bool is_quiet, std::string program = "promin");
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the fraction of the whole work that is done, 0...1, and its current step, which may be empty.
  void update(double fraction, const std::string& at = {});
  /// Takes the bar away, until the next update.
  void clear();
  /// A callback for work that reports only its fraction.
  ProgressCallback callback() {
    return [this](double fraction) {
      update(fraction);
      return true;
    };
  }

 private:
  using Clock = std::chrono::steady_clock;

  bool is_quiet_;
  std::string program_;
  bool is_terminal_;
  bool has_bar_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_draw_ = start_;
  int last_tenth_ = -1;
};

/// Names a stage of the work on stderr where it takes more than a second. It needs a thread; without one it is silent.
class StageNote {
 public:
  StageNote(std::string name, const Console& console);
  /// The stage is over.
  ~StageNote();
  StageNote(const StageNote&) = delete;
  StageNote& operator=(const StageNote&) = delete;

 private:
  void wait_and_tell();

  std::string name_;
  const Console& console_;
  std::mutex mutex_;
  std::condition_variable over_;
  bool is_over_ = false;
  std::thread waiting_;
};

}  // namespace promin::app
