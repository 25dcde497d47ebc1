// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/scene.h"

namespace promin {

/// Steps of fp32 at the coordinates of a scene must not be longer than this share of its size, its longest edge.
inline constexpr double kCoarsestStep = 1e-5;

/// Bounds of what is finite, unused vertices too.
struct VertexBounds {
  /// Each mesh's in its own space; empty for other geometries.
  std::vector<Bounds> of_meshes;
  /// Each object's in the world.
  std::vector<Bounds> of_objects;
  /// Those of all objects together.
  Bounds all;
};

/// Unlike bounds_of() it looks at each vertex of a mesh once.
VertexBounds bounds_of_vertices(const Scene& scene);

/// Whether steps of fp32 are coarser than kCoarsestStep somewhere in a box; not of an empty one.
bool is_too_coarse(const Bounds& bounds);

/// The middle of the box, rounded to a multiple of a power of two between 1/8 and 1/4 of its longest edge, so that
/// differences to it mostly are exact; the box is not empty.
dvec3 round_middle(const Bounds& bounds);

/// Warns where the file itself has coordinates in fp32 whose steps are too coarse for the scene: no center helps them.
/// `is_rounded`: whether all of them are fp32 in the file, in the world; those of meshes always are, in their own
/// space.
void warn_of_coarse_coordinates(const VertexBounds& bounds, bool is_rounded, Scene& scene);

}  // namespace promin
