// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "output/work_names.h"
#include "work/spec/cast_spec.h"

namespace CLI {
class App;
}

namespace promin::app {

/// Adds a row for each option to the command. `options` must outlive the parsing.
void add_cast_options(CLI::App& command, CastSpec& options);

}  // namespace promin::app
