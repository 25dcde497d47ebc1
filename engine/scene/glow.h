// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "promin/scene.h"

namespace promin {

/// An object whose surfaces emit light.
struct GlowingObject {
  /// The area of these surfaces, in the world.
  double area = 0.0;
  /// The sum of area times mean radiance; both sides count if both shine.
  double flux = 0.0;
  /// The sum of area times luminance of one side.
  double intensity = 0.0;
  /// The same sum with the normals as factors. It is about 0 for a closed body, and 0 for shapes.
  dvec3 facing{0.0};
  bool shines_back = false;
  dvec3 center{0.0};
};

/// The lamps of a scene, and the boxes of what they could light.
struct Glow {
  std::vector<GlowingObject> lamps;
  std::vector<Bounds> receivers;
  double flux = 0.0;
  /// The middle of the scene's box, and half of its diagonal.
  dvec3 center{0.0};
  double radius = 0.0;

  /// Returns about the illuminance in the middle of the scene, in lux. Distances are at least half the radius.
  double illuminance() const;
};

/// Returns the lamps of a scene: the objects whose surfaces have a radiance above 1 in a channel. nullopt if they light
/// nothing: if no object shines so, if there is no other object, or if they have more than 4 million triangles. Throws
/// InputError if a mesh lacks a position.
std::optional<Glow> find_glow(const Scene& scene);

}  // namespace promin
