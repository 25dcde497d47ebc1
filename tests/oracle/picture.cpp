// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <variant>

#include "core/parallel.h"
#include "oracle/distance.h"
#include "oracle/lobe.h"
#include "oracle/normal_error.h"
#include "oracle/verdict.h"
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
  point.material = &material_of(scene, hit);
  if (const Mesh* mesh = std::get_if<Mesh>(&object.shape)) {
    const auto triangle = static_cast<size_t>(hit.primitive);
    const Corners corners{mesh->triangles[triangle], {1 - hit.u - hit.v, hit.u, hit.v}};
    if (!mesh->normals.empty()) apply_vertex_normals(*mesh, corners, side, point);
    if (!mesh->colors.empty()) point.vertex_color = corners.interpolate(mesh->colors);
  }
  return point;
}

/// The share of a source's power that its shape and distance leave, and where it lies.
struct Illumination {
  Vector to_light{0};
  Real strength = 1;
  /// Infinite for a source without a place.
  Real distance = kInfinity;
};

Illumination illuminate(const Light& light, const Vector& position) {
  const Vector axis = glm::normalize(Vector(light.direction));
  if (!has_place(light.kind)) return {-axis};
  const Vector offset = Vector(light.position) - position;
  const Real distance = glm::length(offset);
  Illumination result{offset / distance, 1, distance};
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

/// A ray goes through so many surfaces that blend, and on where it sees so much of what is behind them.
constexpr uint32_t kMostLayers = 64;
constexpr Real kLeastShareBehind = 1.0L / 1024;

/// How much of what is behind it the material covers, as there are no textures here (glTF 2.0, 3.9.4).
Real coverage_of(const Material& material) {
  if (material.alpha_mode == AlphaMode::kBlend) return material.alpha;
  return material.alpha_mode == AlphaMode::kMask && material.alpha < material.alpha_cutoff ? 0 : 1;
}

/// The share of the source's light that reaches the point.
Real arriving_share(const world::Scene& scene, const SurfacePoint& point, const Light& light, const Vector& to_light) {
  const Vector origin = point.shadow_position + point.lift * point.geometric_normal;
  const Ray ray = has_place(light.kind) ? Ray{origin, Vector(light.position) - origin, 0, 1} : Ray{origin, to_light};
  Real share = 1;
  Sight sight;
  for (uint32_t layer = 0; share > 0; ++layer) {
    sight.passed = find_nearest_hit(scene, ray, sight);
    if (!sight.passed.exists()) return share;
    share *= layer < kMostLayers ? 1 - coverage_of(material_of(scene, sight.passed)) : 0;
    if (share < kLeastShareBehind) share = 0;
  }
  return share;
}

/// How far a device may have the point and the directions from it, because it rounds: lengths in scene units, and
/// angles.
struct PointError {
  Real position = 0;
  Real normal = 0;
  Real to_eye = 0;
};

/// Light, and how far a device may be off it because its highlights lie a little aside.
struct Radiance {
  Vector color{0};
  Real error = 0;

  void add(const Radiance& other) { add(Vector(1), other); }
  void add(const Vector& weight, const Radiance& other) {
    color += weight * other.color;
    error += std::max({weight.x, weight.y, weight.z}) * other.error;
  }
};

/// How a material answers the light at one point, seen from one eye. Each model has these functions.
class PhongSurface {
 public:
  PhongSurface(const Phong& phong, const SurfacePoint& point, const Vector& to_eye, const PointError&)
      : phong_(phong), point_(point), to_eye_(to_eye) {}

  /// What is sent without any source or mirror ray.
  Vector own(const Vector& emissive, const Vector& ambient) const {
    return emissive + Vector(phong_.ambient) * point_.vertex_color * ambient;
  }
  /// What a source adds where nothing is between, of strength 1.
  Radiance contribution(const Light& light, const Illumination& illumination) const {
    const Real cosine = glm::dot(point_.normal, illumination.to_light);
    Vector share = Vector(phong_.diffuse) * point_.vertex_color * Vector(light.diffuse) * cosine;
    const Real highlight = glm::dot(2 * cosine * point_.normal - illumination.to_light, to_eye_);
    if (phong_.shininess > 0 && highlight > 0) {
      share += Vector(phong_.specular) * Vector(light.specular) * std::pow(highlight, Real(phong_.shininess));
    }
    return {share};
  }
  /// The weight of what the mirror ray brings.
  Vector mirror_weight() const { return Vector(phong_.reflection); }
  /// Whether a mirror ray brings the background where it leaves the scene, and nothing where it is not traced; else
  /// both times the ambient light.
  static constexpr bool kMirrorsBackground = true;

 private:
  const Phong& phong_;
  const SurfacePoint& point_;
  Vector to_eye_;
};

class UnlitSurface {
 public:
  UnlitSurface(const Unlit& unlit, const SurfacePoint& point, const Vector&, const PointError&)
      : color_(Vector(unlit.color) * point.vertex_color) {}

  Vector own(const Vector& emissive, const Vector&) const { return emissive + color_; }
  Radiance contribution(const Light&, const Illumination&) const { return {}; }
  Vector mirror_weight() const { return Vector(0); }
  static constexpr bool kMirrorsBackground = true;

 private:
  Vector color_;
};

class MetallicRoughnessSurface {
 public:
  MetallicRoughnessSurface(const MetallicRoughness& material, const SurfacePoint& point, const Vector& to_eye,
                           const PointError& error)
      : point_(point),
        to_eye_(to_eye),
        error_(error),
        lobe_(material, point.vertex_color, look_up_lobe_shares(glm::dot(point.normal, to_eye), material.roughness)),
        sheen_(material, glm::dot(point.normal, to_eye)),
        coat_(material, glm::dot(point.normal, to_eye)) {}

  Vector own(const Vector& emissive, const Vector& ambient) const {
    const Vector base = lobe_.albedo() * ambient + (1 - lobe_.sharpness()) * lobe_.reflectance() * ambient;
    const Vector below = emissive + sheen_.reflectance() * ambient + sheen_.left() * base;
    return (1 - coat_.weight()) * below + coat_.weight() * (1 - coat_.sharpness()) * coat_.reflectance() * ambient;
  }

  Radiance contribution(const Light& light, const Illumination& illumination) const {
    const Real cosine = glm::dot(point_.normal, illumination.to_light);
    Radiance sum{lobe_.albedo() / std::numbers::pi_v<Real> * Vector(light.diffuse) * cosine};
    // From behind, as seen from the eye, there is no half vector.
    const Real apart = glm::length(to_eye_ + illumination.to_light);
    if (apart < 0x1p-12L) return sum;
    const LobeAngles angles = angles_of(point_.normal, to_eye_, illumination.to_light);
    const Real error = angle_error(illumination, apart);
    sum.add(Vector(light.specular), bound_highlight(lobe_, angles, error));
    Radiance below = sum;
    if (sheen_.exists()) {
      below = {};
      below.add(Vector(sheen_.left(cosine)), sum);
      below.add(Vector(light.specular), bound_sheen(angles, error));
    }
    Radiance coated;
    coated.add(Vector(1 - coat_.weight()), below);
    coated.add(coat_.weight() * Vector(light.specular), bound_highlight(coat_, angles, error));
    return coated;
  }

  Vector mirror_weight() const {
    return (1 - coat_.weight()) * sheen_.left() * lobe_.sharpness() * lobe_.reflectance() +
           coat_.weight() * coat_.sharpness() * coat_.reflectance();
  }
  static constexpr bool kMirrorsBackground = false;

 private:
  /// By how much any of the lobe's angles may be off.
  Real angle_error(const Illumination& illumination, Real apart) const {
    const Real to_light = 4 * kRoundoff + error_.position / illumination.distance;
    return std::min(error_.normal + (error_.to_eye + to_light) / std::min(apart, Real(1)), Real(1));
  }

  /// The lobe grows as the half vector nears the normal, l grows, v falls and V.H falls, so its largest and least
  /// values within the angles' errors are at the ends. Beside that fp32 errs by 64 u + 8 u / alpha.
  template <class AnyLobe>
  static Radiance bound_highlight(const AnyLobe& lobe, const LobeAngles& at, Real error) {
    const auto highlight_at = [&](Real step) {
      return Vector(lobe.highlight({std::clamp(at.theta - step, Real(0), std::numbers::pi_v<Real> / 2), at.v - step,
                                    std::max(at.l + step, Real(0)), std::clamp(at.v_h - step, Real(0), Real(1))}));
    };
    const Vector color(lobe.highlight(at));
    const Vector off = glm::max(highlight_at(error) - color, color - highlight_at(-error));
    const Vector rounding = (64 + 8 / lobe.alpha_of_sources()) * kRoundoff * color;
    const Vector sum = off + rounding;
    return {color, std::max({sum.x, sum.y, sum.z})};
  }

  /// A sheen has no angle at which all that it hangs on is at an end, so all corners within the errors are tried. fp32
  /// errs by a few u of exponents up to 25 and of powers.
  Radiance bound_sheen(const LobeAngles& at, Real error) const {
    const Vector color = sheen_.highlight(at);
    Real off = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const auto step = [&](int bit) { return (corner & bit) != 0 ? error : -error; };
      const LobeAngles near{std::clamp(at.theta + step(1), Real(0), std::numbers::pi_v<Real> / 2), at.v + step(2),
                            std::max(at.l + step(4), Real(1e-9L)), at.v_h};
      const Vector apart = glm::abs(sheen_.highlight(near) - color);
      off = std::max({off, apart.x, apart.y, apart.z});
    }
    return {color, off + 512 * kRoundoff * std::max({color.x, color.y, color.z})};
  }

  const SurfacePoint& point_;
  Vector to_eye_;
  PointError error_;
  Lobe lobe_;
  Sheen sheen_;
  ClearCoat coat_;
};

PhongSurface make_surface(const Phong& model, const SurfacePoint& point, const Vector& to_eye, const PointError& e) {
  return {model, point, to_eye, e};
}
UnlitSurface make_surface(const Unlit& model, const SurfacePoint& point, const Vector& to_eye, const PointError& e) {
  return {model, point, to_eye, e};
}
MetallicRoughnessSurface make_surface(const MetallicRoughness& model, const SurfacePoint& point, const Vector& to_eye,
                                      const PointError& e) {
  return {model, point, to_eye, e};
}

/// What the point sends by itself and from the visible sources.
template <class Surface>
Radiance shade(const world::Scene& scene, const SurfacePoint& point, const Surface& surface) {
  Radiance sum{surface.own(Vector(point.material->emissive), Vector(scene.environment.ambient))};
  for (const Light& light : scene.lights) {
    const Illumination illumination = illuminate(light, point.position);
    const Real cosine = glm::dot(point.normal, illumination.to_light);
    if (!(cosine > 0) || !(illumination.strength > 0)) continue;
    const Real share = arriving_share(scene, point, light, illumination.to_light);
    if (share > 0) sum.add(Vector(share * illumination.strength), surface.contribution(light, illumination));
  }
  return sum;
}

/// About the shading normal; what that would send into the surface, the surface itself mirrors back.
Vector mirror(const SurfacePoint& point, const Vector& direction) {
  const Vector mirrored = glm::reflect(direction, point.normal);
  const bool is_inward = glm::dot(mirrored, point.geometric_normal) < 0;
  return is_inward ? glm::reflect(mirrored, point.geometric_normal) : mirrored;
}

/// How far off a device's ray may be, at its origin and in its direction.
struct RayError {
  Real position = 0;
  Real direction = 0;
};

/// Of a mesh with vertex normals: that of the bent surface.
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

/// The hit's own rounding, by the bounds that hold for hits and normals, and what the ray brings.
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

/// A mirror ray of less weight is not traced where the environment can stand for what it would bring.
constexpr Real kLeastMirrorWeight = 1.0L / 256;

/// Where a ray is on its way from the eye.
struct Way {
  /// What it would bring where it leaves the scene.
  Vector beyond{0};
  /// How many mirrors may follow.
  uint32_t bounces = 0;
  /// How many surfaces it went through.
  uint32_t layers = 0;
  /// The largest part of what it brings that a pixel sees.
  Real weight = 1;
};

/// Whitted's recursion: I = what the point sends + weight of the mirror * I(mirror ray). A surface that blends brings
/// alpha of what it sends, with the environment instead of a mirror ray, and 1 - alpha of what is behind.
Radiance radiance(const world::Scene& scene, const Ray& ray, const Hit& hit, const RayError& of_ray, const Way& way) {
  if (!hit.exists()) return {way.beyond};
  const SurfacePoint point = make_surface_point(scene, ray, hit);
  const Vector direction = glm::normalize(ray.direction);
  const PointError error = error_at(scene, ray, hit, of_ray);
  const Real coverage = coverage_of(*point.material);
  const Real behind = way.weight * (1 - coverage);
  const bool goes_on = coverage < 1 && way.layers < kMostLayers && behind >= kLeastShareBehind;
  const uint32_t bounces = goes_on ? 0 : way.bounces;
  const auto follow = [&](const auto& model) {
    const auto surface = make_surface(model, point, -direction, error);
    Radiance sum = shade(scene, point, surface);
    const Vector weight = surface.mirror_weight();
    if (weight == Vector(0)) return sum;
    const Vector ambient(scene.environment.ambient);
    const bool is_faint = std::max({weight.x, weight.y, weight.z}) < kLeastMirrorWeight;
    if constexpr (surface.kMirrorsBackground) {
      if (bounces == 0) return sum;
    } else if (bounces == 0 || is_faint) {
      sum.color += weight * ambient;
      return sum;
    }
    const Ray next{point.position + point.lift * point.geometric_normal, mirror(point, direction)};
    const RayError of_next{error.position, of_ray.direction + 2 * error.normal};
    const Way on{surface.kMirrorsBackground ? way.beyond : ambient, bounces - 1, way.layers,
                 way.weight * std::max({weight.x, weight.y, weight.z})};
    sum.add(weight, radiance(scene, next, find_nearest_hit(scene, next, {.passes_backs = true}), of_next, on));
    return sum;
  };
  const Radiance seen = std::visit(follow, point.material->model);
  if (!goes_on) return seen;
  Radiance blended;
  blended.add(Vector(coverage), seen);
  const Hit next = find_nearest_hit(scene, ray, {.passes_backs = true, .passed = hit});
  blended.add(Vector(1 - coverage),
              radiance(scene, ray, next, of_ray, {way.beyond, way.bounces, way.layers + 1, behind}));
  return blended;
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

namespace {

/// Of d = look + (x right - y up) each product, the difference and the sum are rounded, and d is normalised.
constexpr Real kCameraRayError = 8 * kRoundoff;

}  // namespace

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
      pixel.hit = find_nearest_hit(lit, pixel.ray, {.passes_backs = true});
      const Radiance seen = radiance(lit, pixel.ray, pixel.hit, {0, kCameraRayError},
                                     {Vector(scene.environment.background), view.max_depth});
      pixel.color = seen.color;
      pixel.highlight_error = seen.error;
    }
  });
  return picture;
}

}  // namespace promin::oracle
