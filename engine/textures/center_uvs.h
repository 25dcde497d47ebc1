// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/shapes.h"
#include "promin/textures.h"

namespace promin {

/// Returns an offset that can be subtracted from the texture coordinates of a mesh without changing the appearance of
/// these slots. No other slots read the coordinates. Near 0, fp32 resolves coordinates better. Each component of both
/// sets is a whole number near the mean. A component is 0 if no slot reads it, if the largest coordinate would not be
/// halved, or if a picture would move. After its slot's transform, a repeated picture may move by its width and a
/// mirrored one by two widths; a clamped one may not move.
dvec4 find_uv_center(const Mesh& mesh, std::span<const TextureSlot> slots, std::span<const Texture> textures);

/// Subtracts `center` from all coordinates, in double.
void center_uvs(Mesh& mesh, const dvec4& center);

}  // namespace promin
