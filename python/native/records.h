// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>

#include "promin/camera.h"
#include "promin/display.h"
#include "promin/environment.h"
#include "promin/image.h"
#include "promin/lights.h"
#include "promin/materials.h"
#include "promin/shapes.h"
#include "promin/view.h"
#include "scene/members.h"

namespace promin::python {

// Conversions between the library's structs and dicts of plain values: keys are the members' names, vectors are tuples,
// enumerators are their names, and an absent optional value is None. The dataclasses of promin._records have the same
// fields. Reading throws UsageError with the field's name if a value is missing or has the wrong kind.

/// Returns the index of a name in a list of names. Throws UsageError with all names if the name is not in the list;
/// `what` describes the kind of name.
size_t find_name(Names names, const std::string& name, const std::string& what);

// Returns a field that may be missing or None.
std::optional<float> read_real(const nanobind::dict& record, const std::string& name);
std::optional<uint32_t> read_whole(const nanobind::dict& record, const std::string& name);

Light read_light(const nanobind::dict& record);
nanobind::dict write(const Light& light);

/// Returns a material. The field "model" is "phong", "metallic_roughness" or "unlit"; the fields of the model are in
/// the same dict as the material's other fields.
Material read_material(const nanobind::dict& record);
nanobind::dict write(const Material& material);

Camera read_camera(const nanobind::dict& record);
nanobind::dict write(const Camera& camera);

/// Returns an environment. The field "sky" is None or a dict whose "kind" is "studio", "gradient" or "panorama". A
/// panorama has its picture in the field "image".
Environment read_environment(const nanobind::dict& record);
nanobind::dict write(const Environment& environment);

DisplayTransform read_display(const nanobind::dict& record);
nanobind::dict write(const DisplayTransform& display);

/// Returns the options for writing an EXR.
ExrOptions read_exr_options(const nanobind::dict& record);
nanobind::dict write(const ExrOptions& options);

View read_view(const nanobind::dict& record);
nanobind::dict write(const View& view);
nanobind::dict write(const ErrorTarget& target);
RenderMode read_mode(const nanobind::dict& record);

/// Returns a shape from its fields. `kind` is "sphere", "plane", "cylinder", "cone", "box" or "capsule".
Geometry read_shape(const std::string& kind, const nanobind::dict& record);

}  // namespace promin::python
