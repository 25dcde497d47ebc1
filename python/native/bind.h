// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

namespace promin::python {

// Each function adds a part of the module: one or two classes and what belongs to them. The module is private to the
// package promin, which checks and converts all arguments: here arrays have the right type, shape and order, and
// records are dicts (records.h).

/// Adds Scene and what a scene is loaded, filled, lit and framed by.
void bind_scene(nanobind::module_& module);
/// Adds Caster.
void bind_caster(nanobind::module_& module);
/// Adds Renderer.
void bind_renderer(nanobind::module_& module);
/// Adds Job, PlannedJob and Runner.
void bind_jobs(nanobind::module_& module);
/// Adds what the command line knows: choices, defaults, options, and what these make of what the user leaves open.
void bind_command_line(nanobind::module_& module);
/// Adds functions on picture files, their comparison and their display.
void bind_pictures(nanobind::module_& module);

}  // namespace promin::python
