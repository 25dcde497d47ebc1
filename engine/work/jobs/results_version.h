// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::work {

/// The version of the bits that promin computes. It is a part of a job's identity. Raise it in each change that gives
/// any picture or hit other bits: tests/golden/results_test.cpp requires that if stored pictures or casts change. Jobs
/// of other versions cannot continue.
inline constexpr int kResultsVersion = 1;

}  // namespace promin::work
