// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "output/run_program.h"

// The commands of promin-lab. Each adds its own options and returns its work.
namespace promin::lab {

app::Command add_rates_command(CLI::App& program);
app::Command add_kernels_command(CLI::App& program);
app::Command add_growth_command(CLI::App& program);
app::Command add_instances_command(CLI::App& program);
app::Command add_robustness_command(CLI::App& program);
app::Command add_methods_command(CLI::App& program);
app::Command add_honesty_command(CLI::App& program);
app::Command add_check_hits_command(CLI::App& program);
app::Command add_difference_command(CLI::App& program);

}  // namespace promin::lab
