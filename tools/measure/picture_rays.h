// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "measure/ray_sets.h"
#include "promin/caster.h"
#include "promin/view.h"

namespace promin::measure {

/// The rays that a picture takes, by kind and bounce: "camera", "shadow 0", then of each bounce "mirror 1", "shadow 1".
/// Those of one set are in the order of pixels, shadow rays source by source. They are found by the picture's rules
/// from hits of `cast`, of one sample a pixel. Nearly all are the picture's: secondary rays start at a fixed distance
/// off their surface instead of its bound, so where they graze they may meet something else. The figures of reports say
/// how many the picture has traced.
struct PictureRays {
  /// Camera rays and the shadow rays of what they hit.
  std::vector<RaySet> camera_stage;
  /// All others; no set is empty.
  std::vector<RaySet> mirror_stage;
};

PictureRays make_picture_rays(Caster& caster, const world::Scene& scene, const View& view);

}  // namespace promin::measure
