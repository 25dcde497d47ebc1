// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/motion.h"

namespace promin {

/// Returns a mesh with its morph targets, then its skin, in double with one rounding to fp32.
///
/// Target i adds weights[i] times its displacements. Weights beyond the list are 0. Alpha and colours are clamped to
/// valid values. Then, if there are `joint_matrices`, each vertex has the weighted mean of the transforms of its joints
/// (linear blend skinning). It transforms positions and tangents. Its cofactor matrix transforms normals, which are
/// then normalised. A normal that vanishes becomes 0. A mirroring transform reverses the handedness of the vertex's
/// tangent.
///
/// `joint_matrices` are the transforms of the joints times their inverse bind matrices. A mesh without influences
/// ignores them.
Mesh deform(const DeformingMesh& mesh, std::span<const double> weights, std::span<const dmat4> joint_matrices);

/// Returns whether fp32 can represent a normal's direction.
bool has_length(const dvec3& normal);

/// Removes normals and tangents from a mesh if a normal has no length. Returns whether it did.
bool drop_vanished_normals(Mesh& mesh);

}  // namespace promin
