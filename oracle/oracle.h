// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "scene/world_scene.h"

/// The reference for checks of the renderer. It uses the formulas of the thesis in long double (64 bits of mantissa on
/// x86), by brute force over every primitive. It shares no formula with the shaders, and normalises axes itself.
namespace promin::oracle {

using Real = long double;
using Vector = glm::vec<3, Real>;

inline constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

inline Real largest(const Vector& v) {
  return std::max({v.x, v.y, v.z});
}

/// A ray with the points P(t) = origin + t * direction. The direction may have any length. A hit has tmin < t < tmax,
/// and a negative tmin counts as 0. A ray with NaN anywhere, with infinity in origin or direction, or with a direction
/// of 0 hits nothing.
struct Ray {
  Vector origin{0};
  Vector direction{0};
  Real tmin = 0;
  Real tmax = kInfinity;
};

struct Hit {
  /// Parameter of the hit in units of the ray's direction; infinite on a miss.
  Real t = kInfinity;
  /// Index into Scene::objects; -1 on a miss.
  int32_t object = -1;
  /// Index of the triangle in its object, 0 on analytic shapes; -1 on a miss.
  int32_t primitive = -1;
  /// Barycentric weights of a triangle's second and third corner; 0 on analytic shapes.
  Real u = 0;
  Real v = 0;
  /// Unit geometric normal. It follows the winding of a triangle, points out of a solid, or is a plane's own normal; it
  /// is never turned to the ray. 0 on a miss.
  Vector normal{0};

  bool exists() const { return object >= 0; }
};

/// Returns a box's axis in the world, a unit vector.
Vector axis_of(const world::Box& box, int i);

/// Returns whether a ray can hit anything at all; see Ray.
bool can_hit(const Ray& ray);

/// Rules that distinguish a ray of a picture from a cast ray.
struct Sight {
  /// True if the ray ignores the backs of triangles that their material does not show, and triangles that a mask cuts
  /// out completely. Shadow rays hit both, and pass through the second kind.
  bool passes_backs = false;
  /// The last hit that the ray has passed. The ray ignores all nearer hits, and hits at the same distance whose order
  /// is not higher.
  Hit passed{.t = -1};
};

/// Returns the nearest hit. If several hits have the same t, it is the hit with the lowest (object, primitive).
Hit find_nearest_hit(const world::Scene& scene, const Ray& ray, const Sight& sight = {});

/// Returns all crossings, sorted by t, then by (object, primitive). A solid has two crossings. If the ray hits a
/// triangle's edge or a solid's rim, each of the adjacent faces has a crossing.
std::vector<Hit> find_all_hits(const world::Scene& scene, const Ray& ray);

/// Returns the material of the hit.
const Material& material_of(const world::Scene& scene, const Hit& hit);

/// Returns whether the ray hits anything.
bool is_occluded(const world::Scene& scene, const Ray& ray);

}  // namespace promin::oracle
