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

/// Whether textures and vertices may say that there is nothing in places.
inline bool has_holes(const Material& material) {
  return material.alpha_mode != AlphaMode::kOpaque && !is_absent(material);
}

/// Whether what is behind it may be seen. What is absent blends, with alpha 0.
inline bool blends(const Material& material) {
  return material.alpha_mode == AlphaMode::kBlend || is_absent(material);
}

}  // namespace promin
