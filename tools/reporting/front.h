// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "reporting/session.h"

namespace promin::report {

/// What something takes and how wrong it is; the less, the better.
struct CostAndError {
  double cost = 0.0;
  double error = 0.0;
};

/// Whether each lies on the Pareto front: no other is as good or better in both and better in one.
std::vector<bool> find_front(const std::vector<CostAndError>& points);

/// Marks the rows of an array from `first` on as on the front or off it, under `mark`: by the median of the times
/// `times` and the number `error`. Rows without the error are left unmarked.
void mark_front(Json& rows, size_t first, const std::string& times, const std::string& error, const std::string& mark);

}  // namespace promin::report
