// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hard/hard_case.h"

namespace promin::hard {

struct RowFigure {
  int row = 0;
  std::string what;
  std::optional<double> bound;
  double figure = 0.0;
};

struct PrimitiveFigures {
  Tally tally;
  uint64_t leaks = 0;
};

/// All figures that this process has measured. If the environment variable PROMIN_FIGURES names a file, they are
/// written there as JSON at the end of the tests (tools/accuracy).
struct Figures {
  std::vector<RowFigure> rows;
  std::map<std::string, PrimitiveFigures> primitives;
};
Figures& figures();

}  // namespace promin::hard
