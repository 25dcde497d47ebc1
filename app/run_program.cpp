// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "run_program.h"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <cstdio>
#include <new>
#include <vector>

#include "promin/error.h"

namespace promin::app {
namespace {

enum ExitCode { kDone = 0, kRunFailed = 1, kWrongUsage = 2, kBadInput = 3, kNoDevice = 4 };

/// Names the options of this command line in a message of the library, which knows none.
std::string name_options(std::string message) {
  constexpr std::pair<std::string_view, std::string_view> kOptions[] = {
      {"asked for as the device", "asked for by --device"},
      {"take a smaller depth or another device", "lower --max-depth or take another device"},
      {"take a smaller depth", "lower --max-depth"},
      {"with so many bounces", "with its --max-depth"},
      {"or another device", "or another --device"},
      {"try another device", "try another --device"},
      {"take the builder sah", "take --builder sah"},
  };
  for (const auto& [words, with_option] : kOptions) {
    const size_t at = message.find(words);
    if (at == std::string::npos || message.find(with_option) != std::string::npos) continue;
    message.replace(at, words.size(), with_option);
    break;
  }
  return message;
}

void run_command(const std::string& name, const std::string& help,
                 std::initializer_list<Command (*)(CLI::App& program)> add_commands, int argc,
                 const char* const* argv) {
  CLI::App program(help, name);
  program.get_formatter()->column_width(34);
  add_common_options(program);
  std::vector<Command> commands;
  for (const auto add : add_commands) commands.push_back(add(program));
  if (!parse_arguments(program, argc, argv)) return;
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  throw UsageError({"no command given", "on the command line", "see " + name + " --help"});
}

}  // namespace

int run_program(const std::string& name, const std::string& help,
                std::initializer_list<Command (*)(CLI::App& program)> commands, int argc, const char* const* argv) {
  const auto report = [&](ExitCode code, const std::string& message) {
    std::fflush(stdout);
    std::fputs(fmt::format("{}: error: {}\n", name, name_options(message)).c_str(), stderr);
    return code;
  };
  // At the file size limit (ulimit -f) this signal would end the program before it can say so and remove its temporary
  // files; where it is ignored, the write fails.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    run_command(name, help, commands, argc, argv);
    if (std::fflush(stdout) != 0) {
      throw RunError({"cannot write", "the standard output", "check where it leads"});
    }
    return kDone;
  } catch (const UsageError& error) {
    return report(kWrongUsage, error.what());
  } catch (const InputError& error) {
    return report(kBadInput, error.what());
  } catch (const DeviceError& error) {
    return report(kNoDevice, error.what());
  } catch (const Error& error) {
    return report(kRunFailed, error.what());
  } catch (const std::bad_alloc&) {
    return report(kRunFailed, fmt::format("out of memory, in {}; use a smaller picture or scene", name));
  } catch (const std::exception& error) {
    return report(kRunFailed, fmt::format("unexpected failure ({}), in {}; report it as a bug", error.what(), name));
  }
}

}  // namespace promin::app
