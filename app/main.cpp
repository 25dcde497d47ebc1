// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "cast_command.h"
#include "compare_command.h"
#include "devices_command.h"
#include "info_command.h"
#include "merge_command.h"
#include "render_command.h"
#include "run_program.h"
#include "sheet_commands.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program(
      "promin", "Renders glTF, OBJ, PLY, STL and NFF scenes to pictures, and casts rays at them; on any Vulkan device.",
      {add_render_command, add_merge_command, add_cast_command, add_compare_command, add_info_command,
       add_thumbnail_command, add_contact_sheet_command, add_devices_command},
      argc, argv);
}
