// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/scene.h"

namespace promin::work {

/// Adds a ground to a scene that has its lights and its environment: a plane that touches the scene from below,
/// with Environment::up upwards. Its material catches shadows (Unlit::catches_shadows). Does nothing if the scene has
/// no finite geometry, or if nothing lights the ground. Throws InputError as bounds_of() does.
void add_ground(Scene& scene);

/// Sets the light of the scene's last material if it is that of the ground, after lights have been switched.
void refresh_ground(Scene& scene);

}  // namespace promin::work
