// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <future>
#include <optional>
#include <utility>

namespace promin::app {

/// Runs work on a separate thread, one piece at a time. The destructor waits for it.
template <typename Result>
class Background {
 public:
  /// Starts work; must not be called while busy.
  template <typename Work>
  void start(Work work) {
    result_ = std::async(std::launch::async, std::move(work));
  }

  /// Returns whether work was started whose result has not been taken.
  bool is_busy() const { return result_.valid(); }
  bool is_ready() const { return is_busy() && result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready; }
  /// Returns the result when it is ready. Throws the exception of the work.
  std::optional<Result> take() { return is_ready() ? std::optional<Result>(result_.get()) : std::nullopt; }
  void wait() const {
    if (is_busy()) result_.wait();
  }

 private:
  std::future<Result> result_;
};

}  // namespace promin::app
