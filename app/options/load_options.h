// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/load_scene.h"
#include "work/spec/common_spec.h"

namespace promin::app {

class OptionTable;

/// Adds the row of --strict, for commands that load a scene. `options` must outlive the parsing.
void add_strict_option(OptionTable& table, LoadOptions& options);
/// Adds the row of --root.
void add_root_option(OptionTable& table, LoadOptions& options);
/// Adds the rows of --time, --animation and --loop.
void add_motion_options(OptionTable& table, work::MotionOptions& options);
/// Adds the row of --variant, for commands that show materials.
void add_variant_option(OptionTable& table, LoadOptions& options);

}  // namespace promin::app
