// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "promin/motion.h"

namespace promin {

/// Returns the transform of a node to its parent.
dmat4 local_matrix(const Node& node);

/// Returns the rotation of a node to its parent; nullopt if its matrix has no rotation.
std::optional<dmat3> local_rotation(const Node& node);

/// Returns the transform from the file's world to the scene's world, whose origin is the center (Scene::center).
dmat4 world_around(const dvec3& center);

/// Returns the transform of each node to the scene, which the center moves. Transforms may overflow. The parents are
/// valid, and no node is its own ancestor.
std::vector<dmat4> place_nodes(std::span<const Node> nodes, const dvec3& center);

/// Returns the product of the rotations of a node and its ancestors, for things that have a direction but no size;
/// nullopt if one of their matrices has no rotation.
std::optional<dmat3> rotation_of(std::span<const Node> nodes, uint32_t node);

/// Returns the indices of all nodes, parents before their children.
std::vector<uint32_t> order_nodes(std::span<const Node> nodes);

}  // namespace promin
