// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace promin {

/// Receives from time to time the fraction of the work that is done, 0...1. One thread at a time calls it, not
/// necessarily the caller's thread. If it returns false, the work ends before its next dispatch and the call throws
/// Cancelled (promin/error.h); the object that did the work stays usable. promin does not call an empty callback.
using ProgressCallback = std::function<bool(double)>;

}  // namespace promin
