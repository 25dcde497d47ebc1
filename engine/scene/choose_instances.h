// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/instances.h"

namespace promin {

/// The largest condition of an instance's transform: max_i sum_j (|R^-1| |R|)_ij (R. D. Skeel, "Scaling for Numerical
/// Stability in Gaussian Elimination", JACM 26, 1979). Translations, rotations and scales along the mesh's own axes
/// give at most 3, whatever the scales; only shear gives more. The error bounds of hits are proportional to it.
inline constexpr double kMostInstanceCondition = 6.0;

/// Returns the condition of a transform's linear part.
double skeel_condition(const dmat4& world_from_object);

/// Returns whether an instance may have a transform: the limits of its condition and of its scales.
bool is_fit_for_instance(const dmat4& world_from_object);

/// Returns for each object of a valid scene whether it becomes an instance. The result depends on the scene alone. With
/// Instancing::kAuto, an object whose mesh other objects share becomes an instance if the mesh has at least 64
/// triangles, and if all instances of the mesh together save at least 16384. In a scene with motion this counts hidden
/// objects too, so the choice does not depend on visibility. Some objects never become instances: analytic shapes,
/// objects whose transform has a larger condition than kMostInstanceCondition or scales by more than 2^40, and meshes
/// that are farther than 8 radii from their own origin.
std::vector<bool> choose_instances(const Scene& scene, Instancing instancing);

}  // namespace promin
