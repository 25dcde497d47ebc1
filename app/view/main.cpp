// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/run_program.h"
#include "view/view_command.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program("promin-view", "Shows a scene in a window, ray traced while you fly through it. H lists the keys.",
                     {add_view_command}, argc, argv);
}
