// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/scene.h"

namespace promin {

/// The largest allowed step of fp32 at a scene's coordinates, relative to the scene's longest edge.
inline constexpr double kCoarsestStep = 1e-5;

/// Bounds of all finite positions, including those of unused vertices.
struct VertexBounds {
  /// Bounds of each mesh in its own space; empty for other geometries.
  std::vector<Bounds> of_meshes;
  /// Bounds of each object in the world.
  std::vector<Bounds> of_objects;
  /// Bounds of all objects together.
  Bounds all;
};

/// Returns the bounds. Unlike bounds_of(), the function reads each vertex of a mesh once.
VertexBounds bounds_of_vertices(const Scene& scene);

/// Returns whether the steps of fp32 exceed kCoarsestStep anywhere in a box; false for an empty box.
bool is_too_coarse(const Bounds& bounds);

/// Returns the middle of a box that is not empty, rounded to a multiple of a power of two between 1/8 and 1/4 of the
/// box's longest edge. Differences to it are therefore exact in most cases.
dvec3 round_middle(const Bounds& bounds);

/// Warns if the file itself stores fp32 coordinates whose steps are too coarse for the scene, which no center can
/// repair. `is_rounded` is true if all world coordinates in the file are fp32. The coordinates of meshes in their own
/// space always are fp32.
void warn_of_coarse_coordinates(const VertexBounds& bounds, bool is_rounded, Scene& scene);

}  // namespace promin
