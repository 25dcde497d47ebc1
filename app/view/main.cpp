// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/run_program.h"
#include "view/view_command.h"

int main(int argc, char** argv) {
  using namespace promin::app;
  return run_program("promin-view",
                     "Shows a ray-traced scene in a window and lets you move through it. The key H lists all keys.",
                     {add_view_command}, argc, argv);
}
