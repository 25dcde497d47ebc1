// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace promin::python {

// Each function adds a part of the module: one or two classes and their helpers. The module is private to the package
// promin. The package checks and converts all arguments, so here arrays have the right type, shape and order, and
// records are dicts (records.h).

/// Adds the class Scene and functions that load, fill, light and frame a scene.
void bind_scene(nanobind::module_& module);
/// Adds the class Caster.
void bind_caster(nanobind::module_& module);
/// Adds the class Renderer.
void bind_renderer(nanobind::module_& module);
/// Adds the classes Job, PlannedJob and Runner.
void bind_jobs(nanobind::module_& module);
/// Adds the tables of the command line (choices, defaults, options) and functions that choose values for settings that
/// the user leaves open.
void bind_command_line(nanobind::module_& module);
/// Adds functions for picture files, their comparison and their display.
void bind_pictures(nanobind::module_& module);

}  // namespace promin::python
