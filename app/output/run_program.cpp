// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/run_program.h"

#include <fmt/format.h>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <new>
#include <system_error>
#include <vector>

#include "commands/manual.h"
#include "core/address_space.h"
#include "core/parallel.h"
#include "output/message_of.h"
#include "promin/error.h"

namespace promin::app {
namespace {

enum ExitCode { kDone = 0, kRunFailed = 1, kWrongUsage = 2, kBadInput = 3, kNoDevice = 4, kDiffers = 5 };

/// Returns a problem for a system error that has no sentence of its own.
Problem explain(const std::system_error& error) {
  std::error_code no_folder;
  static_cast<void>(std::filesystem::current_path(no_folder));
  if (no_folder == std::errc::no_such_file_or_directory) {
    return {"folder.lost", "the current folder no longer exists", "", "change to an existing folder"};
  }
  if (error.code() == std::errc::resource_unavailable_try_again) return explain_no_threads();
  const auto* file_error = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
  const std::string where = file_error == nullptr ? "" : file_error->path1().string();
  return {"system.refused", fmt::format("the system refused a request ({})", error.code().message()), where,
          "check its limits and permissions"};
}

/// Makes all threads share one heap if address space is limited, because each heap of glibc uses 64 MiB of address
/// space.
void share_heap() {
#ifdef __GLIBC__
  if (address_space_limit()) mallopt(M_ARENA_MAX, 1);
#endif
}

const Problem kDeafOutput{"output.standard.closed", "the standard output cannot be written", "",
                          "check where it is redirected"};

/// An option that only the build uses; it installs the output (app/CMakeLists.txt).
constexpr std::string_view kMakeManual = "--make-manual";

void print_manual(const CLI::App& program, const std::string& kind) {
  const std::optional<std::string> manual = make_manual(program, kind);
  if (!manual) {
    throw UsageError({"usage.option.value",
                      fmt::format("{} takes man, bash, zsh or fish, not \"{}\"", kMakeManual, kind), "",
                      "name one of them"});
  }
  fmt::print("{}", *manual);
}

}  // namespace

void run_command(const std::string& name, const std::string& help,
                 std::initializer_list<Command (*)(CLI::App& program)> add_commands, int argc,
                 const char* const* argv) {
  CLI::App program(help, name);
  program.get_formatter()->column_width(34);
  add_common_options(program);
  std::vector<Command> commands;
  for (const auto add : add_commands) commands.push_back(add(program));
  if (argc == 3 && argv[1] == kMakeManual) return print_manual(program, argv[2]);
  // A program without commands runs without arguments.
  if (argc == 1 && !commands_of(program).empty()) {
    fmt::print("{}", program.help());
    return;
  }
  if (!parse_arguments(program, argc, argv)) return;
  for (const Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  throw UsageError({"usage.command.missing", "no command is given", "", "see " + name + " --help"});
}

int run_program(const std::string& name, const std::string& help,
                std::initializer_list<Command (*)(CLI::App& program)> commands, int argc, const char* const* argv) {
  const auto report = [&](ExitCode code, const std::string& message) {
    std::fflush(stdout);
    std::fputs(fmt::format("{}: {}\n", name, message).c_str(), stderr);
    return code;
  };
  // At the file size limit (ulimit -f), this signal would end the program before it can report that and remove its
  // temporary files. If the signal is ignored, the write fails.
  std::signal(SIGXFSZ, SIG_IGN);
  share_heap();
  try {
    run_command(name, help, commands, argc, argv);
    if (std::fflush(stdout) != 0) {
      throw RunError(kDeafOutput);
    }
    return kDone;
  } catch (const UsageError& error) {
    return report(kWrongUsage, message_of(error));
  } catch (const InputError& error) {
    return report(kBadInput, message_of(error));
  } catch (const DeviceError& error) {
    return report(kNoDevice, message_of(error));
  } catch (const DifferenceError& error) {
    return report(kDiffers, message_of(error));
  } catch (const Error& error) {
    return report(kRunFailed, message_of(error));
  } catch (const std::bad_alloc&) {
    return report(kRunFailed, message_of(Problem{"host.memory.short", name + " has not enough memory", "",
                                                 cure_short_memory("use a smaller picture or scene")}));
  } catch (const std::exception& error) {
    // Printing may fail at any line with an exception of fmt.
    if (std::ferror(stdout) != 0) return report(kRunFailed, message_of(kDeafOutput));
    if (const auto* refusal = dynamic_cast<const std::system_error*>(&error)) {
      return report(kRunFailed, message_of(explain(*refusal)));
    }
    return report(kRunFailed,
                  message_of(Problem{"program.failed", fmt::format("{} failed unexpectedly ({})", name, error.what()),
                                     "", "report it as a bug"}));
  }
}

}  // namespace promin::app
