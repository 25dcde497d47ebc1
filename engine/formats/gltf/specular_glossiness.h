// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

namespace promin {

/// Converts the texels of a specularGlossinessTexture (KHR_materials_pbrSpecularGlossiness: specular colour in sRGB,
/// glossiness in alpha) to texels of a metallicRoughnessTexture. Its green channel is the roughness 1 -
/// glossiness_factor * glossiness, which needs no further factor.
void take_glossiness(std::span<uint32_t> texels, double glossiness_factor);

}  // namespace promin
