// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

namespace promin::oracle {
namespace {

using CornerPlaces = std::array<Vector, 3>;

CornerPlaces corners_of(const Mesh& mesh, int32_t triangle) {
  const glm::uvec3& t = mesh.triangles[static_cast<size_t>(triangle)];
  return {Vector(mesh.positions[t.x]), Vector(mesh.positions[t.y]), Vector(mesh.positions[t.z])};
}

Vector normal_of(const CornerPlaces& c) {
  return glm::cross(c[1] - c[0], c[2] - c[0]);
}

struct Bound {
  int32_t primitive;

  BoundingSphere operator()(const world::NotDrawn&) const { return {}; }
  BoundingSphere operator()(const world::Sphere& s) const { return {Vector(s.center), s.radius}; }
  BoundingSphere operator()(const world::Plane& p) const { return {Vector(p.point), 0}; }
  BoundingSphere operator()(const world::Cylinder& c) const {
    return {Vector(c.center), std::hypot(Real(c.half_height), Real(c.radius))};
  }
  BoundingSphere operator()(const world::Cone& c) const {
    return {Vector(c.center), std::hypot(Real(c.half_height), Real(std::max(c.radius_bottom, c.radius_top)))};
  }
  BoundingSphere operator()(const world::Capsule& c) const {
    return {Vector(c.center), Real(c.half_height) + std::max(c.radius_bottom, c.radius_top)};
  }
  BoundingSphere operator()(const world::Box& b) const { return {Vector(b.center), glm::length(Vector(b.half_size))}; }
  BoundingSphere operator()(const Mesh& mesh) const {
    const CornerPlaces corners = corners_of(mesh, primitive);
    const Vector center = (corners[0] + corners[1] + corners[2]) / Real(3);
    Real radius = 0;
    for (const Vector& corner : corners) radius = std::max(radius, glm::distance(center, corner));
    return {center, radius};
  }
};

/// Returns a point in a box's frame relative to the corner. By symmetry, the point is moved to where no component is
/// negative. A component is positive if the point lies beyond that face.
Vector from_corner(const world::Box& box, const Vector& point) {
  const Vector from_center = point - Vector(box.center);
  Vector result;
  for (int i = 0; i < 3; ++i) result[i] = std::abs(glm::dot(from_center, axis_of(box, i))) - box.half_size[i];
  return result;
}

struct CreaseDistance {
  const Vector& point;

  template <typename Other>
  Real operator()(const Other&) const {
    return kInfinity;
  }
  Real operator()(const world::Cylinder& c) const {
    return to_rims(Vector(c.center), Vector(c.axis), c.half_height, c.radius, c.radius);
  }
  Real operator()(const world::Cone& c) const {
    return to_rims(Vector(c.center), Vector(c.axis), c.half_height, c.radius_bottom, c.radius_top);
  }

  /// Returns the distance to the edges. Each edge runs along one axis, where the faces of the other two axes meet.
  Real operator()(const world::Box& b) const {
    const Vector p = from_corner(b, point);
    Real least = kInfinity;
    for (int i = 0; i < 3; ++i) {
      Vector to_edge = p;
      to_edge[i] = std::max(p[i], Real(0));
      least = std::min(least, glm::length(to_edge));
    }
    return least;
  }

  Real to_rims(const Vector& center, const Vector& axis, Real h, Real bottom, Real top) const {
    const Vector v = glm::normalize(axis);
    const Real z = glm::dot(point - center, v);
    const Real radius = glm::length(point - center - z * v);
    return std::min(std::hypot(radius - bottom, z + h), std::hypot(radius - top, z - h));
  }
};

/// The section of a cylinder or cone in the half plane through its axis and a point. x is the distance from the axis, y
/// the coordinate along it.
struct Profile {
  Vector point;
  Vector bottom_rim;
  Vector top_rim;
  Real half_height;

  Real beyond_side() const {
    const Vector along = top_rim - bottom_rim;
    return glm::dot(point - bottom_rim, glm::normalize(Vector(along.y, -along.x, 0)));
  }
  Real beyond_ends() const { return std::abs(point.y) - half_height; }
  Real distance_to_side() const { return distance_to_segment(point, bottom_rim, top_rim); }
};

Profile profile_of(const Vector& center, const Vector& axis, Real h, Real bottom, Real top, const Vector& point) {
  const Vector v = glm::normalize(axis);
  const Real z = glm::dot(point - center, v);
  return {Vector(glm::length(point - center - z * v), z, 0), Vector(bottom, -h, 0), Vector(top, h, 0), h};
}

Profile profile_of(const world::Cylinder& c, const Vector& point) {
  return profile_of(Vector(c.center), Vector(c.axis), c.half_height, c.radius, c.radius, point);
}

Profile profile_of(const world::Cone& c, const Vector& point) {
  return profile_of(Vector(c.center), Vector(c.axis), c.half_height, c.radius_bottom, c.radius_top, point);
}

/// Returns the profile of an open shape; nullopt for other shapes.
std::optional<Profile> open_profile(const world::Shape& shape, const Vector& point) {
  return std::visit(
      [&](const auto& solid) -> std::optional<Profile> {
        if constexpr (requires { solid.is_open; }) {
          if (solid.is_open) return profile_of(solid, point);
        }
        return std::nullopt;
      },
      shape);
}

struct SignedDistance {
  int32_t primitive;
  const Vector& point;

  Real operator()(const world::NotDrawn&) const { return kInfinity; }
  Real operator()(const world::Sphere& s) const { return glm::distance(point, Vector(s.center)) - s.radius; }
  Real operator()(const world::Plane& p) const {
    return std::abs(glm::dot(point - Vector(p.point), glm::normalize(Vector(p.normal))));
  }
  Real operator()(const world::Cylinder& c) const { return frustum(profile_of(c, point)); }
  Real operator()(const world::Cone& c) const { return frustum(profile_of(c, point)); }

  /// Returns the distance to the segments of the profile. For a point inside, returns the distance to their lines.
  Real frustum(const Profile& p) const {
    const Real inside = std::max(p.beyond_side(), p.beyond_ends());
    if (inside <= 0) return inside;
    return std::min({p.distance_to_side(), distance_to_segment(p.point, Vector(0, -p.half_height, 0), p.bottom_rim),
                     distance_to_segment(p.point, Vector(0, p.half_height, 0), p.top_rim)});
  }

  /// Computes the distance in the half plane through the axis and the point. It is the distance to a sphere, or to the
  /// line that touches both, depending on where along this line the point lies.
  Real operator()(const world::Capsule& c) const {
    const Vector v = glm::normalize(Vector(c.axis));
    const Real h = 2 * Real(c.half_height);
    const Real bottom = c.radius_bottom;
    const Real top = c.radius_top;
    const Vector from_bottom = point - Vector(c.center) + h / 2 * v;
    const Real z = glm::dot(from_bottom, v);
    const Real radial = glm::length(from_bottom - z * v);
    const Real to_bottom = std::hypot(radial, z) - bottom;
    const Real to_top = std::hypot(radial, z - h) - top;
    if (std::abs(bottom - top) >= h) return bottom > top ? to_bottom : to_top;
    const Real s = (bottom - top) / h;
    const Real cosine = std::sqrt((1 - s) * (1 + s));
    const Real along = z * cosine - radial * s;
    if (along <= 0) return to_bottom;
    if (along >= h * cosine) return to_top;
    return radial * cosine + z * s - bottom;
  }

  Real operator()(const world::Box& b) const {
    const Vector p = from_corner(b, point);
    return glm::length(glm::max(p, Vector(0))) + std::min(Real(0), std::max({p.x, p.y, p.z}));
  }

  Real operator()(const Mesh& mesh) const {
    const CornerPlaces c = corners_of(mesh, primitive);
    const Vector normal = glm::normalize(normal_of(c));
    bool is_above = true;
    Real to_edges = kInfinity;
    for (size_t i = 0; i < 3; ++i) {
      const Vector& a = c[i];
      const Vector& b = c[(i + 1) % 3];
      is_above = is_above && glm::dot(glm::cross(b - a, point - a), normal) >= 0;
      to_edges = std::min(to_edges, distance_to_segment(point, a, b));
    }
    return is_above ? std::abs(glm::dot(point - c[0], normal)) : to_edges;
  }
};

}  // namespace

bool is_hittable(const world::Shape& shape, int32_t primitive) {
  if (primitive < 0 || static_cast<uint32_t>(primitive) >= primitive_count(shape)) return false;
  const Mesh* mesh = std::get_if<Mesh>(&shape);
  return mesh == nullptr || normal_of(corners_of(*mesh, primitive)) != Vector(0);
}

BoundingSphere bounding_sphere(const world::Shape& shape, int32_t primitive) {
  return std::visit(Bound{primitive}, shape);
}

Real scale_of(const world::Shape& shape, int32_t primitive, const Ray& ray) {
  const BoundingSphere bound = bounding_sphere(shape, primitive);
  return glm::distance(ray.origin, bound.center) + bound.radius;
}

Real signed_distance(const world::Shape& shape, int32_t primitive, const Vector& point) {
  return std::visit(SignedDistance{primitive, point}, shape);
}

Real surface_distance(const world::Shape& shape, int32_t primitive, const Vector& point) {
  if (const std::optional<Profile> profile = open_profile(shape, point)) return profile->distance_to_side();
  return std::abs(signed_distance(shape, primitive, point));
}

std::optional<PlaceInFrustum> place_in_open(const world::Shape& shape, const Vector& point) {
  const std::optional<Profile> profile = open_profile(shape, point);
  if (!profile) return std::nullopt;
  return PlaceInFrustum{profile->beyond_side(), profile->beyond_ends()};
}

Real distance_to_crease(const world::Shape& shape, const Vector& point) {
  return std::visit(CreaseDistance{point}, shape);
}

Real distance_to_segment(const Vector& point, const Vector& a, const Vector& b) {
  const Vector edge = b - a;
  const Real length2 = glm::dot(edge, edge);
  const Real s = length2 > 0 ? std::clamp(glm::dot(point - a, edge) / length2, Real(0), Real(1)) : Real(0);
  return glm::distance(point, a + s * edge);
}

}  // namespace promin::oracle
