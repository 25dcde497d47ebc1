// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace promin::app {

/// A group of options that --help prints under one heading: their long names, in the order of printing.
struct OptionGroup {
  std::string heading;
  std::vector<std::string> options;
};

/// Makes --help print the options of a command in groups. Options in no group come under the last heading. Names that
/// the command does not have are ignored, so that commands can share groups.
void group_options(CLI::App& command, const std::vector<OptionGroup>& groups);

/// An example: a command line and its effect.
struct Example {
  std::string_view command;
  std::string_view effect;
};

/// Adds examples to the end of --help.
void add_examples(CLI::App& command, std::initializer_list<Example> examples);

}  // namespace promin::app
