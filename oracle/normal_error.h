// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "oracle/oracle.h"

/// Functions for the permitted errors of a device's normals.
namespace promin::oracle {

/// Returns the radius of curvature of an analytic shape at a hit, in scene units; infinite for flat surfaces and
/// meshes.
Real radius_of_curvature(const world::Shape& shape, const Ray& ray, const Hit& hit);

/// Returns the permitted error |dN| of a geometric normal. It is 1e-6 + 16 u S / (r cos) on spheres, cylinders, cones
/// and capsules, where r is the radius at the hit and cos the cosine between ray and normal. It is 1e-6 on planes,
/// disks and boxes, and 1e-4 on meshes.
Real allowed_normal_error(const world::Shape& shape, const Ray& ray, const Hit& hit);

}  // namespace promin::oracle
