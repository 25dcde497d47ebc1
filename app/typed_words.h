// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "promin/math.h"

namespace CLI {
class App;
}

// What people type who know other programs.
namespace promin::app {

/// A command line in the words of the program's option tables: --samples becomes --spp; --width and --height, and -w
/// and -h before a number, become --size; the two numbers of --size W H become one word, and those of --eye X,Y,Z
/// become words of their own; --up Z becomes --up z. Where a program renders, the command "render" is put in before a
/// first word that is no command but a file, or an option beside a file. A first word "help" or "version" becomes an
/// option of the program or of the command that follows. All else stays as it is.
std::vector<std::string> spell_out(const CLI::App& program, const std::vector<std::string>& words);

/// The option of a command that does what another program's option of this name does; empty where none is known.
std::string find_by_meaning(const CLI::App& command, std::string_view typed);

/// The same of a program's commands.
std::string find_command_by_meaning(const CLI::App& program, std::string_view typed);

/// The size of pictures that a name as "hd" stands for.
std::optional<uvec2> find_named_size(std::string_view name);

/// Those names.
std::span<const std::string_view> size_names();

}  // namespace promin::app
