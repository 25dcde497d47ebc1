// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/materials.h"

namespace promin {

// What a material's alpha asks of a picture (docs/model.md, "Alpha").

/// Whether it is nowhere: textures and vertices make alpha smaller, never larger.
inline bool is_absent(const Material& material) {
  return material.alpha_mode == AlphaMode::kMask && material.alpha < material.alpha_cutoff;
}

/// Whether there may be nothing in places, by the factor or by textures and vertices.
inline bool has_holes(const Material& material) {
  return material.alpha_mode != AlphaMode::kOpaque;
}

/// Whether what is behind it may be seen. Of what is absent triangles are holes; other shapes blend, with alpha 0.
inline bool blends(const Material& material) {
  return material.alpha_mode == AlphaMode::kBlend || is_absent(material);
}

}  // namespace promin
