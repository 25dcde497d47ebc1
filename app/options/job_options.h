// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

#include "options/arguments.h"
#include "output/work_names.h"
#include "work/spec/common_spec.h"

namespace promin::app {

/// Adds the rows of --job, --pieces and --piece. --pieces has this help and this largest value. `job` must outlive the
/// parsing.
void add_job_options(OptionTable& table, JobOptions& job, const std::string& pieces_help, uint32_t most_pieces);

}  // namespace promin::app
