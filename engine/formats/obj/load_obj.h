// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

/// Reads Wavefront OBJ and its MTL. See load_scene for what is promised. A file is refused without a face of at least 3
/// corners: there is nothing to draw, as in point clouds.
Scene load_obj(const LoadOptions& options, LoadReport& report);

}  // namespace promin
