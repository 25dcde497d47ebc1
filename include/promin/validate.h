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

/// The largest coordinate and size in the world. validate() refuses larger ones, because fp32 would overflow.
inline constexpr double kMaxCoordinate = 1e15;
/// The smallest size in the world. validate() refuses smaller ones, because fp32 would underflow.
inline constexpr double kMinSize = 1e-22;

/// Returns all problems of a scene, each with its place ("objects[3].material") and a way to solve it; empty for a
/// valid scene. Scenes from load_scene are valid. For arrays of vertices, the function reports only the first wrong
/// element.
PROMIN_EXPORT std::vector<Problem> validate(const Scene& scene);
/// Returns all problems of these lights, each with its place and a way to solve it.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Light> lights);
/// Returns all problems of these materials, each with its place and a way to solve it.
PROMIN_EXPORT std::vector<Problem> validate(std::span<const Material> materials);
/// Returns all problems of an environment, each with its place and a way to solve it.
PROMIN_EXPORT std::vector<Problem> validate(const Environment& environment);
/// Returns all problems of a view. A problem is a rule of promin/view.h that the view breaks; render() throws
/// UsageError for such a view.
PROMIN_EXPORT std::vector<Problem> validate(const View& view);

/// Throws InputError with all problems that validate() finds; does nothing if there are none.
template <class Part>
void throw_if_invalid(const Part& part) {
  if (const std::vector<Problem> problems = validate(part); !problems.empty()) throw InputError(problems);
}

}  // namespace promin
