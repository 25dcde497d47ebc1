// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "core/parallel.h"
#include "oracle/distance.h"
#include "scene/light_kinds.h"

namespace promin::oracle {
namespace {

/// A hit as shading sees it. All normals are unit and face the ray.
struct SurfacePoint {
  Vector position{0};
  Vector geometric_normal{0};
  /// Interpolated where the mesh has vertex normals.
  Vector normal{0};
  /// Where shadow rays start from, but for the lift.
  Vector shadow_position{0};
  /// How far along the geometric normal secondary rays start.
  Real lift = 0;
  Vector vertex_color{1};
  const Material* material = nullptr;
};

/// Rounding puts the point of a hit off its primitive, and a ray from behind the surface would meet it again: by a few
/// 2^-64 of the lengths that the hit was computed from. A thousandfold of that is still 1e-16 of them, less than
/// anything that a picture shows.
Real lift_of(const world::Shape& shape, const Ray& ray, const Hit& hit, const Vector& position) {
  const BoundingSphere bound = bounding_sphere(shape, hit.primitive);
  return 0x1p-54L * (glm::length(ray.origin) + glm::length(position) + glm::distance(position, ray.origin) +
                     glm::distance(position, bound.center) + bound.radius);
}

struct Corners {
  glm::uvec3 indices;
  std::array<Real, 3> weights;

  template <typename Values>
  Vector interpolate(const Values& values) const {
    Vector sum(0);
    for (int i = 0; i < 3; ++i) sum += weights[static_cast<size_t>(i)] * Vector(values[indices[i]]);
    return sum;
  }
};

/// Vertex normals face the ray as the triangle does, by the side of its plane that is seen.
void apply_vertex_normals(const Mesh& mesh, const Corners& corners, Real side, SurfacePoint& point) {
  const Vector sum = side * corners.interpolate(mesh.normals);
  if (sum == Vector(0)) return;
  point.normal = glm::normalize(sum);
  // Hanika, "Hacking the Shadow Terminator": where the point lies below the tangent plane of a corner, it is projected
  // onto it; the three results are weighted like the corners.
  point.shadow_position = Vector(0);
  for (int i = 0; i < 3; ++i) {
    const uint32_t corner = corners.indices[i];
    const Vector n = side * Vector(mesh.normals[corner]);
    const Real height = glm::dot(point.position - Vector(mesh.positions[corner]), n);
    const Vector projected = height < 0 ? point.position - height * n : point.position;
    point.shadow_position += corners.weights[static_cast<size_t>(i)] * projected;
  }
}

SurfacePoint make_surface_point(const world::Scene& scene, const Ray& ray, const Hit& hit) {
  const world::Object& object = scene.objects[static_cast<size_t>(hit.object)];
  const Real side = glm::dot(hit.normal, ray.direction) > 0 ? -1 : 1;
  SurfacePoint point;
  point.position = ray.origin + hit.t * ray.direction;
  point.geometric_normal = point.normal = side * hit.normal;
  point.shadow_position = point.position;
  point.lift = lift_of(object.shape, ray, hit, point.position);
  point.material = &scene.materials[object.material];
  if (const Mesh* mesh = std::get_if<Mesh>(&object.shape)) {
    const auto triangle = static_cast<size_t>(hit.primitive);
    const Corners corners{mesh->triangles[triangle], {1 - hit.u - hit.v, hit.u, hit.v}};
    if (!mesh->triangle_materials.empty()) point.material = &scene.materials[mesh->triangle_materials[triangle]];
    if (!mesh->normals.empty()) apply_vertex_normals(*mesh, corners, side, point);
    if (!mesh->colors.empty()) point.vertex_color = corners.interpolate(mesh->colors);
  }
  return point;
}

/// The share of a source's power that its shape and distance leave, and where it lies.
struct Illumination {
  Vector to_light{0};
  Real strength = 1;
};

Illumination illuminate(const Light& light, const Vector& position) {
  const Vector axis = glm::normalize(Vector(light.direction));
  if (!has_place(light.kind)) return {-axis};
  const Vector offset = Vector(light.position) - position;
  const Real distance = glm::length(offset);
  Illumination result{offset / distance};
  if (light.attenuation == Attenuation::kInverseSquare) {
    // KHR_lights_punctual, "Range Property".
    const Real window = 1 - std::pow(distance / light.range, Real(4));
    result.strength = std::clamp(window, Real(0), Real(1)) / (distance * distance);
  }
  if (light.kind == LightKind::kSpot) {
    // The same, "Inner and Outer Cone Angles".
    const Real outer = std::cos(Real(light.outer_cone_angle));
    const Real width = std::max(1e-5L, std::cos(Real(light.inner_cone_angle)) - outer);
    const Real ramp = std::clamp((-glm::dot(result.to_light, axis) - outer) / width, Real(0), Real(1));
    result.strength *= ramp * ramp;
  }
  return result;
}

bool is_in_shadow(const world::Scene& scene, const SurfacePoint& point, const Light& light, const Vector& to_light) {
  const Vector origin = point.shadow_position + point.lift * point.geometric_normal;
  if (!has_place(light.kind)) return is_occluded(scene, {origin, to_light});
  return is_occluded(scene, {origin, Vector(light.position) - origin, 0, 1});
}

/// I = Ka i_a + sum over visible sources of Kd (N.L) i_d + Ks (R.V)^s i_s, and what the material emits.
Vector shade(const world::Scene& scene, const SurfacePoint& point, const Vector& to_eye) {
  const Material& material = *point.material;
  Vector sum =
      Vector(material.phong().ambient) * point.vertex_color * Vector(scene.environment.ambient) + Vector(material.emissive);
  for (const Light& light : scene.lights) {
    const Illumination illumination = illuminate(light, point.position);
    const Real cosine = glm::dot(point.normal, illumination.to_light);
    if (!(cosine > 0) || !(illumination.strength > 0)) continue;
    if (is_in_shadow(scene, point, light, illumination.to_light)) continue;
    Vector share = Vector(material.phong().diffuse) * point.vertex_color * Vector(light.diffuse) * cosine;
    const Real highlight = glm::dot(2 * cosine * point.normal - illumination.to_light, to_eye);
    if (material.phong().shininess > 0 && highlight > 0) {
      share += Vector(material.phong().specular) * Vector(light.specular) * std::pow(highlight, Real(material.phong().shininess));
    }
    sum += illumination.strength * share;
  }
  return sum;
}

/// About the shading normal; what that would send into the surface, the surface itself mirrors back.
Vector mirror(const SurfacePoint& point, const Vector& direction) {
  const Vector mirrored = glm::reflect(direction, point.normal);
  const bool is_inward = glm::dot(mirrored, point.geometric_normal) < 0;
  return is_inward ? glm::reflect(mirrored, point.geometric_normal) : mirrored;
}

/// Whitted's recursion: I = Phong + kr I(mirror ray). `bounces` are left.
Vector radiance(const world::Scene& scene, const Ray& ray, const Hit& hit, uint32_t bounces) {
  if (!hit.exists()) return Vector(scene.environment.background);
  const SurfacePoint point = make_surface_point(scene, ray, hit);
  const Vector direction = glm::normalize(ray.direction);
  const Vector own = shade(scene, point, -direction);
  const Vector reflection(point.material->reflection);
  if (bounces == 0 || reflection == Vector(0)) return own;
  const Ray next{point.position + point.lift * point.geometric_normal, mirror(point, direction)};
  return own + reflection * radiance(scene, next, find_nearest_hit(scene, next), bounces - 1);
}

}  // namespace

Ray camera_ray(const Camera& camera, const uvec2& size, uint32_t x, uint32_t y) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half_height =
      is_orthographic ? static_cast<double>(camera.ymag) : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half_height / size.y;
  const vec3 right(pixel * glm::cross(dvec3(camera.look), dvec3(camera.up)));
  const vec3 up(pixel * dvec3(camera.up));
  const Vector on_film = (x + 0.5L - size.x / 2.0L) * Vector(right) + (size.y / 2.0L - y - 0.5L) * Vector(up);
  // The interval is open: it begins just before the viewport.
  const Real tmin = std::nextafter(Real(camera.near), -kInfinity);
  const Vector eye(camera.eye);
  const Vector look(camera.look);
  return is_orthographic ? Ray{eye + on_film, look, tmin} : Ray{eye, look + on_film, tmin};
}

Picture render(const world::Scene& scene, const View& view) {
  world::Scene lit = scene;
  for (Light& light : lit.lights) {
    if (light.kind != LightKind::kHeadlight) continue;
    light.kind = LightKind::kDirectional;
    light.direction = view.camera.look;
  }
  Picture picture;
  picture.size = view.size;
  picture.pixels.resize(static_cast<size_t>(view.size.x) * view.size.y);
  for_each_index(view.size.y, 0, [&](size_t row) {
    const auto y = static_cast<uint32_t>(row);
    for (uint32_t x = 0; x < view.size.x; ++x) {
      Pixel& pixel = picture.pixels[row * view.size.x + x];
      pixel.ray = camera_ray(view.camera, view.size, x, y);
      pixel.hit = find_nearest_hit(lit, pixel.ray);
      pixel.color = radiance(lit, pixel.ray, pixel.hit, view.max_depth);
    }
  });
  return picture;
}

}  // namespace promin::oracle
