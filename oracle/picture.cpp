// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

#include "core/parallel.h"
#include "oracle/distance.h"
#include "oracle/emitters.h"
#include "oracle/lobe.h"
#include "oracle/normal_error.h"
#include "oracle/samples.h"
#include "oracle/sky_light.h"
#include "oracle/smooth_lobe.h"
#include "oracle/surface.h"
#include "oracle/verdict.h"
#include "scene/glass.h"
#include "scene/light_kinds.h"

namespace promin::oracle {
namespace {

/// Returns the distance by which secondary rays start off the surface. Rounding moves the point of a hit off its
/// primitive by a few 2^-64 of the lengths from which the hit was computed, and a ray that starts behind the surface
/// would hit it again. The result is a thousand times larger, which is still only 1e-16 of these lengths and less than
/// anything that a picture shows.
Real lift_of(const world::Shape& shape, const Ray& ray, const Hit& hit, const Vector& position) {
  const BoundingSphere bound = bounding_sphere(shape, hit.primitive);
  return 0x1p-54L * (glm::length(ray.origin) + glm::length(position) + glm::distance(position, ray.origin) +
                     glm::distance(position, bound.center) + bound.radius);
}

struct TriangleCorners {
  glm::uvec3 indices;
  std::array<Real, 3> weights;

  template <typename Sum, typename Values>
  Sum interpolate(const Values& values) const {
    Sum sum(0);
    for (int i = 0; i < 3; ++i) sum += weights[static_cast<size_t>(i)] * Sum(values[indices[i]]);
    return sum;
  }
};

/// Sets the vertex normals on the side that is visible: they face the ray as the triangle's plane does.
void apply_vertex_normals(const Mesh& mesh, const TriangleCorners& corners, Real side, SurfacePoint& point) {
  const Vector sum = side * corners.interpolate<Vector>(mesh.normals);
  if (sum == Vector(0)) return;
  point.normal = glm::normalize(sum);
  // Hanika, "Hacking the Shadow Terminator": if the point lies below the tangent plane of a corner, it is projected
  // onto this plane. The three results are weighted like the corners.
  point.shadow_position = Vector(0);
  for (int i = 0; i < 3; ++i) {
    const uint32_t corner = corners.indices[i];
    const Vector n = side * Vector(mesh.normals[corner]);
    const Real height = glm::dot(point.position - Vector(mesh.positions[corner]), n);
    const Vector projected = height < 0 ? point.position - height * n : point.position;
    point.shadow_position += corners.weights[static_cast<size_t>(i)] * projected;
  }
}

/// The fraction of a source's power that its shape and distance leave, and the source's direction and distance.
struct Illumination {
  Vector to_light{0};
  Real strength = 1;
  /// Distance of the source; infinite for a source without a position.
  Real distance = kInfinity;
};

/// Returns the distance along a ray to a ball's surface: to the nearer point from outside, to the only one from inside.
Real distance_to_ball(const Vector& to_center, Real radius, const Vector& direction) {
  const Real along = glm::dot(to_center, direction);
  const Real aside = glm::length(glm::cross(to_center, direction));
  const Real half_chord = std::sqrt(std::max((radius - aside) * (radius + aside), Real(0)));
  return glm::length(to_center) <= radius ? along + half_chord : along - half_chord;
}

/// Returns the factor of a spot light (KHR_lights_punctual, "Inner and Outer Cone Angles").
Real spot_share(const Light& light, const Vector& to_light) {
  const Real outer = std::cos(Real(light.outer_cone_angle));
  const Real width = std::max(1e-5L, std::cos(Real(light.inner_cone_angle)) - outer);
  const Vector axis = glm::normalize(Vector(light.direction));
  const Real ramp = std::clamp((-glm::dot(to_light, axis) - outer) / width, Real(0), Real(1));
  return ramp * ramp;
}

/// Returns the light of one point of a flat light.
Illumination illuminate_flat(const Light& light, const Vector& position, const std::array<Real, 2>& u) {
  const Vector normal = Vector(light.direction);
  if (glm::dot(Vector(light.position) - position, normal) >= 0) return {normal, 0, 1};
  const FlatShape shape{.center = Vector(light.position),
                        .right = Vector(light.right),
                        .up = glm::cross(normal, Vector(light.right)),
                        .half = {Real(light.size.x) / 2, Real(light.size.y) / 2},
                        .is_disk = light.kind == LightKind::kDisk};
  const LampPoint lamp = sample_flat(shape, position, u);
  const Vector to_point = lamp.place - position;
  return {glm::normalize(to_point), lamp.inverse_density, glm::length(to_point)};
}

/// Returns the light of one point of a ball or of a disc in the sky. The strength is the radiance divided by the
/// density, for a light whose irradiance is the power of the light without size.
Illumination illuminate_sized(const Light& light, const Vector& position, const std::array<Real, 2>& u,
                              const std::optional<SmoothLobe>& lobe) {
  constexpr Real kPi = std::numbers::pi_v<Real>;
  if (is_flat(light.kind)) return illuminate_flat(light, position, u);
  // Half of the samples of a smooth lobe choose a direction that it reflects to the eye.
  const auto choose = [&](const Vector& axis, Real half_angle) -> std::pair<Vector, Real> {
    const Real solid_angle = 4 * kPi * std::sin(half_angle / 2) * std::sin(half_angle / 2);
    if (!lobe || !(lobe->alpha * lobe->alpha < solid_angle / (2 * kPi))) {
      return {place_in_cone(axis, half_angle, u), solid_angle};
    }
    const bool is_of_lobe = u[0] > 0.5L;
    const std::array<Real, 2> rest{2 * u[0] - (is_of_lobe ? 1 : 0), u[1]};
    const Vector direction = is_of_lobe ? lobe->place(rest) : place_in_cone(axis, half_angle, rest);
    const Real angle = 2 * std::asin(std::min(glm::distance(direction, axis) / 2, Real(1)));
    if (is_of_lobe && angle > half_angle) return {direction, 0};
    return {direction, 1 / (0.5L / solid_angle + 0.5L * lobe->density(direction))};
  };
  if (!has_place(light.kind)) {
    const Real half_angle = Real(light.angle) / 2;
    const Real radiance = 1 / (kPi * std::sin(half_angle) * std::sin(half_angle));
    const auto [direction, inverse_density] = choose(glm::normalize(-Vector(light.direction)), half_angle);
    return {direction, radiance * inverse_density};
  }
  const Vector to_center = Vector(light.position) - position;
  const Real distance = glm::length(to_center);
  const Real radius = light.radius;
  const bool is_inside = distance <= radius;
  const Real half_angle = is_inside ? kPi : std::asin(radius / distance);
  const Vector axis = distance > 0 ? to_center / distance : Vector(0, 0, 1);
  const auto [chosen, inverse_density] = choose(axis, half_angle);
  Illumination result{chosen};
  result.distance = distance_to_ball(to_center, radius, result.to_light);
  // A ball whose power does not fall off has the radiance for which its power at each place is 1.
  const bool does_fall = light.attenuation == Attenuation::kInverseSquare;
  const Real apart = std::max(distance, radius);
  const Real radiance = (does_fall ? 1 : apart * apart) / (kPi * radius * radius);
  result.strength = radiance * inverse_density;
  if (does_fall) result.strength *= std::clamp(1 - std::pow(apart / light.range, Real(4)), Real(0), Real(1));
  if (light.kind == LightKind::kSpot) result.strength *= spot_share(light, result.to_light);
  return result;
}

Illumination illuminate(const Light& light, const Vector& position) {
  const Vector axis = glm::normalize(Vector(light.direction));
  if (!has_place(light.kind)) return {-axis};
  const Vector offset = Vector(light.position) - position;
  const Real distance = glm::length(offset);
  Illumination result{offset / distance, 1, distance};
  if (light.attenuation == Attenuation::kInverseSquare) {
    // The formula of KHR_lights_punctual, "Range Property".
    const Real window = 1 - std::pow(distance / light.range, Real(4));
    result.strength = std::clamp(window, Real(0), Real(1)) / (distance * distance);
  }
  if (light.kind == LightKind::kSpot) result.strength *= spot_share(light, result.to_light);
  return result;
}

/// The largest number of surfaces that blend along a ray, and the smallest fraction of the light from behind for which
/// a ray continues.
constexpr uint32_t kMostLayers = 64;
/// The first pair of dimensions that chooses a scattered ray's direction.
constexpr uint32_t kFirstDirectionPair = 0x40000000;
constexpr Real kLeastShareBehind = 1.0L / 1024;

/// The smallest weight of a mirror ray that is traced if the environment can replace it.
constexpr Real kLeastMirrorWeight = 1.0L / 256;

/// With glass: the largest number of rays from surfaces that a sample follows, and the smallest weight of such a ray.
constexpr uint32_t kMostTreeRays = 64;
constexpr Real kLeastTreeWeight = 1.0L / 512;

/// In d = look + (x right - y up), each product, the difference and the sum are rounded, and d is normalised.
constexpr Real kCameraRayError = 8 * kRoundoff;

/// The error of a pixel that may show either of two very different surfaces.
constexpr Real kUnknown = 1000;

/// Returns the direction mirrored at the shading normal. If it would point into the surface, it is mirrored again at
/// the surface itself.
Vector mirror(const SurfacePoint& point, const Vector& normal, const Vector& direction) {
  const Vector mirrored = glm::reflect(direction, normal);
  const bool is_inward = glm::dot(mirrored, point.geometric_normal) < 0;
  return is_inward ? glm::reflect(mirrored, point.geometric_normal) : mirrored;
}

/// The errors of a device's ray: of its origin and of its direction.
struct RayError {
  Real position = 0;
  Real direction = 0;
};

/// Returns the radius of curvature for shading. For a mesh with vertex normals it is the radius of the curved surface
/// that they describe.
Real radius_of_shading(const world::Shape& shape, const Ray& ray, const Hit& hit) {
  const Mesh* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr || mesh->normals.empty()) return radius_of_curvature(shape, ray, hit);
  const glm::uvec3 corners = mesh->triangles[static_cast<size_t>(hit.primitive)];
  Real radius = kInfinity;
  for (int i = 0; i < 3; ++i) {
    const uint32_t a = corners[i];
    const uint32_t b = corners[(i + 1) % 3];
    radius = std::min(radius, glm::distance(Vector(mesh->positions[a]), Vector(mesh->positions[b])) /
                                  glm::distance(Vector(mesh->normals[a]), Vector(mesh->normals[b])));
  }
  return radius;
}

/// Returns the change of the vertex normals per length along the triangle's edges, positive for a convex surface; 0
/// without vertex normals. If the corners lie on a sphere, each edge gives 1 / radius.
Real curvature_of(const TrianglePoint& at) {
  if (at.mesh == nullptr || at.mesh->normals.empty()) return 0;
  const glm::uvec3 corners = at.mesh->triangles[static_cast<size_t>(at.triangle)];
  Real sum = 0;
  for (int i = 0; i < 3; ++i) {
    const uint32_t a = corners[i];
    const uint32_t b = corners[(i + 1) % 3];
    const Vector edge = Vector(at.mesh->positions[b]) - Vector(at.mesh->positions[a]);
    const Vector turn = glm::normalize(Vector(at.mesh->normals[b])) - glm::normalize(Vector(at.mesh->normals[a]));
    sum += glm::dot(turn, edge) / glm::dot(edge, edge) / 3;
  }
  return sum;
}

/// Returns the errors of a hit: its own rounding, by the bounds for hits and normals, and the errors of the ray.
PointError error_at(const world::Scene& scene, const Ray& ray, const Hit& hit, const RayError& of_ray) {
  const world::Shape& shape = scene.objects[static_cast<size_t>(hit.object)].shape;
  const Real cosine = std::max(std::abs(glm::dot(hit.normal, glm::normalize(ray.direction))), 1e-9L);
  const Real aside = of_ray.position + of_ray.direction * hit.t * glm::length(ray.direction);
  PointError error;
  error.position = aside / cosine + kB1 * kRoundoff * scale_of(shape, hit.primitive, ray) / cosine;
  error.normal = allowed_normal_error(shape, ray, hit) + aside / (radius_of_shading(shape, ray, hit) * cosine);
  error.to_eye = of_ray.direction;
  return error;
}

Real largest_difference(const Vector& a, const Vector& b) {
  return largest(glm::abs(a - b));
}

bool scatters_through(const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  return model != nullptr && model->diffuse_transmission > 0;
}

/// The opacity of a surface, and the error that a device may have.
struct Coverage {
  Real value = 1;
  Real error = 0;
};

/// The fraction of a source's light that reaches a point.
struct ArrivingShare {
  Vector value{1};
  Real error = 0;
};

/// The first hit of a ray, and whether a device may see another one because the edge of a mask is near.
struct Seen {
  Hit hit;
  bool is_at_cutoff = false;
};

/// The state of a ray on its way from the eye.
struct Way {
  /// The number of mirrors that may still follow.
  uint32_t bounces = 0;
  /// The number of surfaces that the ray has passed through.
  uint32_t layers = 0;
  /// The fraction of the ray's radiance that the pixel receives.
  Vector weight{1};
  /// True if a mirror has reflected the ray.
  bool is_mirrored = false;
  /// True if one of the mirrors has a metallic-roughness material.
  bool is_of_metal = false;
  /// The largest roughness of the mirrors.
  Real roughness = 0;
  /// With Integrator::kPath: the fraction of the environment's light that the ray sees, and whether a diffuse surface
  /// has scattered it.
  Real environment_share = 1;
  bool is_diffused = false;
  Cone cone;
  RayError error;
  /// With glass: the media that contain the ray, and the number of rays that its sample has followed.
  Media media;
  uint32_t* rays = nullptr;
  /// The sample whose points lights with a size show, the number of this ray in the sample, and the number of rays so
  /// far.
  SampleId sample;
  uint32_t step = 0;
  uint32_t* steps = nullptr;
};

class Tracer {
 public:
  /// `has_lens` is true if the first pair of dimensions of each sample belongs to the camera's lens.
  Tracer(const world::Scene& scene, bool has_lens, Integrator integrator)
      : scene_(scene),
        has_lens_(has_lens),
        textures_(scene),
        surroundings_(scene.environment, integrator != Integrator::kWhitted),
        sky_light_(scene.environment),
        scatters_(integrator == Integrator::kPath),
        emitters_(integrator != Integrator::kWhitted ? std::optional<Emitters>(scene) : std::nullopt),
        has_glass_(std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const Material& m) { return glass_of(m).is_clear; })) {}

  /// Returns the nearest hit where no mask has cut out the triangle.
  Seen find(const Ray& ray, const Way& way, Sight sight) const {
    Seen seen;
    for (;;) {
      seen.hit = find_nearest_hit(scene_, ray, sight);
      if (!seen.hit.exists()) return seen;
      const Material& material = material_of(scene_, seen.hit);
      const TrianglePoint at = triangle_point(ray, seen.hit, way.cone, error_at(scene_, ray, seen.hit, way.error));
      if (material.alpha_mode != AlphaMode::kMask || at.mesh == nullptr) return seen;
      const Coverage alpha = alpha_of(material, at);
      seen.is_at_cutoff = seen.is_at_cutoff || std::abs(alpha.value - material.alpha_cutoff) <= alpha.error;
      if (alpha.value >= material.alpha_cutoff) return seen;
      sight.passed = seen.hit;
    }
  }

  /// Whitted's recursion: I = what the point sends + weight of the mirror * I(mirror ray). A surface that blends
  /// contributes alpha * (its light, with the environment in place of a mirror ray) + (1 - alpha) * (the radiance from
  /// behind).
  Radiance trace(const Ray& ray, const Seen& seen, const Way& way) const {
    Way here = way;
    here.step = (*way.steps)++;
    Radiance sum = trace_hit(ray, seen.hit, here);
    if (seen.is_at_cutoff) sum.error += kUnknown;
    return sum;
  }

 private:
  TrianglePoint triangle_point(const Ray& ray, const Hit& hit, const Cone& cone, const PointError& error) const {
    TrianglePoint at;
    at.mesh = std::get_if<Mesh>(&scene_.objects[static_cast<size_t>(hit.object)].shape);
    at.triangle = hit.primitive;
    at.u = hit.u;
    at.v = hit.v;
    at.width = std::abs(cone.width + cone.spread * hit.t * glm::length(ray.direction));
    at.cosine = std::abs(glm::dot(hit.normal, glm::normalize(ray.direction)));
    at.place_error = error.position;
    at.cosine_error = error.normal + error.to_eye;
    return at;
  }

  SurfacePoint make_surface_point(const Ray& ray, const Hit& hit, const Way& way, const PointError& error,
                                  Media& beyond) const {
    const world::Object& object = scene_.objects[static_cast<size_t>(hit.object)];
    SurfacePoint point;
    point.side = glm::dot(hit.normal, ray.direction) > 0 ? -1 : 1;
    point.position = ray.origin + hit.t * ray.direction;
    point.geometric_normal = point.normal = point.side * hit.normal;
    point.shadow_position = point.position;
    point.lift = lift_of(object.shape, ray, hit, point.position);
    point.material = &material_of(scene_, hit);
    point.on_triangle = triangle_point(ray, hit, way.cone, error);
    if (const Mesh* mesh = point.on_triangle.mesh) {
      const TriangleCorners corners{mesh->triangles[static_cast<size_t>(hit.primitive)],
                                    {1 - hit.u - hit.v, hit.u, hit.v}};
      if (!mesh->normals.empty()) apply_vertex_normals(*mesh, corners, point.side, point);
      if (!mesh->colors.empty()) point.vertex_color = corners.interpolate<Texel>(mesh->colors);
    }
    beyond = way.media;
    if (glass_of(*point.material).exists) {
      point.face = way.media.meet(*point.material, point.side < 0, color_of(way.weight), beyond);
      // Straight rays see each face as from its thinner side.
      if (way.is_diffused && point.face->from > point.face->to) std::swap(point.face->from, point.face->to);
    }
    point.is_after_diffusion = way.is_diffused;
    if (scatters_ && !std::holds_alternative<world::Plane>(object.shape)) point.emission_share = way.environment_share;
    point.slots = slots_of(*point.material);
    for (TextureSlot& slot : point.slots) {
      if (!textures_.shows(slot, point.on_triangle)) slot = {};
    }
    return point;
  }

  /// Returns alpha: the factor, times the alpha of the base colour's texture, times the alpha of the vertices (glTF
  /// 2.0, 3.9.4).
  Coverage alpha_of(const Material& material, const TrianglePoint& at) const {
    const Shown shown = textures_.look_up(slots_of(material)[kBaseSlot], at);
    Real factor = material.alpha;
    if (at.mesh != nullptr && !at.mesh->colors.empty()) {
      const TriangleCorners corners{at.mesh->triangles[static_cast<size_t>(at.triangle)],
                                    {1 - at.u - at.v, at.u, at.v}};
      factor *= corners.interpolate<Texel>(at.mesh->colors).a;
    }
    return {factor * shown.value.a, factor * shown.error.a};
  }

  /// Returns the opacity of a surface where a ray has found a hit.
  Coverage coverage_of(const Material& material, const TrianglePoint& at) const {
    if (material.alpha_mode == AlphaMode::kBlend) return alpha_of(material, at);
    return {material.alpha_mode == AlphaMode::kMask && material.alpha < material.alpha_cutoff ? Real(0) : Real(1)};
  }

  /// Returns the opacity at a hit of a shadow ray. Unlike coverage_of it also evaluates masks, at the finest level.
  Coverage coverage_in_shadow(const Ray& ray, const Hit& hit, const RayError& of_ray) const {
    const Material& material = material_of(scene_, hit);
    const TrianglePoint at = triangle_point(ray, hit, {}, error_at(scene_, ray, hit, of_ray));
    if (material.alpha_mode != AlphaMode::kMask || at.mesh == nullptr) return coverage_of(material, at);
    const Coverage alpha = alpha_of(material, at);
    const bool is_at_cutoff = std::abs(alpha.value - material.alpha_cutoff) <= alpha.error;
    return {alpha.value >= material.alpha_cutoff ? Real(1) : Real(0), is_at_cutoff ? Real(1) : Real(0)};
  }

  /// Returns the fraction of straight light that a surface of glass transmits, and the media behind it.
  Vector share_of_glass(const Ray& ray, const Hit& hit, const RayError& of_ray, Media& media) const {
    const Material& material = material_of(scene_, hit);
    const Real along = glm::dot(hit.normal, glm::normalize(ray.direction));
    Media beyond;
    const Face face = media.meet(material, along > 0, kGreen, beyond);
    media = beyond;
    Vector tint(1);
    Real transmission = 1;
    Real metal = 1;
    if (const auto* model = std::get_if<MetallicRoughness>(&material.model)) {
      const TrianglePoint at = triangle_point(ray, hit, {}, error_at(scene_, ray, hit, of_ray));
      tint = Vector(model->base_color);
      if (at.mesh != nullptr && !at.mesh->colors.empty()) {
        const TriangleCorners corners{at.mesh->triangles[static_cast<size_t>(at.triangle)],
                                      {1 - at.u - at.v, at.u, at.v}};
        tint *= Vector(corners.interpolate<Texel>(at.mesh->colors));
      }
      const Slots slots = slots_of(material);
      const auto look_up = [&](Slot slot) {
        return textures_.shows(slots[slot], at) ? textures_.look_up(slots[slot], at).value : Texel(1);
      };
      tint = glm::min(tint * Vector(look_up(kBaseSlot)), Vector(1));
      transmission = look_up(kTransmissionSlot).r;
      metal = look_up(kMetallicRoughnessSlot).b;
    }
    return straight_share(material, face, std::min(std::abs(along), Real(1)), tint, transmission, metal);
  }

  /// Returns the fraction of the source's light that reaches a point through glass, one surface after the other.
  ArrivingShare share_through_glass(const Ray& ray, const RayError& of_ray, Media media) const {
    const Real length = glm::length(ray.direction);
    ArrivingShare share;
    Sight sight;
    Real t = 0;
    for (uint32_t layer = 0;; ++layer) {
      sight.passed = find_nearest_hit(scene_, ray, sight);
      const bool is_through = !sight.passed.exists();
      const Real end = is_through ? ray.tmax : sight.passed.t;
      if (end < kInfinity) share.value *= media.left_after((end - t) * length);
      if (is_through) return share;
      t = end;
      const Coverage covered = coverage_in_shadow(ray, sight.passed, of_ray);
      Vector left(1 - covered.value);
      if (glass_of(material_of(scene_, sight.passed)).is_clear && covered.value > 0) {
        left += covered.value * share_of_glass(ray, sight.passed, of_ray, media);
      }
      share.error = std::max(largest(share.value), share.error) * covered.error + share.error * largest(left);
      share.value = layer < kMostLayers ? share.value * left : Vector(0);
      // Near the smallest fraction, a device may decide differently.
      if (std::abs(largest(share.value) - kLeastShareBehind) < 1e-4L * kLeastShareBehind)
        share.error += kLeastShareBehind;
      if (largest(share.value) < kLeastShareBehind) share.value = Vector(0);
      if (share.error < 1e-9L) share.error = 0;
      if (share.value == Vector(0) && share.error == 0) return share;
    }
  }

  /// Returns the fraction of the source's light that reaches the point, and the error that a device may have.
  /// The source is at a place, or at infinity.
  ArrivingShare arriving_share(const SurfacePoint& point, const Vector& to_light, const std::optional<Vector>& place,
                               const PointError& error, const Media& media) const {
    // If the surface scatters light to its other side, the shadow ray starts on the side of the light.
    const bool begins_behind = scatters_through(*point.material) && glm::dot(point.geometric_normal, to_light) < 0;
    const Vector origin = begins_behind ? point.position - point.lift * point.geometric_normal
                                        : point.shadow_position + point.lift * point.geometric_normal;
    const Ray ray = place ? Ray{origin, *place - origin, 0, 1} : Ray{origin, to_light};
    const RayError of_ray{error.position, 4 * kRoundoff};
    if (has_glass_) return share_through_glass(ray, of_ray, media);
    Coverage share;
    Sight sight;
    for (uint32_t layer = 0; share.value > 0 || share.error > 0; ++layer) {
      sight.passed = find_nearest_hit(scene_, ray, sight);
      if (!sight.passed.exists()) break;
      if (layer >= kMostLayers) return {Vector(0), 0};
      const Coverage covered = coverage_in_shadow(ray, sight.passed, of_ray);
      share.error = std::max(share.value, share.error) * covered.error + share.error * (1 - covered.value);
      share.value *= 1 - covered.value;
      if (share.value < kLeastShareBehind) share.value = 0;
      if (share.error < 1e-9L) share.error = 0;
    }
    return {Vector(share.value), share.error};
  }

  static std::optional<SmoothLobe> lobe_of(const SurfacePoint& point, const SlotTexels& texels,
                                           const Vector& direction) {
    const auto* material = std::get_if<MetallicRoughness>(&point.material->model);
    if (material == nullptr) return std::nullopt;
    Real roughness = material->clearcoat > 0 ? material->clearcoat_roughness * texels[kCoatRoughnessSlot].g
                                             : material->roughness * texels[kMetallicRoughnessSlot].g;
    if (point.is_after_diffusion) roughness = std::max(roughness, kRoughnessAfterDiffusion);
    return SmoothLobe{point.normal, -direction, std::max(roughness * roughness, 0.002L)};
  }

  std::vector<ArrivingLight> arriving_lights(const SurfacePoint& point, const PointError& error, const Way& way,
                                             const std::optional<SmoothLobe>& lobe) const {
    // With a normal texture, a light slightly behind the geometric surface can light the front.
    const bool has_normals = point.slots[kNormalSlot].exists() || point.slots[kCoatNormalSlot].exists();
    std::vector<ArrivingLight> arriving;
    // Each light has its own pair of dimensions for each ray of the sample.
    auto pair = static_cast<uint32_t>(way.step * source_count() + (has_lens_ ? 1 : 0));
    const auto is_behind = [&](const Vector& to_light) {
      return !has_normals && !scatters_through(*point.material) && !(glm::dot(point.normal, to_light) > 0);
    };
    const auto add_light = [&](const Light& light, const std::array<Real, 2>& u, Real chance) {
      const Illumination illumination =
          has_size(light) ? illuminate_sized(light, point.position, u, lobe) : illuminate(light, point.position);
      if (is_behind(illumination.to_light) || !(illumination.strength > 0)) return;
      const Vector source =
          has_size(light) ? point.position + illumination.distance * illumination.to_light : Vector(light.position);
      const std::optional<Vector> place = has_place(light.kind) ? std::optional(source) : std::nullopt;
      const ArrivingShare share = arriving_share(point, illumination.to_light, place, error, way.media);
      if (share.value == Vector(0) && share.error == 0) return;
      const Real strength = illumination.strength / chance;
      arriving.push_back({&light, illumination.to_light, illumination.distance, share.value * strength,
                          share.error * strength, std::nullopt});
    };
    if (!chooses_lights()) {
      for (const Light& light : scene_.lights) add_light(light, sample_pair(way.sample, pair++), 1);
    }
    for (size_t source = 0; emitters_ && source < emitters_->source_count(); ++source) {
      const Emitters::Choice choice = emitters_->choose(source, way.sample, pair++);
      if (choice.emitter.is_light()) {
        add_light(scene_.lights[choice.emitter.light], choice.u, choice.chance);
      } else {
        const LampPoint lamp = emitters_->sample(choice.emitter, point.position, point.geometric_normal, choice.u);
        if (!is_behind(lamp.place - point.position)) add_lamp(point, choice, lamp, error, way, arriving);
      }
    }
    return arriving;
  }

  bool chooses_lights() const { return emitters_ && emitters_->are_lights_chosen(); }

  /// Returns the number of sources, each of which has its own pair of dimensions for each ray of a sample.
  size_t source_count() const {
    const size_t lights = chooses_lights() ? 0 : scene_.lights.size();
    const size_t sky = surroundings_.is_source() && sky_light_.exists() ? 1 : 0;
    return lights + (emitters_ ? emitters_->source_count() : 0) + sky;
  }

  /// Adds a point of an emissive surface as a source. The shadow ray ends before the surface.
  void add_lamp(const SurfacePoint& point, const Emitters::Choice& choice, const LampPoint& lamp,
                const PointError& error, const Way& way, std::vector<ArrivingLight>& arriving) const {
    static const Light kSurface = {.name = ""};
    const Vector to_lamp = lamp.place - point.position;
    const Real distance = glm::length(to_lamp);
    const Hit hit{distance, choice.emitter.object, choice.emitter.primitive, lamp.u, lamp.v, lamp.normal};
    const Material& material = material_of(scene_, hit);
    const bool is_of_back = glm::dot(lamp.normal, to_lamp) > 0;
    const world::Shape& shape = scene_.objects[static_cast<size_t>(hit.object)].shape;
    if (is_of_back && std::holds_alternative<Mesh>(shape) && !shows_backs(material)) return;
    const Real scale = distance + bounding_sphere(shape, hit.primitive).radius + glm::length(lamp.place);
    const Vector end = lamp.place + (is_of_back ? -1 : 1) * 0x1p-50L * scale * lamp.normal;
    const Vector to_light = to_lamp / distance;
    const ArrivingShare share = arriving_share(point, to_light, end, error, way.media);
    const Vector radiance = emission_of(hit, material, std::abs(glm::dot(lamp.normal, to_light)));
    const Real strength = emitters_->radiance_factor() * lamp.inverse_density / choice.chance;
    if (strength == 0 || radiance == Vector(0) || (share.value == Vector(0) && share.error == 0)) return;
    arriving.push_back(
        {&kSurface, to_light, distance, share.value * strength, share.error * strength, radiance, false});
  }

  /// Returns the radiance of a point of an emissive surface, at an angle with this cosine to its normal. Textures have
  /// their finest level.
  Vector emission_of(const Hit& hit, const Material& material, Real cosine) const {
    TrianglePoint at;
    at.mesh = std::get_if<Mesh>(&scene_.objects[static_cast<size_t>(hit.object)].shape);
    at.triangle = hit.primitive;
    at.u = hit.u;
    at.v = hit.v;
    const auto look_up = [&](Slot slot) {
      const Slots slots = slots_of(material);
      return textures_.shows(slots[slot], at) ? textures_.look_up(slots[slot], at).value : Texel(1);
    };
    Vector radiance = Vector(material.emissive) * Vector(look_up(kEmissionSlot));
    const Real alpha = alpha_of(material, at).value;
    if (material.alpha_mode == AlphaMode::kBlend) radiance *= alpha;
    if (material.alpha_mode == AlphaMode::kMask && alpha < material.alpha_cutoff) return Vector(0);
    const auto* model = std::get_if<MetallicRoughness>(&material.model);
    if (model != nullptr && model->clearcoat > 0) {
      const Real fresnel = 0.04L + 0.96L * std::pow(1 - cosine, Real(5));
      radiance *= 1 - model->clearcoat * look_up(kCoatSlot).r * fresnel;
    }
    return radiance;
  }

  /// Adds the environment as a source: the light of one direction, divided by the sum of the densities of all ways to
  /// choose it.
  void add_sky(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
               const Way& way, std::vector<ArrivingLight>& arriving) const {
    if (!surroundings_.is_source() || !sky_light_.exists()) return;
    const SkyWays ways = sky_ways(point, texels, direction, error, surroundings_);
    // The environment is the last source.
    const auto pair = static_cast<uint32_t>((way.step + 1) * source_count() - 1 + (has_lens_ ? 1 : 0));
    std::array<Real, 2> u = sample_pair(way.sample, pair);
    const Real of_lobes = ways.coat.share + ways.material.share;
    const Real of_back = (1 - of_lobes) * ways.behind;
    // The shares of u[0]: the coat, the material, the back and the front.
    const std::array<Real, 5> ends = {0, ways.coat.share, of_lobes, of_lobes + of_back, 1};
    size_t chosen = 0;
    while (chosen < 3 && u[0] >= ends[chosen + 1]) ++chosen;
    u[0] = (u[0] - ends[chosen]) / (ends[chosen + 1] - ends[chosen]);
    const bool is_behind = chosen == 2;
    const SmoothLobe coat{ways.coat.normal, -direction, ways.coat.alpha};
    const SmoothLobe material{ways.material.normal, -direction, ways.material.alpha};
    const Vector normal = is_behind ? -ways.normal : ways.normal;
    const Vector to_light = chosen == 0   ? coat.place(u)
                            : chosen == 1 ? material.place(u)
                                          : sky_light_.choose(normal, u).direction;
    Real density = (is_behind ? of_back : 1 - of_lobes - of_back) * sky_light_.density(normal, to_light);
    if (!is_behind && ways.coat.share > 0) density += ways.coat.share * coat.density(to_light);
    if (!is_behind && ways.material.share > 0) density += ways.material.share * material.density(to_light);
    if (!(density > 0)) return;
    static const Light kAtInfinity = {.name = "", .kind = LightKind::kDirectional};
    const ArrivingShare share = arriving_share(point, to_light, {}, error, way.media);
    if (share.value == Vector(0) && share.error == 0) return;
    arriving.push_back({&kAtInfinity, to_light, kInfinity, share.value / density, share.error / density,
                        sky_light_.radiance(to_light), true});
  }

  /// The response of a surface to light, with the errors that its textures cause. The error of each texture is computed
  /// separately.
  struct BoundedResponse : Response {
    Real weight_error = 0;
    Real normal_error = 0;
    Real through_error = 0;
    Real direction_error = 0;
  };
  BoundedResponse respond_with_textures(const SurfacePoint& point, const Vector& direction, const PointError& error,
                                        const Way& way) const {
    SlotTexels texels;
    SlotTexels errors;
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      const Shown shown = textures_.look_up(point.slots[slot], point.on_triangle);
      texels[slot] = shown.value;
      errors[slot] = shown.error;
    }
    std::vector<ArrivingLight> lights = arriving_lights(point, error, way, lobe_of(point, texels, direction));
    add_sky(point, texels, direction, error, way, lights);
    BoundedResponse bounded{respond(point, texels, direction, error, lights, surroundings_)};
    if (point.face) add_errors_of_face(point, texels, direction, error, bounded);
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      if (errors[slot] == Texel(0)) continue;
      const Response whole = bounded;
      for (const Real sign : {-1, 1}) {
        SlotTexels off = texels;
        off[slot] = glm::clamp(off[slot] + sign * errors[slot], Real(0), Real(1));
        const Response other = respond(point, off, direction, error, lights, surroundings_);
        add_difference(whole, other, bounded);
      }
    }
    return bounded;
  }
  /// Returns the error of the angle between a ray and the normal, as a normal that is tilted to one side.
  static Vector tilt_of(const SurfacePoint& point, const Vector& direction, const PointError& error) {
    const Vector across = direction - glm::dot(direction, point.normal) * point.normal;
    if (!(glm::length(across) > 1e-9L)) return Vector(0);
    return (error.normal + error.to_eye + 8 * kRoundoff) * glm::normalize(across);
  }
  /// Adds errors of a face. Its reflection depends on the angle, strongly near total reflection.
  void add_errors_of_face(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction,
                          const PointError& error, BoundedResponse& bounded) const {
    const Vector tilt = tilt_of(point, direction, error);
    const Response whole = bounded;
    for (const Real sign : {-1, 1}) {
      SurfacePoint turned = point;
      turned.normal = glm::normalize(point.normal + sign * tilt);
      const Response other = respond(turned, texels, direction, error, {}, surroundings_);
      bounded.weight_error =
          std::max(bounded.weight_error, largest_difference(other.mirror_weight, whole.mirror_weight));
      bounded.through_error = std::max(bounded.through_error, largest_difference(other.through, whole.through));
      // On total reflection there is no refracted ray.
      const bool go_both = !other.beyond.is_total && !whole.beyond.is_total;
      const Real apart = go_both ? glm::distance(other.beyond.direction, whole.beyond.direction) : Real(0);
      bounded.direction_error = std::max(bounded.direction_error, apart);
    }
  }
  static void add_difference(const Response& whole, const Response& other, BoundedResponse& bounded) {
    bounded.sent.error += largest_difference(other.sent.color, whole.sent.color);
    bounded.instead.error += largest_difference(other.instead.color, whole.instead.color);
    bounded.weight_error += largest_difference(other.mirror_weight, whole.mirror_weight);
    bounded.normal_error += glm::distance(other.mirror_normal, whole.mirror_normal);
    bounded.through_error += largest_difference(other.through, whole.through);
    bounded.direction_error += glm::distance(other.beyond.direction, whole.beyond.direction);
  }

  /// Returns the radiance of a ray that hits nothing.
  Radiance beyond(const Ray& ray, const Way& way) const {
    Radiance seen;
    seen.add(Vector(way.environment_share), whole_beyond(ray, way));
    return seen;
  }
  Radiance whole_beyond(const Ray& ray, const Way& way) const {
    const Environment& environment = scene_.environment;
    if (!way.is_mirrored && !(surroundings_.has_sky() && environment.shows_sky)) {
      return {Vector(environment.background)};
    }
    if (!surroundings_.has_sky()) return {Vector(way.is_of_metal ? environment.ambient : environment.background)};
    return {surroundings_.lobe_mean(glm::normalize(ray.direction), way.roughness), 0,
            surroundings_.map_error(way.roughness)};
  }

  Radiance trace_hit(const Ray& ray, const Hit& hit, const Way& way) const {
    if (!hit.exists()) return beyond(ray, way);
    const PointError error = error_at(scene_, ray, hit, way.error);
    Media beyond;
    const SurfacePoint point = make_surface_point(ray, hit, way, error, beyond);
    const Coverage coverage = coverage_of(*point.material, point.on_triangle);
    const Vector behind = way.weight * (1 - coverage.value);
    const bool goes_on = coverage.value < 1 && way.layers < kMostLayers && largest(behind) >= kLeastShareBehind;
    const Radiance seen = scatters_ ? trace_scattered(ray, hit, point, error, way, beyond, goes_on)
                          : has_glass_ && !goes_on
                              ? trace_glass(ray, hit, point, error, way, beyond)
                              : trace_surface(ray, hit, point, error, way, goes_on ? 0 : way.bounces);
    if (!goes_on) return seen;
    Radiance blended;
    blended.add(coverage.value * way.media.left_after(hit.t * glm::length(ray.direction)), seen);
    Way on = way;
    ++on.layers;
    on.weight = behind;
    const Radiance beyond_it = trace(ray, find(ray, on, {.passes_backs = true, .passed = hit}), on);
    blended.add(Vector(1 - coverage.value), beyond_it);
    blended.error += coverage.error * largest_difference(seen.color, beyond_it.color);
    return blended;
  }

  Radiance trace_surface(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error,
                         const Way& way, uint32_t bounces) const {
    const Vector direction = glm::normalize(ray.direction);
    const BoundedResponse response = respond_with_textures(point, direction, error, way);
    Radiance sum = response.sent;
    const Real weight = largest(response.mirror_weight);
    if (weight == 0) return sum;
    const bool is_of_metal = std::holds_alternative<MetallicRoughness>(point.material->model);
    if (bounces == 0 || (is_of_metal && weight < kLeastMirrorWeight)) {
      sum.add(response.instead);
      return sum;
    }
    const Sent mirrored = send_mirrored(ray, hit, point, error, way, response);
    const Radiance brought =
        trace(mirrored.ray, find(mirrored.ray, mirrored.way, {.passes_backs = true}), mirrored.way);
    sum.add(response.mirror_weight, brought);
    sum.error += response.weight_error * largest(brought.color);
    return sum;
  }

  SlotTexels look_up_textures(const SurfacePoint& point) const {
    SlotTexels texels;
    for (size_t slot = 0; slot < kSlotCount; ++slot) {
      texels[slot] = textures_.look_up(point.slots[slot], point.on_triangle).value;
    }
    return texels;
  }

  /// Returns the light of a point and of one ray in which it scatters light (Integrator::kPath). A point that blends
  /// with the surface behind it scatters none.
  Radiance trace_scattered(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error,
                           const Way& way, const Media& beyond, bool blends) const {
    const Vector direction = glm::normalize(ray.direction);
    const BoundedResponse response = respond_with_textures(point, direction, error, way);
    const Vector left = blends ? Vector(1) : way.media.left_after(hit.t * glm::length(ray.direction));
    Radiance sum = response.sent;
    Radiance dimmed;
    if (blends || way.bounces == 0) {
      if (response.mirror_weight != Vector(0)) sum.add(response.instead);
      dimmed.add(left, sum);
      return dimmed;
    }
    const SlotTexels texels = look_up_textures(point);
    const Scattered scattered = scatter(point, texels, direction, error, surroundings_,
                                        sample_pair(way.sample, kFirstDirectionPair + way.step));
    const bool is_of_body = scattered.lobe == kDiffuseLobe || scattered.lobe == kBehindLobe;
    const bool is_beyond = scattered.lobe == kBehindLobe || scattered.lobe == kGlassLobe;
    const Real outside = glm::dot(scattered.direction, point.geometric_normal);
    if (scattered.weight == Vector(0) || (is_of_body && (is_beyond ? -outside : outside) <= 0)) {
      dimmed.add(left, sum);
      return dimmed;
    }
    Way here = way;
    here.weight *= left;
    // The state of the path is that of a mirror ray or of a refracted ray, in another direction.
    BoundedResponse single = response;
    single.mirror_weight = single.through = scattered.weight;
    single.mirror_roughness = single.blur = 0;
    single.is_deflected = response.is_deflected && !way.is_diffused;
    Sent next = scattered.lobe == kGlassLobe ? send_beyond(ray, hit, point, error, here, single, beyond)
                                             : send_mirrored(ray, hit, point, error, here, single);
    next.ray.direction = scattered.direction;
    if (is_of_body) {
      next.ray.origin = is_beyond ? point.position - point.lift * point.geometric_normal
                                  : point.shadow_position + point.lift * point.geometric_normal;
      next.way.error.direction = error.normal + response.normal_error + 8 * kRoundoff;
    }
    next.way.is_diffused = way.is_diffused || is_of_body;
    if (scattered.lobe != kGlassLobe || !way.is_diffused) next.way.environment_share = scattered.environment_share;
    const Radiance brought = trace(next.ray, find(next.ray, next.way, {.passes_backs = true}), next.way);
    sum.add(scattered.weight, brought);
    dimmed.add(left, sum);
    return dimmed;
  }

  /// A ray that continues from a point.
  struct Sent {
    Ray ray;
    Way way;
  };

  Sent send_mirrored(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error, const Way& way,
                     const BoundedResponse& response) const {
    const Vector direction = glm::normalize(ray.direction);
    const bool is_of_metal = std::holds_alternative<MetallicRoughness>(point.material->model);
    const Ray next{point.position + point.lift * point.geometric_normal,
                   mirror(point, response.mirror_normal, direction)};
    Way on = way;
    on.bounces = way.bounces - 1;
    on.weight *= response.mirror_weight;
    on.is_mirrored = true;
    on.is_of_metal = way.is_of_metal || is_of_metal;
    on.roughness = std::max(way.roughness, response.mirror_roughness);
    on.cone.width = way.cone.width + way.cone.spread * hit.t * glm::length(ray.direction);
    // An interpolated normal may face away from the eye.
    const Real cosine = std::max(-glm::dot(point.normal, direction), kLeastCosine);
    on.cone.spread += 2 * point.side * curvature_of(point.on_triangle) * on.cone.width / cosine;
    on.error = {error.position, way.error.direction + 2 * (error.normal + response.normal_error)};
    return {next, on};
  }

  Sent send_beyond(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error, const Way& way,
                   const BoundedResponse& response, const Media& beyond) const {
    Way on = way;
    on.bounces = way.bounces - 1;
    on.weight *= response.through;
    on.media = beyond;
    if (response.is_deflected) {
      on.is_mirrored = true;
      on.is_of_metal = way.is_of_metal || std::holds_alternative<MetallicRoughness>(point.material->model);
      on.roughness = std::max(way.roughness, response.blur);
    }
    const Real bend = point.face->is_thin ? Real(1) : point.face->from / point.face->to;
    on.cone.width = way.cone.width + way.cone.spread * hit.t * glm::length(ray.direction);
    on.cone.spread = bend * way.cone.spread + (bend - 1) * point.side * curvature_of(point.on_triangle) * on.cone.width;
    // The error of the direction grows as the refraction bends a bundle of rays, and as the normal of the face changes.
    on.error = {error.position, way.error.direction * bend_of_angles(response.beyond, bend) + response.direction_error};
    return {Ray{point.position - point.lift * point.geometric_normal, response.beyond.direction}, on};
  }
  static Real bend_of_angles(const Refraction& at, Real bend) {
    return std::max(Real(1), bend * at.cosine / std::max(at.cosine_beyond, 1e-6L));
  }

  /// One of the rays that continue from a point in a scene with glass, and the weight of its radiance.
  struct Child {
    Sent sent;
    Vector weight;
    Real weight_error = 0;
    bool is_followed = false;
  };

  /// Adds the refracted ray, or one refracted ray for each colour if the face disperses light.
  void add_refracted(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error, const Way& way,
                     const BoundedResponse& response, const Media& beyond, std::vector<Child>& children) const {
    const auto face_of = [&](int color) {
      Media unused;
      return way.media.meet(*point.material, point.side < 0, color, unused);
    };
    const auto count = std::count_if(&way.weight[0], &way.weight[0] + 3, [](Real weight) { return weight > 0; });
    const Face red = face_of(0);
    const Face blue = face_of(2);
    const bool is_bent = !point.face->is_thin && point.face->from != point.face->to;
    if (count < 2 || !is_bent || (red.from == blue.from && red.to == blue.to)) {
      children.push_back(
          {send_beyond(ray, hit, point, error, way, response, beyond), response.through, response.through_error});
      return;
    }
    const Vector direction = glm::normalize(ray.direction);
    const Vector tilt = tilt_of(point, direction, error);
    for (int color = 0; color < 3; ++color) {
      BoundedResponse colored = response;
      colored.through = Vector(0);
      colored.through[color] = response.through[color];
      if (colored.through == Vector(0)) continue;
      SurfacePoint with_face = point;
      with_face.face = face_of(color);
      colored.beyond = refract(direction, response.refracting_normal, point.geometric_normal, *with_face.face);
      Real through_error = response.through_error;
      for (const Real sign : {-1, 1}) {
        const Vector turned = glm::normalize(response.refracting_normal + sign * tilt);
        const Refraction other = refract(direction, turned, point.geometric_normal, *with_face.face);
        // Near the angle of total reflection, a device may decide differently.
        if (other.is_total != colored.beyond.is_total) through_error += kUnknown;
        colored.direction_error =
            std::max(colored.direction_error, glm::distance(other.direction, colored.beyond.direction));
      }
      if (colored.beyond.is_total) {
        // Colours that are reflected totally continue in the mirror ray while others do not.
        colored.mirror_weight = colored.through;
        colored.weight_error = through_error;
        children.push_back({send_mirrored(ray, hit, point, error, way, colored), colored.through, through_error});
      } else {
        children.push_back(
            {send_beyond(ray, hit, with_face, error, way, colored, beyond), colored.through, through_error});
      }
    }
  }

  /// Returns the radiance of both rays of a scene with glass, within the limits of the tree.
  Radiance trace_glass(const Ray& ray, const Hit& hit, const SurfacePoint& point, const PointError& error,
                       const Way& way, const Media& beyond) const {
    const BoundedResponse response = respond_with_textures(point, glm::normalize(ray.direction), error, way);
    const Vector left = way.media.left_after(hit.t * glm::length(ray.direction));
    Way here = way;
    here.weight *= left;
    const bool is_of_metal = std::holds_alternative<MetallicRoughness>(point.material->model);
    Radiance sum = response.sent;
    const Real weight = largest(response.mirror_weight);
    const bool is_mirrored = way.bounces > 0 && weight > (is_of_metal ? kLeastMirrorWeight : 0);
    if (!is_mirrored) sum.add(response.instead);
    std::vector<Child> children;
    if (is_mirrored) {
      children.push_back(
          {send_mirrored(ray, hit, point, error, here, response), response.mirror_weight, response.weight_error});
    }
    if (response.through != Vector(0)) add_refracted(ray, hit, point, error, here, response, beyond, children);
    // All rays are counted before any of them is followed.
    for (Child& child : children) {
      const Real least = largest(child.sent.way.weight);
      child.is_followed = way.bounces > 0 && *way.rays < kMostTreeRays && least >= kLeastTreeWeight;
      if (child.is_followed) ++*way.rays;
      // Near the smallest weight, a device may decide differently.
      if (std::abs(least - kLeastTreeWeight) < 1e-4L * kLeastTreeWeight) sum.error += kUnknown;
    }
    for (const Child& child : children) {
      const Sent& sent = child.sent;
      Radiance brought;
      if (child.is_followed) {
        brought = trace(sent.ray, find(sent.ray, sent.way, {.passes_backs = true}), sent.way);
      } else if (is_of_metal) {
        brought = this->beyond(sent.ray, sent.way);
      }
      sum.add(child.weight, brought);
      sum.error += child.weight_error * (largest(brought.color) + 1);
    }
    Radiance dimmed;
    dimmed.add(left, sum);
    return dimmed;
  }

  const world::Scene& scene_;
  bool has_lens_;
  Textures textures_;
  Surroundings surroundings_;
  SkyLight sky_light_;
  bool scatters_;
  std::optional<Emitters> emitters_;
  bool has_glass_;
};

/// Returns the size of a shape. For a mesh it is the size of its box.
Real size_of(const world::Shape& shape) {
  const Mesh* mesh = std::get_if<Mesh>(&shape);
  if (mesh == nullptr)
    return std::holds_alternative<world::Plane>(shape) ? kInfinity : bounding_sphere(shape, 0).radius;
  Vector lo(kInfinity);
  Vector hi(-kInfinity);
  for (const vec3& position : mesh->positions) {
    lo = glm::min(lo, Vector(position));
    hi = glm::max(hi, Vector(position));
  }
  return glm::distance(lo, hi) / 2;
}

/// Returns the media around the camera: the solids of glass that contain it, the largest first. A ray from inside a
/// solid in an irregular direction leaves the solid once more than it enters it.
Media media_around(const world::Scene& scene, const Vector& eye) {
  struct Around {
    Real size;
    const Material* material;
  };
  std::vector<Around> around;
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    world::Scene alone = scene;
    alone.objects = {scene.objects[i]};
    Ray ray{eye, Vector(0.8017L, 0.2673L, 0.5345L)};
    Sight sight;
    int inside = 0;
    for (;;) {
      sight.passed = find_nearest_hit(alone, ray, sight);
      if (!sight.passed.exists()) break;
      inside += glm::dot(sight.passed.normal, ray.direction) > 0 ? 1 : -1;
      if (std::holds_alternative<world::Plane>(alone.objects[0].shape)) break;
    }
    const Material& material = scene.materials[scene.objects[i].material];
    const auto* tube = std::get_if<world::Cylinder>(&scene.objects[i].shape);
    const auto* cone = std::get_if<world::Cone>(&scene.objects[i].shape);
    if ((tube != nullptr && tube->is_open) || (cone != nullptr && cone->is_open)) continue;
    if (inside > 0 && glass_of(material).is_clear && !glass_of(material).is_thin)
      around.push_back({size_of(scene.objects[i].shape), &material});
  }
  std::sort(around.begin(), around.end(), [](const Around& a, const Around& b) { return a.size > b.size; });
  Media media;
  for (const Around& each : around) {
    Media beyond;
    (void)media.meet(*each.material, false, kGreen, beyond);
    media = beyond;
  }
  return media;
}

/// Returns the cone of a pixel at the camera.
Cone camera_cone(const Camera& camera, const uvec2& size) {
  if (camera.projection == Projection::kOrthographic) return {2 * Real(camera.ymag) / size.y, 0};
  return {0, 2 * std::tan(Real(camera.yfov) / 2) / size.y};
}

}  // namespace

namespace {

/// Returns the ray through a position on the picture, in pixels from its upper left corner.
Ray ray_through(const Camera& camera, const uvec2& size, const std::array<Real, 2>& at,
                const std::optional<std::array<Real, 2>>& on_lens) {
  const bool is_orthographic = camera.projection == Projection::kOrthographic;
  const double half_height =
      is_orthographic ? static_cast<double>(camera.ymag) : std::tan(0.5 * static_cast<double>(camera.yfov));
  const double pixel = 2.0 * half_height / size.y;
  const vec3 right(pixel * glm::cross(dvec3(camera.look), dvec3(camera.up)));
  const vec3 up(pixel * dvec3(camera.up));
  const Vector on_film = (at[0] - size.x / 2.0L) * Vector(right) + (size.y / 2.0L - at[1]) * Vector(up);
  // The interval is open, so it begins just before the viewport.
  const Real tmin = std::nextafter(Real(camera.near), -kInfinity);
  const Vector eye(camera.eye);
  const Vector look(camera.look);
  Ray ray = is_orthographic ? Ray{eye + on_film, look, tmin} : Ray{eye, look + on_film, tmin};
  if (on_lens) {
    // The ray still goes through the same point of the plane in focus.
    const Vector in_focus = ray.origin + Real(camera.focus_distance) * ray.direction;
    const auto [x, y] = place_on_disc(*on_lens);
    ray.origin += Real(camera.aperture_radius) * (x * glm::normalize(Vector(right)) + y * glm::normalize(Vector(up)));
    ray.direction = (in_focus - ray.origin) / Real(camera.focus_distance);
  }
  return ray;
}

}  // namespace

Ray camera_ray(const Camera& camera, const uvec2& size, uint32_t x, uint32_t y) {
  return ray_through(camera, size, {x + 0.5L, y + 0.5L}, {});
}

Picture render(const world::Scene& scene, const View& view) {
  return render(scene, view, [](const uvec2& /*pixel*/) { return SampleChoice(); });
}

Picture render(const world::Scene& scene, const View& view,
               const std::function<SampleChoice(const uvec2& pixel)>& place_of) {
  world::Scene lit = scene;
  std::erase_if(lit.lights, [](const Light& light) { return !light.is_on; });
  for (Light& light : lit.lights) {
    if (light.kind != LightKind::kHeadlight) continue;
    light.kind = LightKind::kDirectional;
    light.direction = view.camera.look;
  }
  const Tracer tracer(lit, has_lens(view.camera), view.mode.integrator);
  Way of_camera;
  of_camera.bounces = view.max_depth;
  of_camera.cone = camera_cone(view.camera, view.size);
  of_camera.error = {0, kCameraRayError};
  if (view.camera.projection == Projection::kPerspective) of_camera.media = media_around(lit, Vector(view.camera.eye));
  Picture picture;
  picture.size = view.size;
  picture.pixels.resize(static_cast<size_t>(view.size.x) * view.size.y);
  for_each_index(view.size.y, 0, [&](size_t row) {
    const auto y = static_cast<uint32_t>(row);
    Way way = of_camera;
    for (uint32_t x = 0; x < view.size.x; ++x) {
      Pixel& pixel = picture.pixels[row * view.size.x + x];
      uint32_t rays = 0;
      uint32_t steps = 0;
      way.rays = &rays;
      way.steps = &steps;
      const SampleChoice choice = place_of(uvec2(x, y));
      way.sample = {uvec2(x, y), choice.number, view.seed, choice.is_refined};
      std::optional<std::array<Real, 2>> on_lens;
      if (has_lens(view.camera)) on_lens = sample_pair(way.sample, 0);
      pixel.ray = ray_through(view.camera, view.size, {x + choice.place[0], y + choice.place[1]}, on_lens);
      const Seen seen = tracer.find(pixel.ray, way, {.passes_backs = true});
      pixel.hit = seen.hit;
      pixel.is_at_cutoff = seen.is_at_cutoff;
      const Radiance light = tracer.trace(pixel.ray, seen, way);
      pixel.color = light.color;
      pixel.explained_error = light.error;
      pixel.map_error = light.map_error;
    }
  });
  return picture;
}

}  // namespace promin::oracle
