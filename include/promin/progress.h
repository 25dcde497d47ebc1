// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace promin {

/// Is called with the fraction of some work that is done, 0...1, from time to time and by one thread at a time. To
/// return false ends the work with Cancelled (promin/error.h); what was asked to do it stays usable.
using ProgressCallback = std::function<bool(double)>;

}  // namespace promin
