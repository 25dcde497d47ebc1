// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh_commands.h"
#include "run_program.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program("promin-bvh", "Bounding volume hierarchies in files, for promin's option --bvh.",
                     {add_build_command, add_bvh_info_command, add_verify_command}, argc, argv);
}
