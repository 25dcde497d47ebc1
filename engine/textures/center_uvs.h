// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/shapes.h"
#include "promin/textures.h"

namespace promin {

/// Returns an offset that can be subtracted from the texture coordinates of a mesh without changing the appearance of
/// these slots, which are all that read them. Near 0, fp32 resolves coordinates better. Each component of both sets is
/// a whole number near the mean, or 0 in these cases: no slot reads it; the largest coordinate would not shrink to
/// half; or a picture would move. A repeated picture may move by its width, a mirrored one by two widths, a clamped one
/// not at all, each after its slot's transform.
dvec4 find_uv_center(const Mesh& mesh, std::span<const TextureSlot> slots, std::span<const Texture> textures);

/// Subtracts `center` from all coordinates, in double.
void center_uvs(Mesh& mesh, const dvec4& center);

}  // namespace promin
