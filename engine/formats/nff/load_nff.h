// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// Reads the report's file as NFF, Eric Haines' Neutral File Format of the Standard Procedural Databases: views, point
/// sources without falloff, Phong materials, spheres, open cylinders and cones, polygons. The scene is classic. The
/// polygons after an f statement form one mesh, in file order, and each other shape is an object. Throws InputError.
Scene load_nff(const LoadOptions& options, LoadReport& report);

}  // namespace promin
