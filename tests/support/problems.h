// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <string_view>

#include "promin/error.h"

namespace promin {

/// Returns the problems of an error, one on a line: "CODE WHERE: WHAT; CURE".
inline std::string list_problems(const Error& error) {
  std::string list;
  for (const Problem& problem : error.problems()) {
    if (!list.empty()) list += '\n';
    list.append(problem.code.text()).append(" ").append(problem.sentence());
  }
  return list;
}

/// Returns true if a list of list_problems has a problem of the code that is the first word of `expected`, and its
/// sentence contains each further word, such as an index.
inline bool has_problem(const std::string& list, const std::string& expected) {
  std::istringstream lines(list);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(expected);
    std::string word;
    words >> word;
    bool is_met = line.starts_with(word + " ");
    while (words >> word) is_met = is_met && line.find(word) != std::string::npos;
    if (is_met) return true;
  }
  return false;
}

MATCHER_P(HasProblem, expected, "has a problem " + std::string(expected)) {
  return has_problem(arg, std::string(expected));
}

/// Matches a call that throws an error with such a problem.
MATCHER_P(FailsWith, expected, "fails with a problem " + std::string(expected)) {
  try {
    arg();
  } catch (const Error& error) {
    *result_listener << list_problems(error);
    return has_problem(list_problems(error), std::string(expected));
  }
  return false;
}

}  // namespace promin
