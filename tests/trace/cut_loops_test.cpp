// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/kernels/cut_loops.h"

#include <gtest/gtest.h>

namespace promin {
namespace {

TEST(CutLoopsTest, AreRefused) {
  EXPECT_NO_THROW(refuse_cut_loops(false));
  EXPECT_THROW(refuse_cut_loops(true), RunError);
}

}  // namespace
}  // namespace promin
