// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "output/console.h"
#include "promin/progress.h"

namespace promin::app {

/// Shows the progress of long work on the standard error stream: a bar with the remaining time on a terminal, otherwise
/// a plain line after a second and at every 10 %. It shows nothing for work that takes less than a second.
class Progress {
 public:
  /// If `is_quiet`, the object shows nothing.
  explicit Progress(bool is_quiet, std::string program = "promin");
  /// Removes the bar.
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Shows the finished fraction of the work, 0...1, and its current step, which may be empty.
  void update(double fraction, const std::string& at = {});
  /// Hides the bar until the next update.
  void clear();
  /// Returns a callback that updates the fraction, for work without steps.
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

/// Prints the name of a stage on stderr if the stage takes more than a second. If no thread can be started, it prints
/// nothing.
class StageNote {
 public:
  StageNote(std::string name, const Console& console);
  /// Ends the stage.
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
