// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "measure/random.h"
#include "promin/ray.h"
#include "scene/world_scene.h"

namespace promin::report {

using measure::Random;

/// Those of promin/kinds/primitives.def, in its order: "triangle", "sphere", ….
const std::vector<std::string>& primitive_names();

/// Such a primitive of about unit size at a centre, turned as it comes, as a scene of its own. Throws UsageError for
/// another name, as all of these do.
world::Scene make_primitive(const std::string& name, const dvec3& center, Random& random);
/// As many of a quarter of that size in a ball of radius 4.
world::Scene make_primitives(const std::string& name, size_t count, Random& random);

/// From `distance` at the primitive of make_primitive, up to 1.05 of its size beside its centre.
std::vector<Ray> aim_rays(const world::Scene& scene, const dvec3& center, double distance, size_t count,
                          Random& random);
/// Chords of the ball of make_primitives.
std::vector<Ray> make_chords(size_t count, Random& random);

/// A closed surface of this primitive and rays from inside it, most of them at edges, vertices and rims: each must hit.
struct Enclosure {
  world::Scene scene;
  std::vector<Ray> rays;
};
/// Empty rays for a plane, which encloses nothing.
Enclosure make_enclosure(const std::string& name, size_t ray_count, Random& random);

}  // namespace promin::report
