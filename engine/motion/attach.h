// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "promin/camera.h"
#include "promin/lights.h"
#include "promin/math.h"

namespace promin {

/// The result of placing a light or a camera at a node.
enum class Attached {
  kDone,
  /// The node lies beyond 1e15 in the world.
  kFar,
  /// The node has no direction.
  kWithoutDirection,
};

/// Sets the position and direction of a light. It shines along -Z of its node. `rotation` is the product of the
/// rotations of the node and its ancestors, if it exists; it gives the direction of a node with a scale of 0. Sides
/// keep their lengths. The light is unchanged unless the result is kDone.
Attached attach(const dmat4& world_from_node, const std::optional<dmat3>& rotation, Light& light);

/// Does the same for a camera, which looks along -Z.
Attached attach(const dmat4& world_from_node, const std::optional<dmat3>& rotation, Camera& camera);

/// Sets the angles of a spot light's cone in radians. If the inner angle is not less than the outer one, the cone gets
/// a sharp edge, and the function returns false.
bool set_cone(double inner, double outer, Light& light);

}  // namespace promin
