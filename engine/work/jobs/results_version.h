// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace promin::work {

/// The version of the bits that promin computes. It is a part of a job's identity. Increase it in each change that
/// changes bits of any picture or hit: tests/golden/results_test.cpp requires this if stored pictures or casts change.
/// Jobs of other versions cannot be continued.
inline constexpr int kResultsVersion = 3;

}  // namespace promin::work
