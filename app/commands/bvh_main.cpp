// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/bvh_commands.h"
#include "output/run_program.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program("promin-bvh",
                     "Builds, describes and checks files of bounding volume hierarchies (BVHs). The option --bvh of "
                     "promin reads them.",
                     {add_build_command, add_bvh_info_command, add_verify_command}, argc, argv);
}
