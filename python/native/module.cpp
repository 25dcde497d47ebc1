// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <nanobind/nanobind.h>

#include "bind.h"
#include "device.h"
#include "errors.h"

namespace nb = nanobind;

NB_MODULE(_promin, module) {
  // Objects that are alive at the end of the process are not leaks.
  nb::set_leak_warnings(false);
  module.attr("__version__") = PROMIN_VERSION;
  promin::python::register_errors();
  promin::python::bind_device(module);
  promin::python::bind_scene(module);
  promin::python::bind_caster(module);
  promin::python::bind_renderer(module);
  promin::python::bind_jobs(module);
  promin::python::bind_command_line(module);
  promin::python::bind_pictures(module);
}
