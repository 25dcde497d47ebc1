// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::app {

/// While an object exists, SIGINT, SIGTERM and SIGHUP are deferred, so that a file being written is completed before a
/// signal ends the program. At all other times no temporary file exists, and a signal ends the program immediately.
/// Within the life of an object, further objects have no effect.
class DeferredSignals {
 public:
  DeferredSignals();
  ~DeferredSignals();
  DeferredSignals(const DeferredSignals&) = delete;
  DeferredSignals& operator=(const DeferredSignals&) = delete;

  /// Returns whether a signal is deferred. Long work then stops and leaves no files.
  bool is_pending() const;
};

}  // namespace promin::app
