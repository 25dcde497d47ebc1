// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::app {

/// While one exists, SIGINT, SIGTERM and SIGHUP wait, so that a file that is being written gets whole before they end
/// the program. At any other time no temporary file exists, and they end the program at once. Only one may exist at a
/// time.
class DeferredSignals {
 public:
  DeferredSignals();
  ~DeferredSignals();
  DeferredSignals(const DeferredSignals&) = delete;
  DeferredSignals& operator=(const DeferredSignals&) = delete;

  /// Whether a signal waits: long work stops then, and leaves nothing behind.
  bool is_pending() const;
};

}  // namespace promin::app
