// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/suggest.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>
#include <vector>

namespace promin {
namespace {

char lower_case(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// Returns the number of letters that must be inserted, removed, replaced or swapped with the next letter (optimal
/// string alignment).
size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  std::vector<size_t> above = row;
  const auto is_same = [&](size_t i, size_t j) { return lower_case(a[i]) == lower_case(b[j]); };
  for (size_t i = 1; i <= a.size(); ++i) {
    const std::vector<size_t> two_above = std::exchange(above, row);
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({above[j - 1] + (is_same(i - 1, j - 1) ? 0 : 1), above[j] + 1, row[j - 1] + 1});
      const bool is_swap = i > 1 && j > 1 && is_same(i - 1, j - 2) && is_same(i - 2, j - 1);
      if (is_swap) row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return row[b.size()];
}

}  // namespace

std::string_view nearest_name(std::string_view typed, std::span<const std::string_view> known) {
  std::string_view nearest;
  size_t least = std::max<size_t>(1, typed.size() / 3) + 1;
  for (const std::string_view name : known) {
    const size_t distance = edit_distance(typed, name);
    if (distance < least && distance < name.size()) {
      least = distance;
      nearest = name;
    }
  }
  return nearest;
}

std::string suggest_name(std::string_view typed, std::span<const std::string_view> known) {
  const std::string_view nearest = nearest_name(typed, known);
  std::string text = "known:";
  if (!nearest.empty()) text = "did you mean \"" + std::string(nearest) + "\"? Known:";
  for (size_t i = 0; i < known.size(); ++i) text.append(i == 0 ? " " : ", ").append(known[i]);
  return text;
}

std::string list_choices(std::span<const std::string_view> names) {
  std::string list;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i > 0) list.append(i + 1 == names.size() ? " or " : ", ");
    list.append(names[i]);
  }
  return list;
}

}  // namespace promin
