// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "promin/motion.h"

namespace promin {

/// Sets the properties of lights, cameras and materials to the values of a pose. Values out of range are clamped. The
/// function does not change other lights, cameras and materials. Scene::motion is valid.
void apply_values(std::span<const Pose::Value> values, Scene& scene);

}  // namespace promin
