// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/message_of.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

namespace promin::app {
namespace {

/// The library's words for a setting, which do not name options, and the command line's words that replace them.
struct Wording {
  Setting setting;
  std::string_view words;
  std::string_view with_option;
};

constexpr Wording kWordings[] = {{Setting::kDepth, "use a smaller depth", "lower --max-depth"},
                                 {Setting::kDevice, "another device", "another --device"},
                                 {Setting::kBuilder, "the builder", "--builder"},
                                 {Setting::kTextureMemory, "the memory for textures", "--texture-memory"}};

std::string_view option_for(Setting setting) {
  switch (setting) {
    case Setting::kNone:
      return "";
    case Setting::kDepth:
      return "--max-depth";
    case Setting::kDevice:
      return "--device";
    case Setting::kBuilder:
      return "--builder";
    case Setting::kTextureMemory:
      return "--texture-memory";
    case Setting::kInstances:
      return "--instances";
  }
  return "";
}

/// Replaces the words about the problem's setting by the command line's option. If none of the library's words occurs,
/// the option is appended to the cure, so that it is always named.
void name_option(Problem& problem) {
  if (problem.setting == Setting::kNone) return;
  bool is_named = false;
  for (const Wording& wording : kWordings) {
    if (wording.setting != problem.setting) continue;
    for (std::string* text : {&problem.where, &problem.cure}) {
      const size_t at = text->find(wording.words);
      if (at == std::string::npos) continue;
      text->replace(at, wording.words.size(), wording.with_option);
      is_named = true;
    }
  }
  if (!is_named) problem.cure += fmt::format(" ({})", option_for(problem.setting));
}

}  // namespace

std::string message_of(Problem problem) {
  name_option(problem);
  return problem.sentence();
}

std::string message_of(const Error& error) {
  std::vector<Problem> problems = error.problems();
  for (Problem& problem : problems) name_option(problem);
  return Error(problems).what();
}

}  // namespace promin::app
