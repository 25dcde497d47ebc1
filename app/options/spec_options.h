// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "output/work_names.h"
#include "work/spec/cast_spec.h"
#include "work/spec/render_spec.h"

namespace CLI {
class App;
}

namespace promin::app {

/// Adds the row of --spec, whose file the other options of the command override. It must be the first row of the
/// command. `spec` must outlive the parsing.
void add_spec_option(CLI::App& command, RenderSpec& spec);
void add_spec_option(CLI::App& command, CastSpec& spec);

/// Adds the row of --print-spec, for the commands of the program.
void add_print_spec_option(CLI::App& command, bool& prints_spec);

/// Prints a specification on the standard output.
void print_spec(const RenderSpec& spec);
void print_spec(const CastSpec& spec);

}  // namespace promin::app
