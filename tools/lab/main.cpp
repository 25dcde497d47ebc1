// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "lab/commands.h"
#include "output/run_program.h"

int main(int argc, char** argv) {
  using namespace promin::lab;
  return promin::app::run_program(
      "promin-lab", "Measures speed and error for the developers of promin. It is not installed.",
      {add_rates_command, add_kernels_command, add_growth_command, add_instances_command, add_robustness_command,
       add_methods_command, add_honesty_command, add_check_hits_command, add_difference_command},
      argc, argv);
}
