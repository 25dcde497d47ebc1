// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/help.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <memory>

namespace promin::app {
namespace {

/// Prints options by groups, regardless of the order in which they were added.
class GroupFormatter : public CLI::Formatter {
 public:
  GroupFormatter(const CLI::Formatter& like, std::vector<OptionGroup> groups)
      : CLI::Formatter(like), groups_(std::move(groups)) {}

  std::string make_help(const CLI::App* app, std::string name, CLI::AppFormatMode /*mode*/) const override {
    return make_description(app) + make_usage(app, std::move(name)) + make_positionals(app) + make_own_groups(*app) +
           "\n" + make_footer(app);
  }

 private:
  std::string make_own_groups(const CLI::App& app) const {
    const auto is_option = [](const CLI::Option* each) { return each->nonpositional() && !each->get_group().empty(); };
    std::vector<const CLI::Option*> left = app.get_options(is_option);
    std::string text;
    for (const OptionGroup& group : groups_) {
      std::vector<const CLI::Option*> options;
      for (const std::string& name : group.options) {
        const auto found = std::ranges::find_if(left, [&](const CLI::Option* each) { return each->check_lname(name); });
        if (found == left.end()) continue;
        options.push_back(*found);
        left.erase(found);
      }
      if (&group == &groups_.back()) options.insert(options.end(), left.begin(), left.end());
      if (!options.empty()) text += make_group(group.heading, false, options);
    }
    return text;
  }

  std::vector<OptionGroup> groups_;
};

}  // namespace

void group_options(CLI::App& command, const std::vector<OptionGroup>& groups) {
  const auto& like = dynamic_cast<const CLI::Formatter&>(*command.get_formatter());
  command.formatter(std::make_shared<GroupFormatter>(like, groups));
}

void add_examples(CLI::App& command, std::initializer_list<Example> examples) {
  std::string text = "Examples:";
  for (const Example& each : examples) text += fmt::format("\n  {}\n      {}", each.command, each.effect);
  command.footer(text);
}

}  // namespace promin::app
