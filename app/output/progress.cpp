// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <system_error>

namespace promin::app {
namespace {

using namespace std::chrono_literals;

constexpr auto kLongWork = 1s;
constexpr auto kDrawInterval = 100ms;
constexpr int kBarWidth = 40;

std::string format_time(double seconds) {
  const auto whole = static_cast<long>(std::ceil(seconds));
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

Progress::Progress(bool is_quiet, std::string program)
    : is_quiet_(is_quiet), program_(std::move(program)), is_terminal_(isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  clear();
}

void Progress::clear() {
  if (has_bar_) std::fputs("\r\033[K", stderr);
  has_bar_ = false;
}

void Progress::update(double fraction, const std::string& at) {
  const Clock::time_point now = Clock::now();
  if (is_quiet_ || fraction <= 0.0 || fraction >= 1.0 || now - start_ < kLongWork) return;
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const std::string left = format_time(elapsed / fraction * (1.0 - fraction)) + " left" + (at.empty() ? "" : ", " + at);
  if (is_terminal_) {
    if (has_bar_ && now - last_draw_ < kDrawInterval) return;
    last_draw_ = now;
    has_bar_ = true;
    const auto filled = static_cast<int>(fraction * kBarWidth);
    const std::string bar = fmt::format("\r[{:=<{}}{:{}}] {:3.0f} %, {}\033[K", "", filled, "", kBarWidth - filled,
                                        std::floor(100.0 * fraction), left);
    std::fputs(bar.c_str(), stderr);
    std::fflush(stderr);
    return;
  }
  const auto tenth = static_cast<int>(10.0 * fraction);
  if (tenth == last_tenth_) return;
  last_tenth_ = tenth;
  std::fputs(fmt::format("{}: {:.0f} %, {}\n", program_, std::floor(100.0 * fraction), left).c_str(), stderr);
}

StageNote::StageNote(std::string name, const Console& console) : name_(std::move(name)), console_(console) {
  if (console.is_quiet()) return;
  try {
    waiting_ = std::thread([this] { wait_and_tell(); });
  } catch (const std::system_error&) {
    // If no thread can be started, there is no note.
  }
}

StageNote::~StageNote() {
  {
    const std::lock_guard lock(mutex_);
    is_over_ = true;
  }
  over_.notify_all();
  if (waiting_.joinable()) waiting_.join();
}

void StageNote::wait_and_tell() {
  std::unique_lock lock(mutex_);
  if (!over_.wait_for(lock, kLongWork, [this] { return is_over_; })) console_.note(name_ + " ...");
}

}  // namespace promin::app
