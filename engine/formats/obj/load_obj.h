// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

/// Reads Wavefront OBJ and its MTL. See load_scene for what is promised. A file with vertices but no faces is refused
/// (a point cloud: there is nothing to draw); one with neither is an empty scene, with a warning.
Scene load_obj(const LoadOptions& options, LoadReport& report);

}  // namespace promin
