// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::app {

/// While one exists, SIGINT, SIGTERM and SIGHUP wait: a file that is being written gets whole before they end the
/// program. At any other time no temporary file exists, and they end it at once. One at a time.
class DeferredSignals {
 public:
  DeferredSignals();
  ~DeferredSignals();
  DeferredSignals(const DeferredSignals&) = delete;
  DeferredSignals& operator=(const DeferredSignals&) = delete;

  /// Whether one waits: long work stops then, and leaves nothing behind.
  bool is_pending() const;
};

}  // namespace promin::app
