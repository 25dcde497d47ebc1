// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/lighting.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "work/spec/render_spec.h"

namespace promin::work {

/// Returns whether the surfaces of a scene emit enough light to light others (docs/model.md, "Surfaces that emit
/// light"). Only surfaces whose radiance is above 1 in a channel count. Their light must give a white surface a
/// radiance of at least 1/256: either that of all objects, spread over a sphere around the scene, or that of one
/// object, spread over a sphere around it that contains another object. False if the lamps have more than 4 million
/// triangles. Throws InputError if a mesh lacks a position.
bool lights_itself(const Scene& scene);

/// Chooses the light for LightChoice::kAuto; other choices stay. A scene without light and sky gets LightChoice::kFill
/// if its surfaces light it strongly: they give a white surface on a sphere around the scene a radiance of at least
/// 1/32. `surface_lux` is then their illuminance, unless the choice adds other light. Emissive surfaces light nothing
/// with Integrator::kWhitted; the choice is then kStudio, and no change of the integrator changes the light. Call it
/// after a panorama has replaced the sky. Throws as lights_itself() does.
void settle_light(const Scene& scene, Integrator integrator, LookOptions& look);

/// Returns the integrator of pictures whose options name none.
Integrator usual_integrator(const Scene& scene, LightChoice light);

}  // namespace promin::work
