// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/App.hpp>
#include <CLI/Formatter.hpp>
#include <cstdio>
#include <new>
#include <string>
#include <vector>

#include "arguments.h"
#include "cast_command.h"
#include "core/error.h"
#include "devices_command.h"
#include "info_command.h"
#include "render_command.h"

namespace {

using namespace promin;

enum ExitCode { kDone = 0, kRunFailed = 1, kWrongUsage = 2, kBadInput = 3, kNoDevice = 4 };

void run(int argc, const char* const* argv) {
  CLI::App program(
      "Ray tracer in Vulkan compute shaders: glTF and OBJ scenes to EXR and PNG pictures, or rays to hits.", "promin");
  program.get_formatter()->column_width(34);
  app::add_common_options(program);
  const std::vector<app::Command> commands = {app::add_render_command(program), app::add_cast_command(program),
                                              app::add_info_command(program), app::add_devices_command(program)};
  if (!app::parse_arguments(program, argc, argv)) return;
  for (const app::Command& command : commands) {
    if (command.app->parsed()) return command.run();
  }
  throw UsageError({"no command given", "on the command line", "see promin --help"});
}

int report(ExitCode code, const std::string& message) {
  std::fflush(stdout);
  std::fputs(fmt::format("promin: error: {}\n", message).c_str(), stderr);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(argc, argv);
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
  } catch (const RunError& error) {
    return report(kRunFailed, error.what());
  } catch (const std::bad_alloc&) {
    return report(kRunFailed, "out of memory, in promin; render a smaller picture or scene");
  } catch (const std::exception& error) {
    return report(kRunFailed, fmt::format("unexpected failure ({}), in promin; report it as a bug", error.what()));
  }
}
