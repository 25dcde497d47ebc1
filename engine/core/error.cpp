// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/error.h"

#include "core/utf8.h"

namespace promin {
namespace {

std::string join_sentences(const std::vector<Problem>& problems) {
  if (problems.empty()) return "the failure is unknown";
  std::string text = problems.front().sentence();
  if (problems.size() > 1) text += " (1 of " + std::to_string(problems.size()) + " problems)";
  for (size_t i = 1; i < problems.size(); ++i) text += "\n  " + problems[i].sentence();
  return text;
}

}  // namespace

std::string Problem::sentence() const {
  std::string text = where.empty() ? what : where + ": " + what;
  if (!cure.empty()) text += "; " + cure;
  return to_one_line(to_utf8(text));
}

Error::Error(const std::vector<Problem>& problems)
    : std::runtime_error(join_sentences(problems)), problems_(problems) {}

}  // namespace promin
