// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include "promin/math.h"

namespace promin::test {

/// Expects that two points or directions differ by at most `tolerance`.
inline void expect_near(const dvec3& got, const dvec3& wanted, double tolerance = 1e-6) {
  EXPECT_LE(glm::distance(got, wanted), tolerance)
      << got.x << " " << got.y << " " << got.z << " is not " << wanted.x << " " << wanted.y << " " << wanted.z;
}

}  // namespace promin::test
