// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "promin/motion.h"

namespace promin {

/// Returns the longest duration of these animations in seconds; 0 if there are none.
double duration_of(const Motion& motion, const std::vector<uint32_t>& animations);

/// Returns the times of the keys of these animations in ascending order, with 0 and the duration. If there are more
/// than `most` times, returns as many times at equal distances instead.
std::vector<double> sample_times(const Motion& motion, const std::vector<uint32_t>& animations, size_t most);

/// Returns a scene that occupies the space of all poses at these times. A camera can frame it, and light can be chosen
/// for it. It has the lights, cameras and materials of the first pose. An object that moves, deforms or disappears has
/// a geometry of boxes, one for each of its poses. Other objects have their own geometry. Throws the errors of
/// scene_at().
Scene envelope_of(const Scene& scene, const std::vector<uint32_t>& animations, const std::vector<double>& times);

}  // namespace promin
