// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/motion.h"
#include "promin/scene.h"

namespace promin {

/// Returns the light of a node with its link, if it has one (KHR_lights_punctual). The extension PROMIN_lights_phong
/// makes it a classic light. The node's scale is ignored, and the light travels along the node's -Z. A light without a
/// direction, or too far away, is left out with a warning.
std::optional<LightLink> read_gltf_light(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

/// Returns the flat light of a node, if it has one (EXT_lights_area, a draft). It shines along the node's -Z, and the
/// largest scale of the node multiplies its sides. A light without a direction or beyond the limits of coordinates is
/// left out with a warning.
std::optional<LightLink> read_gltf_area_light(const GltfDocument& document, const PlacedNode& placed,
                                              LoadReport& report);

/// Sets the scene's environment from OMI_environment_sky: background and ambient light for a plain sky, or the sky for
/// a gradient or an equirectangular panorama. Without the extension only a black background is set. A panorama that
/// cannot be read causes a warning.
void read_gltf_sky(const GltfDocument& document, Scene& scene, LoadReport& report);

}  // namespace promin
