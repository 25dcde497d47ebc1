// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include "in_process.h"
#include "promin/device.h"

namespace promin::python {

/// An open device.
using OpenDevice = InProcess<gpu::DeviceHandle>;

/// Adds the class Device and the function list_devices.
void bind_device(nanobind::module_& module);

}  // namespace promin::python
