// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/oracle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <variant>

#include "core/rounding.h"
#include "oracle/glass.h"

namespace promin::oracle {
namespace {

bool is_finite(const Vector& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Returns the solutions of a t^2 + 2 b t + c = 0; NaN or infinite if there are fewer than two. The formula only adds
/// numbers of the same sign (Press et al., "Numerical Recipes", 5.6), which keeps both solutions accurate and works for
/// a = 0.
std::array<Real, 2> solve_quadratic(Real a, Real b, Real c) {
  constexpr Real kNone = std::numeric_limits<Real>::quiet_NaN();
  const Real discriminant = b * b - a * c;
  // The C library takes long for the root of a negative number.
  if (discriminant < 0) return {kNone, kNone};
  const Real q = -(b + std::copysign(std::sqrt(discriminant), b));
  return {q / a, c / q};
}

/// Collects the hits of one ray and keeps the nearest, or all.
class Search {
 public:
  Search(const world::Scene& scene, const Ray& ray, const Sight& sight) : scene_(scene), ray_(ray), sight_(sight) {
    ray_.tmin = std::max(Real(0), ray.tmin);
  }

  void visit(int32_t object, const world::Shape& shape) {
    object_ = object;
    std::visit([this](const auto& solid) { intersect(solid); }, shape);
  }
  const Hit& nearest() const { return nearest_; }
  void keep_all(std::vector<Hit>& hits) { all_ = &hits; }

 private:
  void offer(Real t, int32_t primitive, Real u, Real v, const Vector& normal) {
    if (!(t > ray_.tmin && t < ray_.tmax && t < nearest_.t)) return;
    const Hit hit{t, object_, primitive, u, v, glm::normalize(normal)};
    if (all_ != nullptr) {
      all_->push_back(hit);
      return;
    }
    if (!is_passed(hit)) nearest_ = hit;
  }
  bool is_passed(const Hit& hit) const {
    const Hit& passed = sight_.passed;
    if (hit.t < passed.t) return true;
    if (hit.t == passed.t && std::tie(hit.object, hit.primitive) <= std::tie(passed.object, passed.primitive)) {
      return true;
    }
    if (!sight_.passes_backs || !is_triangle()) return false;
    const Material& material = material_of(scene_, hit);
    const bool is_back = glm::dot(hit.normal, ray_.direction) > 0;
    const bool is_absent = material.alpha_mode == AlphaMode::kMask && material.alpha < material.alpha_cutoff;
    // A surface that bounds a volume of glass is also visible from inside.
    const GlassOf glass = glass_of(material);
    const bool is_one_sided = !material.is_double_sided && (!glass.is_clear || glass.is_thin);
    return is_absent || (is_back && is_one_sided);
  }
  bool is_triangle() const { return std::holds_alternative<Mesh>(scene_.objects[static_cast<size_t>(object_)].shape); }
  void offer(Real t, const Vector& normal) { offer(t, 0, 0, 0, normal); }

  void intersect(const world::NotDrawn&) {}

  /// Returns t of the ray's closest approach to `center`. Quadratics are solved relative to this point. Otherwise the
  /// square of a large distance would swamp the terms of a small solid, even in long double.
  Real approach(const Vector& center) const {
    return glm::dot(center - ray_.origin, ray_.direction) / glm::dot(ray_.direction, ray_.direction);
  }

  /// Solves |P - C|^2 = r^2.
  void intersect(const world::Sphere& sphere) {
    const Vector& d = ray_.direction;
    const Real near = approach(sphere.center);
    const Vector oc = ray_.origin - Vector(sphere.center) + near * d;
    const Real r = sphere.radius;
    for (const Real t : solve_quadratic(glm::dot(d, d), glm::dot(d, oc), glm::dot(oc, oc) - r * r)) {
      offer(near + t, oc + t * d);
    }
  }

  /// Solves (P - C) . N = 0.
  void intersect(const world::Plane& plane) {
    const Vector n(plane.normal);
    offer(glm::dot(Vector(plane.point) - ray_.origin, n) / glm::dot(ray_.direction, n), n);
  }

  void intersect(const world::Cylinder& cylinder) {
    intersect_frustum(cylinder.center, cylinder.axis, cylinder.half_height, cylinder.radius, cylinder.radius,
                      cylinder.is_open);
  }

  void intersect(const world::Cone& cone) {
    intersect_frustum(cone.center, cone.axis, cone.half_height, cone.radius_bottom, cone.radius_top, cone.is_open);
  }

  /// Solves |P - C - m V| = r + s m with m = (P - C) . V in [0, h], between two disks; s is the tangent of the half
  /// angle. With s = 0 this is the thesis' cylinder, with r = 0 its cone, whose apex is C; k = 1 + s^2. An open shape
  /// has no disks.
  void intersect_frustum(const Vector& center, const Vector& axis, Real half_height, Real bottom, Real top,
                         bool is_open) {
    const Vector w = glm::normalize(axis);
    // The axis starts at the narrow end, so that a cone is solved relative to its apex.
    const Vector v = bottom <= top ? w : -w;
    const Real h = 2 * half_height;
    const Real r = std::min(bottom, top);
    const Real s = (std::max(bottom, top) - r) / h;
    const Real k = 1 + s * s;

    const Vector& d = ray_.direction;
    const Real near = approach(center);
    const Vector oc = ray_.origin - center + near * d + half_height * v;
    const Real dv = glm::dot(d, v);
    const Real ov = glm::dot(oc, v);
    const Real a = glm::dot(d, d) - k * dv * dv;
    const Real b = glm::dot(d, oc) - k * dv * ov - s * r * dv;
    const Real c = glm::dot(oc, oc) - k * ov * ov - 2 * s * r * ov - r * r;
    for (const Real t : solve_quadratic(a, b, c)) {
      const Real m = ov + t * dv;
      if (m >= 0 && m <= h) offer(near + t, oc + t * d - (k * m + s * r) * v);
    }
    if (is_open) return;
    intersect_disk(near, oc, -v, r);
    intersect_disk(near, oc - h * v, v, r + s * h);
  }

  /// Intersects a disk. `oc` is the vector from the disk's centre to the ray's point at `near`.
  void intersect_disk(Real near, const Vector& oc, const Vector& normal, Real radius) {
    const Real t = -glm::dot(oc, normal) / glm::dot(ray_.direction, normal);
    const Vector p = oc + t * ray_.direction;
    if (radius > 0 && glm::dot(p, p) <= radius * radius) offer(near + t, normal);
  }

  /// Solves |P - C| = r for both spheres and n . (P - C) = r for the cone that touches both, each where it is a part of
  /// the hull. n is the normal of a generator, whose component along the axis is s. A point of a sphere belongs to the
  /// hull depending on the component of its own normal along the axis.
  void intersect(const world::Capsule& capsule) {
    const Vector v = glm::normalize(Vector(capsule.axis));
    const Real h = 2 * Real(capsule.half_height);
    const Real bottom = capsule.radius_bottom;
    const Real top = capsule.radius_top;
    const Real s = std::abs(bottom - top) < h ? (bottom - top) / h : (bottom < top ? -kInfinity : kInfinity);
    const Vector& d = ray_.direction;
    const Real near = approach(capsule.center);
    const Vector oc = ray_.origin - Vector(capsule.center) + near * d + h / 2 * v;
    for (const bool is_top : {false, true}) {
      const Real r = is_top ? top : bottom;
      const Vector o = is_top ? oc - h * v : oc;
      for (const Real t : solve_quadratic(glm::dot(d, d), glm::dot(d, o), glm::dot(o, o) - r * r)) {
        const Vector p = o + t * d;
        const Real along = glm::dot(p, v);
        if (r > 0 && (is_top ? along >= s * r : along <= s * r)) offer(near + t, p);
      }
    }
    if (std::isinf(s)) return;
    const Real c2 = (1 - s) * (1 + s);
    const Real dv = glm::dot(d, v);
    const Real ov = glm::dot(oc, v);
    // At the height m above the bottom's centre, the cone's radius is (r - s m) / cos.
    const Real w = bottom - s * ov;
    const Real a = glm::dot(d, d) - dv * dv - s * s * dv * dv / c2;
    const Real b = glm::dot(d, oc) - dv * ov + s * dv * w / c2;
    const Real c = glm::dot(oc, oc) - ov * ov - w * w / c2;
    for (const Real t : solve_quadratic(a, b, c)) {
      const Real m = ov + t * dv;
      const Real r = bottom - s * m;
      if (m < s * bottom || m > h + s * top || r < 0) continue;
      offer(near + t, oc + t * d - m * v + s * r / c2 * v);
    }
  }

  /// Solves |(P - C) . A| = h for each axis A, where the coordinates along the two other axes are within their limits.
  void intersect(const world::Box& box) {
    const Real near = approach(box.center);
    const Vector oc = ray_.origin - Vector(box.center) + near * ray_.direction;
    for (int i = 0; i < 3; ++i) {
      const Vector axis = axis_of(box, i);
      for (const Real side : {Real(-1), Real(1)}) {
        const Real t = (side * box.half_size[i] - glm::dot(oc, axis)) / glm::dot(ray_.direction, axis);
        const Vector p = oc + t * ray_.direction;
        bool is_within = true;
        for (const int j : {(i + 1) % 3, (i + 2) % 3}) {
          is_within = is_within && std::abs(glm::dot(p, axis_of(box, j))) <= box.half_size[j];
        }
        if (is_within) offer(near + t, side * axis);
      }
    }
  }

  void intersect(const Mesh& mesh) {
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
      const glm::uvec3& corners = mesh.triangles[i];
      intersect_triangle(static_cast<int32_t>(i), mesh.positions[corners.x], mesh.positions[corners.y],
                         mesh.positions[corners.z]);
    }
  }

  /// Intersects a triangle by the method of Möller and Trumbore. Edges belong to the triangle.
  void intersect_triangle(int32_t primitive, const Vector& corner_a, const Vector& corner_b, const Vector& corner_c) {
    const Vector t0 = ray_.origin - corner_a;
    const Vector e1 = corner_b - corner_a;
    const Vector e2 = corner_c - corner_a;
    const Vector p = glm::cross(ray_.direction, e2);
    const Real det = glm::dot(p, e1);
    if (det == 0) return;
    const Real u = glm::dot(p, t0) / det;
    if (!(u >= 0 && u <= 1)) return;  // Most triangles end here, so this test determines the time of a picture.
    const Vector q = glm::cross(t0, e1);
    const Real v = glm::dot(q, ray_.direction) / det;
    const Vector normal = glm::cross(e1, e2);
    if (v >= 0 && u + v <= 1 && normal != Vector(0)) offer(glm::dot(q, e2) / det, primitive, u, v, normal);
  }

  const world::Scene& scene_;
  Ray ray_;
  Sight sight_;
  int32_t object_ = 0;
  Hit nearest_;
  std::vector<Hit>* all_ = nullptr;
};

}  // namespace

Vector axis_of(const world::Box& box, int i) {
  // Returns a column of the rotation matrix of a unit quaternion (w, q).
  const Vector q(box.turn);
  const Real w = std::sqrt(1 - glm::dot(q, q));
  const Vector rows[] = {{1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - w * q.z), 2 * (q.x * q.z + w * q.y)},
                         {2 * (q.x * q.y + w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - w * q.x)},
                         {2 * (q.x * q.z - w * q.y), 2 * (q.y * q.z + w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)}};
  return {rows[0][i], rows[1][i], rows[2][i]};
}

bool can_hit(const Ray& ray) {
  return is_finite(ray.origin) && is_finite(ray.direction) && ray.direction != Vector(0) && ray.tmin < ray.tmax;
}

Hit find_nearest_hit(const world::Scene& scene, const Ray& ray, const Sight& sight) {
  if (!can_hit(ray)) return {};
  Search search(scene, ray, sight);
  for (size_t i = 0; i < scene.objects.size(); ++i) search.visit(static_cast<int32_t>(i), scene.objects[i].shape);
  return search.nearest();
}

std::vector<Hit> find_all_hits(const world::Scene& scene, const Ray& ray) {
  std::vector<Hit> hits;
  if (!can_hit(ray)) return hits;
  Search search(scene, ray, {});
  search.keep_all(hits);
  for (size_t i = 0; i < scene.objects.size(); ++i) search.visit(static_cast<int32_t>(i), scene.objects[i].shape);
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
    return std::tie(a.t, a.object, a.primitive) < std::tie(b.t, b.object, b.primitive);
  });
  return hits;
}

const Material& material_of(const world::Scene& scene, const Hit& hit) {
  const world::Object& object = scene.objects[static_cast<size_t>(hit.object)];
  const Mesh* mesh = std::get_if<Mesh>(&object.shape);
  const bool is_of_object = mesh == nullptr || mesh->triangle_materials.empty();
  return scene.materials[is_of_object ? object.material : mesh->triangle_materials[static_cast<size_t>(hit.primitive)]];
}

bool is_occluded(const world::Scene& scene, const Ray& ray) {
  return find_nearest_hit(scene, ray).exists();
}

}  // namespace promin::oracle
