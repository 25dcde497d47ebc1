// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device.h"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "promin/device_info.h"
#include "watched.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

nb::dict describe_device(const gpu::DeviceInfo& info) {
  nb::dict result;
  result["index"] = info.index;
  result["name"] = info.name;
  result["type"] = info.type;
  result["driver"] = info.driver;
  result["uuid"] = info.uuid;
  result["api_version"] = info.api_version;
  result["obstacles"] = nb::tuple(nb::cast(info.obstacles));
  result["lacks"] = nb::tuple(nb::cast(info.lacks));
  result["is_default"] = info.is_default;
  return result;
}

std::shared_ptr<OpenDevice> open(const std::optional<std::string>& selection, bool keeps_kernels) {
  gpu::DeviceHandle handle;
  run_watched(nb::none(), [&](const ProgressCallback&) { handle = gpu::open_device(selection, keeps_kernels); });
  return std::make_shared<OpenDevice>(std::move(handle));
}

}  // namespace

void bind_device(nb::module_& module) {
  nb::class_<OpenDevice>(module, "Device")
      .def_static("open", &open, nb::arg("selection").none(), nb::arg("keeps_kernels"))
      .def("info", [](const OpenDevice& device) { return describe_device(gpu::info_of(device.get())); })
      .def("choice", [](const OpenDevice& device) { return gpu::choice_of(device.get()); });
  module.def("list_devices", [] {
    nb::list result;
    for (const gpu::DeviceInfo& info : gpu::list_devices()) result.append(describe_device(info));
    return result;
  });
}

}  // namespace promin::python
