// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/cast_command.h"
#include "commands/compare_command.h"
#include "commands/devices_command.h"
#include "commands/info_command.h"
#include "commands/merge_command.h"
#include "commands/render_command.h"
#include "commands/sheet_commands.h"
#include "output/run_program.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program(
      "promin",
      "Renders pictures of glTF, OBJ, PLY, STL and NFF scenes and casts rays into them. It runs on any Vulkan device.",
      {add_render_command, add_merge_command, add_cast_command, add_compare_command, add_info_command,
       add_thumbnail_command, add_contact_sheet_command, add_devices_command},
      argc, argv);
}
