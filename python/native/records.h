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

// The library's structs as dicts of plain values and back: keys are the members' names, vectors are tuples, enumerators
// are their names, what may be missing is None. The dataclasses of promin._records have the same fields. Reading throws
// UsageError where a value is missing or none of the right kind, with the field's name.

/// The place of a name among others; throws UsageError with all of them, which says what there is none of.
size_t find_name(Names names, const std::string& name, const std::string& what);

// A field that may be missing or None.
std::optional<float> read_real(const nanobind::dict& record, const std::string& name);
std::optional<uint32_t> read_whole(const nanobind::dict& record, const std::string& name);

Light read_light(const nanobind::dict& record);
nanobind::dict write(const Light& light);

/// "model" is "phong", "metallic_roughness" or "unlit", whose fields stand beside the material's own.
Material read_material(const nanobind::dict& record);
nanobind::dict write(const Material& material);

Camera read_camera(const nanobind::dict& record);
nanobind::dict write(const Camera& camera);

/// "sky" is None or a dict whose "kind" is "studio", "gradient" or "panorama"; the latter has its picture as "image".
Environment read_environment(const nanobind::dict& record);
nanobind::dict write(const Environment& environment);

DisplayTransform read_display(const nanobind::dict& record);
nanobind::dict write(const DisplayTransform& display);

/// How an EXR is kept.
ExrOptions read_exr_options(const nanobind::dict& record);
nanobind::dict write(const ExrOptions& options);

View read_view(const nanobind::dict& record);
nanobind::dict write(const View& view);
nanobind::dict write(const ErrorTarget& target);
RenderMode read_mode(const nanobind::dict& record);

/// One of "sphere", "plane", "cylinder", "cone", "box" and "capsule" by its fields.
Geometry read_shape(const std::string& kind, const nanobind::dict& record);

}  // namespace promin::python
