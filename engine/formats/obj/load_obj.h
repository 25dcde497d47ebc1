// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

/// Reads a Wavefront OBJ file and its MTL files. Arguments, result and errors are as for load_scene(). A file without a
/// face of at least 3 corners, such as a point cloud, is refused, because there is nothing to draw.
Scene load_obj(const LoadOptions& options, LoadReport& report);

}  // namespace promin
