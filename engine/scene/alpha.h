// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/materials.h"

namespace promin {

// Functions for the effects of a material's alpha on a picture (docs/model.md, "Alpha").

/// Returns whether the material is absent everywhere, because textures and vertices can only reduce alpha.
inline bool is_absent(const Material& material) {
  return material.alpha_mode == AlphaMode::kMask && material.alpha < material.alpha_cutoff;
}

/// Returns whether the material may be absent in places, because of its factor, textures or vertices.
inline bool has_holes(const Material& material) {
  return material.alpha_mode != AlphaMode::kOpaque;
}

/// Returns whether surfaces behind the material may be visible. Absent triangles are holes; other absent shapes blend
/// with alpha 0.
inline bool blends(const Material& material) {
  return material.alpha_mode == AlphaMode::kBlend || is_absent(material);
}

}  // namespace promin
