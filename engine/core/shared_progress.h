// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <mutex>

namespace promin {

/// Is called with the fraction of some work that is done, 0...1.
using ProgressCallback = std::function<void(double)>;

/// Gathers what several threads have done of a work and tells a callback, one call at a time and not for less than a
/// thousandth.
class SharedProgress {
 public:
  /// `callback` may be empty and must outlive this. `total` > 0 may be an estimate; more than all is told as all.
  SharedProgress(const ProgressCallback& callback, double total) : callback_(callback), total_(total) {}

  void add(double amount) {
    if (!callback_) return;
    const std::lock_guard lock(mutex_);
    done_ += amount;
    const double fraction = std::min(done_ / total_, 1.0);
    if (fraction - told_ < 1e-3) return;
    told_ = fraction;
    callback_(fraction);
  }

 private:
  const ProgressCallback& callback_;
  double total_;
  std::mutex mutex_;
  double done_ = 0.0;
  double told_ = 0.0;
};

}  // namespace promin
