// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/oracle.h"

/// How far a device's normals may be off.
namespace promin::oracle {

/// Returns the radius of curvature of an analytic shape at a hit, in scene units; infinite for flat surfaces and
/// meshes.
Real radius_of_curvature(const world::Shape& shape, const Ray& ray, const Hit& hit);

/// Allowed |dN| of a geometric normal: 1e-6 + 16 u S / (r cos) on spheres, cylinders, cones and capsules with the
/// radius r at the hit and the angle between ray and normal, 1e-6 on planes, disks and boxes, 1e-4 on meshes.
Real allowed_normal_error(const world::Shape& shape, const Ray& ray, const Hit& hit);

}  // namespace promin::oracle
