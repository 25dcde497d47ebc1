// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <string>

#include "options/arguments.h"

namespace promin::app {

/// The main() of a program of commands: reads the command line, runs the command and returns the exit code. A failure
/// is printed as one line on the standard error stream, "NAME: WHERE: WHAT; CURE", with an indented line for each
/// further problem. SIGXFSZ is ignored from here on, so that exceeding the file size limit is also such a failure.
int run_program(const std::string& name, const std::string& help,
                std::initializer_list<Command (*)(CLI::App& program)> commands, int argc, const char* const* argv);

/// Reads the command line and runs the command. Throws the command's exceptions, and UsageError if there is no command.
void run_command(const std::string& name, const std::string& help,
                 std::initializer_list<Command (*)(CLI::App& program)> add_commands, int argc, const char* const* argv);

}  // namespace promin::app
