// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace promin::app {

/// Adds examples to promin's --help, and groups the options in the help of its command "render".
void arrange_help(CLI::App& program, CLI::App& render);

}  // namespace promin::app
