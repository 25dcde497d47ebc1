// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

// Translates words that users of other programs may type.
namespace promin::app {

/// Returns a command line in the words of the program's option tables. --samples becomes --spp. --width and --height,
/// and -w and -h before a number, become --size. The two numbers of --size W H become one word, and the numbers of
/// --eye X,Y,Z become separate words. --up Z becomes --up z. --animation 0 1 becomes
/// --animation 0 --animation 1. If the program can render, and the first word is a file or
/// an option beside a file, the command "render" is put before it. A first word "help" or "version" becomes an option
/// of the program or of the command that follows. All other words stay the same.
std::vector<std::string> spell_out(const CLI::App& program, const std::vector<std::string>& words);

/// Returns the option of a command that corresponds to another program's option of this name; empty if none is known.
std::string find_by_meaning(const CLI::App& command, std::string_view typed);

/// Returns the command of a program that corresponds to another program's command of this name; empty if none is known.
std::string find_command_by_meaning(const CLI::App& program, std::string_view typed);

}  // namespace promin::app
