// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/deferred_signals.h"

#include <array>
#include <csignal>

namespace promin::app {
namespace {

constexpr std::array kDeferred = {SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t pending_signal = 0;
/// The number of objects that exist.
int deferring_count = 0;
std::array<struct sigaction, kDeferred.size()> old_actions;

void remember(int signal) {
  pending_signal = signal;
}

}  // namespace

DeferredSignals::DeferredSignals() {
  if (deferring_count++ > 0) return;
  pending_signal = 0;
  for (size_t i = 0; i < kDeferred.size(); ++i) {
    // If the parent process ignores a signal (nohup, background jobs), it stays ignored.
    sigaction(kDeferred[i], nullptr, &old_actions[i]);
    if (old_actions[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = SA_RESTART;
    sigaction(kDeferred[i], &action, nullptr);
  }
}

DeferredSignals::~DeferredSignals() {
  if (--deferring_count > 0) return;
  for (size_t i = 0; i < kDeferred.size(); ++i) sigaction(kDeferred[i], &old_actions[i], nullptr);
  if (pending_signal != 0) std::raise(pending_signal);
}

bool DeferredSignals::is_pending() const {
  return pending_signal != 0;
}

}  // namespace promin::app
