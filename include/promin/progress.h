// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace promin {

/// Is called with the fraction of some work that is done, 0...1, from time to time and by one thread at a time, which
/// need not be the caller's. Where it returns false the work ends before its next dispatch and the call throws
/// Cancelled (promin/error.h); what was asked to do the work stays usable. An empty one is not called.
using ProgressCallback = std::function<bool(double)>;

}  // namespace promin
