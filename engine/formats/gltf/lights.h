// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "formats/gltf/document.h"
#include "formats/gltf/nodes.h"
#include "promin/scene.h"

namespace promin {

/// The light a node carries (KHR_lights_punctual; PROMIN_lights_phong makes it a classic one), if it does. The node's
/// scale is ignored; the light travels along its -Z. One without a direction, or too far away, is left out with a
/// warning.
std::optional<Light> read_gltf_light(const GltfDocument& document, const PlacedNode& placed, LoadReport& report);

/// Sets the scene's surroundings from OMI_environment_sky: background and ambient light of a plain sky, the sky where
/// it is a gradient or an equirectangular panorama beside the file; a black background and nothing else without it. A
/// panorama that cannot be read is a warning.
void read_gltf_sky(const GltfDocument& document, Scene& scene, LoadReport& report);

}  // namespace promin
