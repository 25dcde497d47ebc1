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

/// What is made of a program's option tables beside --help, when it is built: its manual page (man(7)), or the
/// completion of its command lines for a shell. `kind` is "man", "bash", "zsh" or "fish"; nullopt for another one.
std::optional<std::string> make_manual(const CLI::App& program, std::string_view kind);

}  // namespace promin::app
