// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "arguments.h"

namespace promin::report {

/// The program's own options and work.
app::Command add_report_command(CLI::App& program);

}  // namespace promin::report
