// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/emitters.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "scene/glass.h"
#include "scene/light_kinds.h"

namespace promin::oracle {
namespace {

constexpr Real kLampPi = std::numbers::pi_v<Real>;

/// The solid angles between which directions to a triangle have a uniform density, and the share of all elements that
/// does not depend on their flux.
constexpr Real kLeastAngle = 1.0L / 256;
constexpr Real kLargestAngle = 6;
constexpr Real kEvenShare = 1.0L / 64;

constexpr size_t kMostAsked = 16;

Real mean_of(const vec3& color) {
  return (Real(color.x) + Real(color.y) + Real(color.z)) / 3;
}

std::array<Vector, 3> lamp_corners(const Mesh& mesh, int32_t triangle) {
  const glm::uvec3 corners = mesh.triangles[static_cast<size_t>(triangle)];
  return {Vector(mesh.positions[corners.x]), Vector(mesh.positions[corners.y]), Vector(mesh.positions[corners.z])};
}

/// Returns the distance to which lights without a place shine: from the middle of the box of all triangles and solids.
Real radius_of(const world::Scene& scene) {
  const Bounds box = world::bounds_of(scene);
  if (box.is_empty()) return 1;
  const Vector half = (Vector(box.hi) - Vector(box.lo)) / Real(2);
  return largest(half);
}

Real flux_of(const Light& light, Real scene_radius) {
  const Real power = (mean_of(light.diffuse) + mean_of(light.specular)) / 2;
  switch (light.kind) {
    case LightKind::kRect:
      return power * light.size.x * light.size.y;
    case LightKind::kDisk:
      return power * kLampPi * light.size.x * light.size.y / 4;
    case LightKind::kDirectional:
    case LightKind::kHeadlight:
      return power * scene_radius * scene_radius;
    case LightKind::kPoint:
    case LightKind::kSpot:
      break;
  }
  if (light.attenuation == Attenuation::kNone) return power * scene_radius * scene_radius;
  const Real solid_angle =
      light.kind == LightKind::kSpot ? 2 * kLampPi * (1 - std::cos(Real(light.outer_cone_angle))) : 4 * kLampPi;
  return power * solid_angle / kLampPi;
}

Real angle_between(const Vector& a, const Vector& b) {
  return 2 * std::asin(std::min(glm::distance(glm::normalize(a), glm::normalize(b)) / 2, Real(1)));
}

/// Returns the point of the arc between two unit vectors at an angle from the first.
Vector on_arc(const Vector& from, const Vector& to, Real angle) {
  const Vector across = glm::normalize(to - glm::dot(from, to) * from);
  return std::cos(angle) * from + std::sin(angle) * across;
}

/// Returns the direction to a triangle: the arc from its second corner to a point q of the opposite side cuts off the
/// part u[0] of its solid angle, and the cosine to the second corner is uniform along the arc.
Vector direction_to(const std::array<Vector, 3>& corners, const std::array<Real, 2>& u) {
  const Vector a = glm::normalize(corners[0]);
  const Vector b = glm::normalize(corners[1]);
  const Vector c = glm::normalize(corners[2]);
  const Real whole = solid_angle_of({a, b, c});
  Real lo = 0;
  Real hi = angle_between(a, c);
  for (int step = 0; step < 80; ++step) {
    const Real middle = (lo + hi) / 2;
    (solid_angle_of({a, b, on_arc(a, c, middle)}) < u[0] * whole ? lo : hi) = middle;
  }
  const Vector q = on_arc(a, c, (lo + hi) / 2);
  const Real half = std::sin(angle_between(b, q) / 2);
  return on_arc(b, q, 2 * std::asin(half * std::sqrt(u[1])));
}

LampPoint sample_triangle(const std::array<Vector, 3>& corners, const Vector& position, const std::array<Real, 2>& u) {
  LampPoint lamp;
  const std::array<Vector, 3> seen = {corners[0] - position, corners[1] - position, corners[2] - position};
  const Vector edge1 = corners[1] - corners[0];
  const Vector edge2 = corners[2] - corners[0];
  const Vector product = glm::cross(edge1, edge2);
  lamp.normal = glm::normalize(product);
  const Real height = -glm::dot(lamp.normal, seen[0]);
  const Real solid_angle = solid_angle_of(seen);
  if (solid_angle < kLeastAngle) {
    // Half of the square is pushed to one side of its diagonal.
    const Real less = std::min(u[0], u[1]) / 2;
    lamp.u = u[0] < u[1] ? less : u[0] - less;
    lamp.v = u[0] < u[1] ? u[1] - less : less;
    lamp.place = corners[0] + lamp.u * edge1 + lamp.v * edge2;
    const Real distance = glm::distance(lamp.place, position);
    lamp.inverse_density = glm::length(product) / 2 * std::abs(height) / std::pow(distance, Real(3));
    return lamp;
  }
  const bool is_wide = solid_angle > kLargestAngle;
  const Vector direction =
      is_wide ? place_in_cone(height > 0 ? -lamp.normal : lamp.normal, kLampPi / 2, u) : direction_to(seen, u);
  lamp.place = position - height / glm::dot(direction, lamp.normal) * direction;
  const Vector from = lamp.place - corners[0];
  lamp.u = glm::dot(glm::cross(from, edge2), lamp.normal) / glm::length(product);
  lamp.v = glm::dot(glm::cross(edge1, from), lamp.normal) / glm::length(product);
  const bool is_inside = lamp.u >= 0 && lamp.v >= 0 && lamp.u + lamp.v <= 1;
  lamp.inverse_density = is_wide ? (is_inside ? 2 * kLampPi : 0) : solid_angle;
  return lamp;
}

/// Returns the solid angle of a rectangle from a corner of which the perpendicular to the point has the length z.
Real solid_angle_of_corner(Real x, Real y, Real z) {
  return std::atan2(x * y, z * std::sqrt(x * x + y * y + z * z));
}

/// Returns a rectangle of two triangles with a common side if they form one up to 2^-20 and turn the same way.
std::optional<std::array<Vector, 3>> rectangle_of(const std::array<Vector, 3>& first,
                                                  const std::array<Vector, 3>& second) {
  constexpr Real kDoubt = 0x1p-20L;
  for (size_t i = 0; i < 3; ++i) {
    const Vector& corner = first[i];
    const Vector& next = first[(i + 1) % 3];
    const Vector& last = first[(i + 2) % 3];
    if (std::abs(glm::dot(next - corner, last - corner)) >
        kDoubt * glm::distance(next, corner) * glm::distance(last, corner)) {
      continue;
    }
    const auto [shorter, longer] = std::minmax({glm::distance(next, corner), glm::distance(last, corner)});
    const Real doubt = kDoubt * std::min(longer, 16 * shorter);
    for (size_t j = 0; j < 3; ++j) {
      // The corner that the triangles do not share.
      const bool shares_diagonal = second[(j + 1) % 3] == last && second[(j + 2) % 3] == next;
      if (shares_diagonal && glm::distance(second[j] - next, last - corner) <= doubt) {
        return std::array{corner, next, last};
      }
    }
  }
  return std::nullopt;
}

LampPoint sample_rectangle(const std::array<Vector, 3>& corners, const Vector& position, const std::array<Real, 2>& u) {
  const Vector side1 = corners[1] - corners[0];
  const Vector side2 = corners[2] - corners[0];
  const Vector normal = glm::normalize(glm::cross(side1, side2));
  const Vector right = glm::normalize(side1);
  // It is sampled as a light that shines to the side of the point.
  const bool is_in_front = glm::dot(normal, position - corners[0]) > 0;
  const Vector up = glm::cross(is_in_front ? normal : -normal, right);
  LampPoint lamp = sample_flat({.center = corners[0] + (side1 + side2) / Real(2),
                                .right = right,
                                .up = up,
                                .half = {glm::length(side1) / 2, glm::length(side2) / 2}},
                               position, u);
  lamp.normal = normal;
  return lamp;
}

LampPoint sample_sphere(const world::Sphere& sphere, const Vector& position, const Vector& facing,
                        const std::array<Real, 2>& u) {
  LampPoint lamp;
  const Vector to_center = Vector(sphere.center) - position;
  const Real distance = glm::length(to_center);
  const Real radius = sphere.radius;
  // A point of the sphere itself is on the side of its normal. The sphere does not light its own outside.
  const bool is_on = std::abs(distance - radius) < 1e-6L * radius;
  const bool is_inside = is_on ? glm::dot(facing, to_center) > 0 : distance < radius;
  const Real half_angle = is_inside ? kLampPi : std::asin(std::min(radius / distance, Real(1)));
  const Vector direction = place_in_cone(distance > 0 ? to_center / distance : Vector(0, 0, 1), half_angle, u);
  const Real along = glm::dot(to_center, direction);
  const Real aside = glm::length(glm::cross(to_center, direction));
  const Real half_chord = std::sqrt(std::max((radius - aside) * (radius + aside), Real(0)));
  lamp.place = position + (is_inside ? along + half_chord : along - half_chord) * direction;
  lamp.normal = glm::normalize(lamp.place - Vector(sphere.center));
  if (is_on && (!is_inside || glm::dot(facing, direction) <= 0)) return lamp;
  lamp.inverse_density = 4 * kLampPi * std::sin(half_angle / 2) * std::sin(half_angle / 2);
  return lamp;
}

/// Returns the direction at an angle about a unit axis, for a number from 0 to 1.
Vector direction_about(const Vector& axis, Real u) {
  const Vector helper = std::abs(axis.x) < 0.57L ? Vector(1, 0, 0) : Vector(0, 1, 0);
  const Vector across = glm::normalize(glm::cross(axis, helper));
  const Real angle = 2 * kLampPi * u - kLampPi;
  return std::cos(angle) * across + std::sin(angle) * glm::cross(axis, across);
}

/// A frustum between two places on its axis.
struct Frustum {
  Vector bottom{0};
  Vector top{0};
  Real radius_bottom = 0;
  Real radius_top = 0;
};

/// Returns the place and the normal at a point of the unit square, which is uniform over the area of the part.
LampPoint sample_frustum(const Frustum& f, uint32_t part, const std::array<Real, 2>& u) {
  LampPoint lamp;
  const Vector axis = glm::normalize(f.top - f.bottom);
  const Vector out = direction_about(axis, u[1]);
  if (part > 0) {
    lamp.place =
        part == 2 ? f.top + f.radius_top * std::sqrt(u[0]) * out : f.bottom + f.radius_bottom * std::sqrt(u[0]) * out;
    lamp.normal = part == 2 ? axis : -axis;
    return lamp;
  }
  // The area from the bottom up to a share s of the height is in proportion to the integral of the radius.
  const auto area_to = [&](Real s) { return f.radius_bottom * s + (f.radius_top - f.radius_bottom) * s * s / 2; };
  Real lo = 0;
  Real hi = 1;
  for (int step = 0; step < 80; ++step) (area_to((lo + hi) / 2) < u[0] * area_to(1) ? lo : hi) = (lo + hi) / 2;
  const Real radius = std::lerp(f.radius_bottom, f.radius_top, lo);
  lamp.place = f.bottom + lo * (f.top - f.bottom) + radius * out;
  const Real slope = (f.radius_top - f.radius_bottom) / glm::distance(f.top, f.bottom);
  lamp.normal = glm::normalize(out - slope * axis);
  return lamp;
}

LampPoint sample_part(const world::Box& box, uint32_t part, const std::array<Real, 2>& u) {
  const int axis = static_cast<int>(part / 2);
  const Real side = part % 2 == 0 ? -1 : 1;
  LampPoint lamp;
  lamp.normal = side * axis_of(box, axis);
  lamp.place = Vector(box.center) + Real(box.half_size[axis]) * lamp.normal;
  // The first coordinate belongs to the next axis, except that for y it belongs to z.
  const int first = axis == 0 ? 1 : (axis == 1 ? 2 : 0);
  const int second = axis == 0 ? 2 : (axis == 1 ? 0 : 1);
  lamp.place += (2 * u[0] - 1) * Real(box.half_size[first]) * axis_of(box, first);
  lamp.place += (2 * u[1] - 1) * Real(box.half_size[second]) * axis_of(box, second);
  return lamp;
}
LampPoint sample_part(const world::Cylinder& c, uint32_t part, const std::array<Real, 2>& u) {
  const Vector up = Real(c.half_height) * glm::normalize(Vector(c.axis));
  return sample_frustum({Vector(c.center) - up, Vector(c.center) + up, c.radius, c.radius}, part, u);
}
LampPoint sample_part(const world::Cone& c, uint32_t part, const std::array<Real, 2>& u) {
  const Vector up = Real(c.half_height) * glm::normalize(Vector(c.axis));
  return sample_frustum({Vector(c.center) - up, Vector(c.center) + up, c.radius_bottom, c.radius_top}, part, u);
}
LampPoint sample_part(const world::Capsule& c, uint32_t part, const std::array<Real, 2>& u) {
  const Vector axis = glm::normalize(Vector(c.axis));
  const Vector bottom = Vector(c.center) - Real(c.half_height) * axis;
  const Vector top = Vector(c.center) + Real(c.half_height) * axis;
  const Real height = 2 * Real(c.half_height);
  // The angle by which normals of the side lean to the axis.
  const Real sine = (Real(c.radius_bottom) - Real(c.radius_top)) / height;
  const bool has_side = std::abs(sine) < 1;
  const Real cosine = std::sqrt(std::max(1 - sine * sine, Real(0)));
  if (part == 0) {
    return sample_frustum({bottom + c.radius_bottom * sine * axis, top + c.radius_top * sine * axis,
                           c.radius_bottom * cosine, c.radius_top * cosine},
                          part, u);
  }
  const Real lo = part == 1 ? -1 : (has_side ? sine : -1);
  const Real hi = part == 2 ? 1 : (has_side ? sine : 1);
  const Real z = std::lerp(lo, hi, u[0]);
  LampPoint lamp;
  lamp.normal = std::sqrt(1 - z * z) * direction_about(axis, u[1]) + z * axis;
  lamp.place = part == 2 ? top + Real(c.radius_top) * lamp.normal : bottom + Real(c.radius_bottom) * lamp.normal;
  return lamp;
}

/// The areas of the parts of a shape.
std::vector<Real> areas_of(const world::Box& box) {
  const Vector h(box.half_size);
  return {4 * h.y * h.z, 4 * h.y * h.z, 4 * h.x * h.z, 4 * h.x * h.z, 4 * h.x * h.y, 4 * h.x * h.y};
}
std::vector<Real> areas_of(const world::Cylinder& c) {
  const Real end = c.is_open ? 0 : kLampPi * Real(c.radius) * Real(c.radius);
  return {4 * kLampPi * Real(c.radius) * Real(c.half_height), end, end};
}
std::vector<Real> areas_of(const world::Cone& c) {
  const Real slant = std::hypot(2 * Real(c.half_height), Real(c.radius_top) - Real(c.radius_bottom));
  const Real share = c.is_open ? 0 : kLampPi;
  return {kLampPi * (Real(c.radius_bottom) + Real(c.radius_top)) * slant,
          share * Real(c.radius_bottom) * Real(c.radius_bottom), share * Real(c.radius_top) * Real(c.radius_top)};
}
std::vector<Real> areas_of(const world::Capsule& c) {
  const Real height = 2 * Real(c.half_height);
  const Real sine = (Real(c.radius_bottom) - Real(c.radius_top)) / height;
  const Real bottom = 2 * kLampPi * Real(c.radius_bottom) * Real(c.radius_bottom);
  const Real top = 2 * kLampPi * Real(c.radius_top) * Real(c.radius_top);
  if (std::abs(sine) >= 1) return sine > 0 ? std::vector<Real>{0, 2 * bottom, 0} : std::vector<Real>{0, 0, 2 * top};
  const Real slant = height * std::sqrt(1 - sine * sine);
  const Real radii = (Real(c.radius_bottom) + Real(c.radius_top)) * std::sqrt(1 - sine * sine);
  return {kLampPi * radii * slant, bottom * (1 + sine), top * (1 - sine)};
}
std::vector<Real> areas_of(const world::Sphere& sphere) {
  return {4 * kLampPi * Real(sphere.radius) * Real(sphere.radius)};
}
std::vector<Real> areas_of(const world::Plane& /*plane*/) {
  return {};
}

LampPoint sample_part(const world::Plane& /*plane*/, uint32_t /*part*/, const std::array<Real, 2>& /*u*/) {
  return {};
}

}  // namespace

LampPoint sample_flat(const FlatShape& shape, const Vector& position, const std::array<Real, 2>& u) {
  constexpr Real kLeastRectAngle = 1.0L / 16;
  LampPoint lamp;
  const Vector to_center = shape.center - position;
  const Vector normal = glm::cross(shape.right, shape.up);
  lamp.normal = normal;
  const Real z = -glm::dot(to_center, normal);
  const std::array<Real, 2> middle{glm::dot(to_center, shape.right), glm::dot(to_center, shape.up)};
  const auto [x0, y0] = std::array<Real, 2>{middle[0] - shape.half[0], middle[1] - shape.half[1]};
  const auto [x1, y1] = std::array<Real, 2>{middle[0] + shape.half[0], middle[1] + shape.half[1]};
  // The solid angle of the part of the rectangle up to x.
  const auto angle_to = [&, x0 = x0, y0 = y0, y1 = y1](Real x) {
    return solid_angle_of_corner(x, y1, z) - solid_angle_of_corner(x0, y1, z) - solid_angle_of_corner(x, y0, z) +
           solid_angle_of_corner(x0, y0, z);
  };
  const Real whole = angle_to(x1);
  std::array<Real, 2> at{};
  lamp.inverse_density = whole;
  if (whole >= kLeastRectAngle) {
    // The shares of the solid angle increase with x, and of a strip with the sine of the angle to y.
    Real lo = x0;
    Real hi = x1;
    for (int step = 0; step < 80; ++step) (angle_to((lo + hi) / 2) < u[0] * whole ? lo : hi) = (lo + hi) / 2;
    at[0] = (lo + hi) / 2;
    const Real apart = std::hypot(at[0], z);
    const Real sine = y0 / std::hypot(apart, y0) * (1 - u[1]) + y1 / std::hypot(apart, y1) * u[1];
    at[1] = apart * std::tan(std::asin(sine));
    const Real aside = std::hypot((at[0] - middle[0]) / shape.half[0], (at[1] - middle[1]) / shape.half[1]);
    if (shape.is_disk && aside > 1) lamp.inverse_density = 0;
  } else {
    const std::array<Real, 2> off = shape.is_disk ? place_on_disc(u) : std::array<Real, 2>{2 * u[0] - 1, 2 * u[1] - 1};
    at = {middle[0] + off[0] * shape.half[0], middle[1] + off[1] * shape.half[1]};
    const Real distance = std::hypot(std::hypot(at[0], at[1]), z);
    lamp.inverse_density =
        (shape.is_disk ? kLampPi : 4) * shape.half[0] * shape.half[1] * (z / distance) / (distance * distance);
  }
  lamp.place = position + at[0] * shape.right + at[1] * shape.up - z * normal;
  return lamp;
}

Real solid_angle_of(const std::array<Vector, 3>& corners) {
  const Vector a = glm::normalize(corners[0]);
  const Vector b = glm::normalize(corners[1]);
  const Vector c = glm::normalize(corners[2]);
  // L'Huilier's formula from the sides.
  const Real x = angle_between(b, c);
  const Real y = angle_between(c, a);
  const Real z = angle_between(a, b);
  const Real s = (x + y + z) / 2;
  const Real product = std::tan(s / 2) * std::tan((s - x) / 2) * std::tan((s - y) / 2) * std::tan((s - z) / 2);
  return 4 * std::atan(std::sqrt(std::max(product, Real(0))));
}

Emitters::Emitters(const world::Scene& scene) : scene_(scene) {
  const auto has = [&]<typename Model>(const Model& /*any*/) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& m) { return std::holds_alternative<Model>(m.model); });
  };
  const bool is_of_phong = has(Phong()) && !has(MetallicRoughness());
  if (is_of_phong) radiance_factor_ = 1 / kLampPi;
  std::vector<Emitter> all;
  const Real radius = radius_of(scene);
  for (uint32_t i = 0; i < scene.lights.size(); ++i) {
    all.push_back({.light = i, .weight = flux_of(scene.lights[i], radius) * (is_of_phong ? kLampPi : 1)});
  }
  std::vector<std::vector<Emitter>> of_objects;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    std::vector<Emitter> found;
    const auto add = [&](int32_t primitive, uint32_t part, uint32_t number, Real area) {
      const Material& material = scene.materials[number];
      const Real weight = area * mean_of(material.emissive) * (shows_backs(material) ? 2 : 1);
      if (std::holds_alternative<Unlit>(material.model) || !(weight > 0)) return;
      found.push_back({.object = static_cast<int32_t>(i), .primitive = primitive, .part = part, .weight = weight});
    };
    const world::Object& object = scene.objects[i];
    if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
      for (size_t triangle = 0; triangle < mesh->triangles.size(); ++triangle) {
        const auto [a, b, c] = lamp_corners(*mesh, static_cast<int32_t>(triangle));
        const uint32_t material =
            mesh->triangle_materials.empty() ? object.material : mesh->triangle_materials[triangle];
        add(static_cast<int32_t>(triangle), 0, material, glm::length(glm::cross(b - a, c - a)) / 2);
      }
    } else {
      std::visit(
          [&]<typename Shape>(const Shape& shape) {
            if constexpr (requires { areas_of(shape); }) {
              uint32_t part = 0;
              for (const Real area : areas_of(shape)) add(0, part++, object.material, area);
            }
          },
          object.shape);
    }
    if (!found.empty()) of_objects.push_back(found);
  }
  join_rectangles(of_objects);
  are_lights_chosen_ = scene.lights.size() + of_objects.size() > kMostAsked;
  if (!are_lights_chosen_) {
    for (const std::vector<Emitter>& object : of_objects) tables_.push_back(make_table(object));
    return;
  }
  for (const std::vector<Emitter>& object : of_objects) all.insert(all.end(), object.begin(), object.end());
  std::erase_if(all, [](const Emitter& emitter) { return !(emitter.weight > 0); });
  if (!all.empty()) tables_.push_back(make_table(all));
}

void Emitters::join_rectangles(std::vector<std::vector<Emitter>>& of_objects) const {
  std::vector<std::vector<Emitter>> all_joined;
  for (const std::vector<Emitter>& triangles : of_objects) {
    std::vector<Emitter> joined;
    for (size_t i = 0; i < triangles.size(); ++i) {
      joined.push_back(triangles[i]);
      const world::Object& object = scene_.objects[static_cast<size_t>(triangles[i].object)];
      const auto* mesh = std::get_if<Mesh>(&object.shape);
      if (mesh == nullptr) continue;
      if (i + 1 == triangles.size() || triangles[i + 1].primitive != triangles[i].primitive + 1) return;
      const auto material_of = [&](const Emitter& emitter) {
        return mesh->triangle_materials.empty() ? object.material
                                                : mesh->triangle_materials[static_cast<size_t>(emitter.primitive)];
      };
      const uint32_t number = material_of(triangles[i]);
      const Material& material = scene_.materials[number];
      const auto* model = std::get_if<MetallicRoughness>(&material.model);
      const bool is_even = material.alpha_mode == AlphaMode::kOpaque && !material.emissive_texture.exists() &&
                           (model == nullptr || !model->clearcoat_texture.exists());
      if (!is_even || number != material_of(triangles[i + 1])) return;
      joined.back().rectangle =
          rectangle_of(lamp_corners(*mesh, triangles[i].primitive), lamp_corners(*mesh, triangles[i + 1].primitive));
      if (!joined.back().rectangle) return;
      joined.back().weight += triangles[++i].weight;
    }
    all_joined.push_back(std::move(joined));
  }
  of_objects = std::move(all_joined);
}

Emitters::Table Emitters::make_table(std::vector<Emitter> elements) {
  Real total = 0;
  for (const Emitter& element : elements) total += element.weight;
  Table table{std::move(elements), {0}};
  Real sum = 0;
  for (size_t i = 0; i < table.elements.size(); ++i) {
    sum += table.elements[i].weight / total;
    const Real even = static_cast<Real>(i + 1) / static_cast<Real>(table.elements.size());
    table.begins.push_back(std::floor(0x1p32L * ((1 - kEvenShare) * sum + kEvenShare * even)));
  }
  table.begins.back() = 0x1p32L;
  return table;
}

Emitters::Choice Emitters::choose(size_t source, const SampleId& id, uint32_t pair) const {
  const Table& table = tables_[source];
  const std::array<uint32_t, 2> bits = sample_pair_bits(id, pair);
  size_t i = 0;
  while (table.begins[i + 1] <= bits[0]) ++i;
  const Real width = table.begins[i + 1] - table.begins[i];
  return {table.elements[i], width / 0x1p32L, {(bits[0] - table.begins[i] + 0.5L) / width, sample_pair(id, pair)[1]}};
}

LampPoint Emitters::sample(const Emitter& emitter, const Vector& position, const Vector& facing,
                           const std::array<Real, 2>& u) const {
  const world::Object& object = scene_.objects[static_cast<size_t>(emitter.object)];
  if (const auto* sphere = std::get_if<world::Sphere>(&object.shape))
    return sample_sphere(*sphere, position, facing, u);
  if (const auto* mesh = std::get_if<Mesh>(&object.shape)) {
    return emitter.rectangle ? sample_rectangle(*emitter.rectangle, position, u)
                             : sample_triangle(lamp_corners(*mesh, emitter.primitive), position, u);
  }
  LampPoint lamp;
  Real area = 0;
  std::visit(
      [&]<typename Shape>(const Shape& shape) {
        if constexpr (requires { sample_part(shape, 0, u); }) {
          lamp = sample_part(shape, emitter.part, u);
          area = areas_of(shape)[emitter.part];
        }
      },
      object.shape);
  const Vector way = lamp.place - position;
  lamp.inverse_density = area * std::abs(glm::dot(lamp.normal, way)) / std::pow(glm::length(way), Real(3));
  return lamp;
}

}  // namespace promin::oracle
