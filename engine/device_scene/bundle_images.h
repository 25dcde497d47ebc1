// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "scene/world_scene.h"
#include "textures/pack_images.h"

namespace promin {

/// Returns bundles of images that a material shows at the same texture coordinates, with the same sampler and the same
/// size. Kernels then read them together. There are no bundles unless the materials of the scene then need at most half
/// of the look-ups. An image belongs to the first bundle that it fits in. Images of materials
/// with holes and of glass stand alone, because shadow rays look up single ones. So do images with a cutoff, of which
/// `cutoffs` has one for each image (pack_images).
std::vector<ImageBundle> find_image_bundles(const world::Scene& scene, std::span<const float> cutoffs);

}  // namespace promin
