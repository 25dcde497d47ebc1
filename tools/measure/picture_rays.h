// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "measure/ray_sets.h"
#include "promin/caster.h"
#include "promin/view.h"

namespace promin::measure {

/// The rays that a picture traces, by kind and bounce: "camera", "shadow 0", then "mirror 1" and "shadow 1" of the
/// first bounce, and so on. The rays of a set are in the order of pixels, and shadow rays then in the order of light
/// sources. They are made by the picture's rules from hits of `cast`, with one sample a pixel. Nearly all are the rays
/// of the picture. Secondary rays start at a fixed distance off their surface, not at its error bound; a grazing ray
/// may therefore meet something else. The figures of reports say how many rays the picture has traced.
struct PictureRays {
  /// The camera rays, and the shadow rays of the points that they hit.
  std::vector<RaySet> camera_stage;
  /// All other rays; no set is empty.
  std::vector<RaySet> mirror_stage;
};

PictureRays make_picture_rays(Caster& caster, const world::Scene& scene, const View& view);

}  // namespace promin::measure
