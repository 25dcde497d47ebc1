// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/spec_options.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <algorithm>

#include "options/arguments.h"
#include "work/spec/spec_json.h"

namespace promin::app {
namespace {

/// Returns whether a specification sets a required argument of the command.
bool gives(const RenderSpec& spec, const std::string& argument) {
  return argument == "SCENE" && !spec.tracing.scene.empty();
}
bool gives(const CastSpec& spec, const std::string& argument) {
  return (argument == "SCENE" && !spec.tracing.scene.empty()) || (argument == "RAYS.npy" && !spec.rays.empty());
}

/// Adds the row of --spec. Options are set in the order of their rows, so the later ones change the values that this
/// one reads.
template <typename Spec>
void add_option(CLI::App& command, Spec& spec) {
  OptionTable(command).add("--spec", "FILE.json",
                           "Read the options from a file that --print-spec has written, or from the standard input if "
                           "it is -. Further options override the file. Paths in the file are relative to its folder",
                           [&](const OptionValues& w) {
                             spec = read_spec<Spec>(w.text());
                             for (CLI::Option* option : command.get_options()) {
                               if (option->get_required() && gives(spec, option->get_name())) option->required(false);
                               if (option->count() > 0 && !option->get_lnames().empty()) {
                                 clear_rivals(spec, "--" + option->get_lnames().back());
                               }
                             }
                           });
}

}  // namespace

void add_spec_option(CLI::App& command, RenderSpec& spec) {
  add_option(command, spec);
}

void add_spec_option(CLI::App& command, CastSpec& spec) {
  add_option(command, spec);
}

void add_print_spec_option(CLI::App& command, bool& prints_spec) {
  OptionTable(command).add_flag(
      "--print-spec",
      "Print all options that describe the result as JSON, with absolute paths, and exit. --spec reads this output",
      prints_spec);
}

void print_spec(const RenderSpec& spec) {
  fmt::print("{}", write_spec(spec));
}

void print_spec(const CastSpec& spec) {
  fmt::print("{}", write_spec(spec));
}

}  // namespace promin::app
