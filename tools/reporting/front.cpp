// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/front.h"

#include <algorithm>

namespace promin::report {
namespace {

bool dominates(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

}  // namespace

std::vector<bool> find_front(const std::vector<CostAndError>& points) {
  std::vector<bool> is_on_front;
  for (const CostAndError& point : points) {
    is_on_front.push_back(
        std::none_of(points.begin(), points.end(), [&](const CostAndError& other) { return dominates(other, point); }));
  }
  return is_on_front;
}

void mark_front(Json& rows, size_t first, const std::string& times, const std::string& error, const std::string& mark) {
  std::vector<size_t> indices;
  std::vector<CostAndError> points;
  for (size_t i = first; i < rows.size(); ++i) {
    if (!rows[i].contains(error)) continue;
    indices.push_back(i);
    points.push_back({rows[i][times]["median"].get<double>(), rows[i][error].get<double>()});
  }
  const std::vector<bool> is_on_front = find_front(points);
  for (size_t i = 0; i < indices.size(); ++i) rows[indices[i]][mark] = static_cast<bool>(is_on_front[i]);
}

}  // namespace promin::report
