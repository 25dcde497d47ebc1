// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/shapes.h"
#include "promin/textures.h"

namespace promin {

/// What can be taken off the texture coordinates of a mesh without a change of what these slots show, which are all
/// that read them: near 0 fp32 tells more places apart. Each component of both sets has a whole number near its mean,
/// or 0 where no slot reads it, where the largest coordinate would not come down to half, and where a picture would
/// move: one that repeats may move by its width, a mirrored one by two, one that is clamped by nothing, each as its
/// slot's transform has it.
dvec4 find_uv_center(const Mesh& mesh, std::span<const TextureSlot> slots, std::span<const Texture> textures);

/// Subtracts `center` from all coordinates, in double.
void center_uvs(Mesh& mesh, const dvec4& center);

}  // namespace promin
