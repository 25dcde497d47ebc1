// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace CLI {
class App;
}

namespace promin::app {

/// Returns a text generated from a program's option tables at build time: its manual page (man(7)), or the command-line
/// completion for a shell. `kind` is "man", "bash", "zsh" or "fish"; for other kinds the result is nullopt.
std::optional<std::string> make_manual(const CLI::App& program, std::string_view kind);

}  // namespace promin::app
