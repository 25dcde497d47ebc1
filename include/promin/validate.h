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

/// Coordinates and sizes in the world beyond this are refused, because fp32 would overflow.
inline constexpr double kMaxCoordinate = 1e15;
/// Sizes in the world under this are refused, because fp32 would underflow.
inline constexpr double kMinSize = 1e-22;

/// Everything that is wrong with a scene built in memory, each with its place ("objects[3].material") and its cure;
/// empty for a valid one. What load_scene returns is valid. Of arrays of vertices the first wrong element is told.
PROMIN_EXPORT std::vector<Problem> validate(const Scene& scene);
/// The same of lights alone.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Light> lights);
/// The same of materials alone.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Material> materials);
/// The same of ambient light and background alone.
PROMIN_EXPORT std::vector<Problem> validate(const Environment& environment);
/// Everything in which a view breaks the rules of promin/view.h: what render() throws UsageError for.
PROMIN_EXPORT std::vector<Problem> validate(const View& view);

/// Throws InputError with all that validate() finds, if it finds anything.
template <class Part>
void throw_if_invalid(const Part& part) {
  if (const std::vector<Problem> problems = validate(part); !problems.empty()) throw InputError(problems);
}

}  // namespace promin
