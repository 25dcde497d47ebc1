// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "promin/error.h"
#include "promin/export.h"
#include "promin/scene.h"

namespace promin {

/// Coordinates and sizes beyond this, and sizes under kMinSize, are refused (fp32 would overflow).
inline constexpr double kMaxCoordinate = 1e15;
inline constexpr double kMinSize = 1e-22;

/// Everything that is wrong with a scene built in memory, each with its place ("objects[3].material") and its cure;
/// empty for a valid one. What load_scene returns is valid. Of arrays of vertices the first wrong element is told.
PROMIN_EXPORT std::vector<Problem> validate(const Scene& scene);
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Light> lights);
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Material> materials);
PROMIN_EXPORT std::vector<Problem> validate(const Environment& environment);

/// Throws InputError with all that validate() finds, if it finds anything.
template <class Part>
void throw_if_invalid(const Part& part) {
  if (const std::vector<Problem> problems = validate(part); !problems.empty()) throw InputError(problems);
}

}  // namespace promin
