// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace CLI {
class App;
}

namespace promin::app {

/// Has --help of promin end with the commonest examples, and that of its command "render" print its options in groups.
void arrange_help(CLI::App& program, CLI::App& render);

}  // namespace promin::app
