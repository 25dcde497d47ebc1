// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "output/work_names.h"
#include "work/spec/render_spec.h"

namespace promin::app {

class OptionTable;

/// Adds the rows of the options of a pose. `pose` must outlive the parsing.
void add_pose_options(OptionTable& table, PoseOptions& pose);

}  // namespace promin::app
