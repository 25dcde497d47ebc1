// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "promin/error.h"
#include "promin/export.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin {

/// The largest coordinate and size in the world. Larger ones are refused, because fp32 would overflow.
inline constexpr double kMaxCoordinate = 1e15;
/// The smallest size in the world. Smaller ones are refused, because fp32 would underflow.
inline constexpr double kMinSize = 1e-22;

/// Returns all problems of a scene, each with its place ("objects[3].material") and its cure; empty for a valid scene.
/// Scenes from load_scene are valid. For arrays of vertices only the first wrong element is reported.
PROMIN_EXPORT std::vector<Problem> validate(const Scene& scene);
/// Does the same for lights.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Light> lights);
/// Does the same for materials.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Material> materials);
/// Does the same for ambient light and background.
PROMIN_EXPORT std::vector<Problem> validate(const Environment& environment);
/// Returns all problems of a view: the rules of promin/view.h that it breaks, for which render() throws UsageError.
PROMIN_EXPORT std::vector<Problem> validate(const View& view);

/// Throws InputError with all problems that validate() finds, if any.
template <class Part>
void throw_if_invalid(const Part& part) {
  if (const std::vector<Problem> problems = validate(part); !problems.empty()) throw InputError(problems);
}

}  // namespace promin
