// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <mutex>

#include "promin/error.h"
#include "promin/progress.h"

namespace promin {

/// Reports the fraction of the work that is done to a callback, which may be empty. Throws Cancelled if the callback
/// returns false.
inline void tell_progress(const ProgressCallback& callback, double fraction) {
  if (callback && !callback(fraction)) throw Cancelled();
}

/// Adds up the progress of several threads. It reports steps of at least 0.1 %, with one call at a time.
class SharedProgress {
 public:
  /// `callback` may be empty, and must outlive this object. `total` > 0 may be an estimate: a larger sum is reported as
  /// 1.
  SharedProgress(const ProgressCallback& callback, double total) : callback_(callback), total_(total) {}

  /// Adds an amount of work. Throws Cancelled after the callback has returned false.
  void add(double amount) {
    if (!callback_) return;
    const std::lock_guard lock(mutex_);
    if (is_cancelled_) throw Cancelled();
    done_ += amount;
    const double fraction = std::min(done_ / total_, 1.0);
    if (fraction - told_ < 1e-3) return;
    told_ = fraction;
    is_cancelled_ = true;
    tell_progress(callback_, fraction);
    is_cancelled_ = false;
  }

 private:
  const ProgressCallback& callback_;
  double total_;
  std::mutex mutex_;
  double done_ = 0.0;
  double told_ = 0.0;
  bool is_cancelled_ = false;
};

}  // namespace promin
