// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These cases compare refracted rays, one by one as the renderer explains them, with closed forms in long double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/rounding.h"
#include "hard/hard_case.h"
#include "oracle/glass.h"
#include "trace/render/renderer_impl.h"

namespace promin::hard {
namespace {

using oracle::Real;
using oracle::Vector;

constexpr Real kU = kUnitRoundoff;

/// Returns glass that transmits all light, without Fresnel's factor. Only total reflection causes a mirror ray.
Material clear_glass(float ior) {
  Phong phong;
  phong.ambient = phong.diffuse = vec3(0.0F);
  phong.transmission = vec3(1.0F);
  phong.ior = ior;
  Material material;
  material.model = phong;
  return material;
}

class GlassScene {
 public:
  GlassScene() { scene_.environment.background = vec3(1.0F); }

  GlassScene& add(const world::Shape& shape, float ior) {
    scene_.objects.push_back({"", shape, static_cast<uint32_t>(scene_.materials.size())});
    scene_.materials.push_back(clear_glass(ior));
    return *this;
  }
  const world::Scene& scene() const { return scene_; }

 private:
  world::Scene scene_;
};

/// Returns the rays of a sample that begins at `origin` in the direction `direction`. The first ray has the rounded
/// direction.
class GlassTracer {
 public:
  GlassTracer(const Lab& lab, const GlassScene& scene) : renderer_(make_renderer(lab.device(), scene.scene())) {}

  std::vector<ExplainedRay> follow(const dvec3& origin, const dvec3& direction, uint32_t depth = 8) {
    View view;
    view.size = uvec2(1);
    view.max_depth = depth;
    view.camera.projection = Projection::kOrthographic;
    view.camera.eye = vec3(origin);
    view.camera.look = vec3(glm::normalize(direction));
    const dvec3 aside = std::abs(view.camera.look.x) < 0.7F ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    view.camera.up = vec3(glm::normalize(glm::cross(dvec3(view.camera.look), aside)));
    view.camera.ymag = 1e-6F;
    return renderer_.explain(view, uvec2(0)).samples.front().rays;
  }

 private:
  Renderer renderer_;
};

Vector direction_of(const ExplainedRay& ray) {
  return glm::normalize(Vector(ray.ray.direction));
}

/// Returns how much the sine of an angle beyond a face changes with the sine of the angle before it, at these cosines.
Real spread_of(Real from, Real to, Real cosine, Real cosine_beyond) {
  return from * cosine / (to * std::max(cosine_beyond, Real(1e-9L)));
}

/// A ray through a sphere is turned by 2 (i - r), in the plane of the ray and the centre.
void run_spheres(Lab& lab) {
  Random random(45);
  const vec3 center(0.3F, -0.2F, 0.1F);
  for (const float ior : {1.1F, 1.5F, 2.4F}) {
    GlassScene scene;
    scene.add(world::Sphere{center, 1.0F}, ior);
    GlassTracer tracer(lab, scene);
    Real worst = 0;
    uint64_t lost = 0;
    for (const double impact : {0.0, 0.1, 0.5, 0.9, 0.99, 0.999, 0.9999}) {
      for (int i = 0; i < 8; ++i) {
        const dvec3 along = random.direction();
        const dvec3 aside = random.perpendicular(along);
        const auto rays = tracer.follow(dvec3(center) - 3.0 * along + impact * aside, along);
        if (rays.size() != 3) {
          ++lost;
          continue;
        }
        const Vector origin(rays[0].ray.origin);
        const Vector d = direction_of(rays[0]);
        const Vector from_center = origin - Vector(center);
        const Vector nearest = from_center - glm::dot(from_center, d) * d;
        const Real b = glm::length(nearest);
        const Real turn = 2 * (std::asin(b) - std::asin(b / Real(ior)));
        const Vector inward = b > 0 ? -nearest / b : Vector(0);
        const Vector expected = std::cos(turn) * d + std::sin(turn) * inward;
        // The error of the hit's place is u S / cos i along the sphere, and so is that of its normal.
        const Real scale = glm::length(origin) + 2 + glm::length(Vector(center));
        const Real unit = kU * scale / std::sqrt(std::max(1 - b * b, Real(1e-6L)));
        worst = std::max(worst, glm::distance(direction_of(rays[2]), expected) / unit);
      }
    }
    lab.expect_at_most(label("rays lost in a sphere, ior", ior), 0.0, static_cast<double>(lost));
    lab.expect_at_most(label("direction behind a sphere / (u S / (R cos i)), ior", ior), 8.0 * lab.rounding_factor(),
                       static_cast<double>(worst));
  }
}

/// A slab of thickness d keeps a ray's direction and shifts the ray by d sin(i - r) / cos r. Each face's lift shifts
/// it, too.
void run_slabs(Lab& lab) {
  Random random(46);
  for (const double thickness : {1e-3, 1.0}) {
    const auto half = static_cast<float>(0.5 * thickness);
    GlassScene scene;
    scene.add(world::Box{vec3(0.0F), vec3(10.0F, half, 10.0F), vec3(0.0F)}, 1.5F);
    GlassTracer tracer(lab, scene);
    Real worst_turn = 0;
    Real worst_shift = 0;
    uint64_t lost = 0;
    for (const double degrees : {0.0, 10.0, 45.0, 70.0, 80.0, 85.0}) {
      for (int i = 0; i < 6; ++i) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const dvec3 aside = random.perpendicular(dvec3(0, 1, 0));
        const dvec3 along = std::sin(angle) * aside - std::cos(angle) * dvec3(0, 1, 0);
        const double distance = (0.5 * thickness + 1.0) / std::cos(angle);
        const auto rays = tracer.follow(-distance * along, along);
        if (rays.size() != 3) {
          ++lost;
          continue;
        }
        const Vector d = direction_of(rays[0]);
        const Real i_angle = std::acos(std::min(-d.y, Real(1)));
        const Real r_angle = std::asin(std::sin(i_angle) / 1.5L);
        worst_turn = std::max(worst_turn, glm::distance(direction_of(rays[2]), d) * std::cos(i_angle) / kU);
        const Vector between = Vector(rays[2].ray.origin) - Vector(rays[0].ray.origin);
        const Real shift = glm::length(between - glm::dot(between, d) * d);
        const Real expected = 2 * Real(half) * std::sin(i_angle - r_angle) / std::cos(r_angle);
        worst_shift =
            std::max(worst_shift, std::abs(shift - expected) * std::cos(i_angle) / (kU * (10 + Real(distance))));
      }
    }
    lab.expect_at_most(label("rays lost in a slab, thickness", thickness), 0.0, static_cast<double>(lost));
    lab.expect_at_most(label("direction behind a slab / (u / cos i), thickness", thickness), 16.0,
                       static_cast<double>(worst_turn));
    lab.expect_at_most(label("shift behind a slab / (u S / cos i), thickness", thickness), 32.0,
                       static_cast<double>(worst_shift));
  }
}

/// From within glass, rays go close to the critical angle, beyond which no light leaves it. Rays into the glass have
/// grazing angles, for which the angle inside is the critical one.
void run_critical_angles(Lab& lab) {
  constexpr float kIor = 1.5F;
  GlassScene scene;
  scene.add(world::Box{vec3(0.0F), vec3(10.0F, 1.0F, 10.0F), vec3(0.0F)}, kIor);
  GlassTracer tracer(lab, scene);
  uint64_t wrong = 0;
  Real worst = 0;
  for (const double off : {1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6}) {
    for (const double sign : {-1.0, 1.0}) {
      const double sine = (1.0 + sign * off) / 1.5;
      const auto rays = tracer.follow(dvec3(-0.5, 0.2, 0.1), dvec3(sine, std::sqrt(1.0 - sine * sine), 0.0), 1);
      const Vector d = direction_of(rays[0]);
      const Real beyond2 = 1 - Real(kIor) * Real(kIor) * (1 - d.y * d.y);
      // The angle is so near to the critical angle that rounding determines the result.
      if (rays.size() != 2 || std::abs(beyond2) < 16 * kU) {
        wrong += rays.size() != 2 ? 1 : 0;
        continue;
      }
      const bool goes_on = rays[1].ray.direction.y > 0.0F;
      if (goes_on != (beyond2 > 0)) ++wrong;
      if (!goes_on) continue;
      const Vector expected(d.x * Real(kIor), std::sqrt(beyond2), d.z * Real(kIor));
      const Real spread = spread_of(kIor, 1, d.y, std::sqrt(beyond2));
      worst = std::max(worst, glm::distance(direction_of(rays[1]), expected) / (kU * (1 + spread)));
    }
  }
  lab.expect_at_most("rays on the wrong side of total reflection", 0.0, static_cast<double>(wrong));
  lab.expect_at_most("direction next to total reflection / (u (1 + n cos i / cos r))", 16.0,
                     static_cast<double>(worst));
  worst = 0;
  for (const double cosine : {1e-1, 1e-2, 1e-3, 1e-4}) {
    const auto rays =
        tracer.follow(dvec3(-1e-3 / cosine, 1.0 + 1e-3, 0.1), dvec3(std::sqrt(1.0 - cosine * cosine), -cosine, 0.0), 1);
    const Vector d = direction_of(rays[0]);
    const Vector expected(d.x / Real(kIor), -std::sqrt(1 - (1 - d.y * d.y) / (Real(kIor) * Real(kIor))),
                          d.z / Real(kIor));
    worst = std::max(worst, rays.size() == 2 ? glm::distance(direction_of(rays[1]), expected) / kU : Real(1e9L));
  }
  lab.expect_at_most("direction into glass at cosines of 1e-1 to 1e-4 / u", 8.0, static_cast<double>(worst));
}

/// A prism turns a ray that goes through it symmetrically by 2 asin(n sin(A / 2)) - A.
void run_wedges(Lab& lab) {
  for (const double degrees : {1.0, 20.0, 60.0}) {
    const double half = 0.5 * degrees * std::numbers::pi / 180.0;
    const auto x = static_cast<float>(std::tan(half));
    Mesh mesh;
    for (const float z : {-1.0F, 1.0F}) {
      mesh.positions.insert(mesh.positions.end(), {vec3(0, 1, z), vec3(-x, 0, z), vec3(x, 0, z)});
    }
    mesh.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4}, {0, 2, 5}, {0, 5, 3}, {1, 4, 5}, {1, 5, 2}};
    for (auto& triangle : mesh.triangles) std::swap(triangle.y, triangle.z);
    GlassScene scene;
    scene.add(mesh, 1.5F);
    GlassTracer tracer(lab, scene);
    // The angle is that of the mesh's faces.
    const Real a = std::atan(Real(x));
    const Real incidence = std::asin(1.5L * std::sin(a));
    const auto climb = static_cast<double>(incidence - a);
    const dvec3 along(std::cos(climb), std::sin(climb), 0.0);
    const auto rays = tracer.follow(dvec3(-0.25 * static_cast<double>(x), 0.5, 0.1) - along, along);
    const Vector d = direction_of(rays[0]);
    // Near the symmetric path the turn has its minimum, so the rounded ray has the same turn.
    const Real turn = 2 * incidence - 2 * a;
    const Vector expected(d.x * std::cos(turn) + d.y * std::sin(turn), d.y * std::cos(turn) - d.x * std::sin(turn),
                          d.z);
    const Real error = rays.size() == 3 ? glm::distance(direction_of(rays[2]), expected) : Real(1);
    lab.expect_at_most(label("direction behind a wedge of degrees / u", degrees), 64.0,
                       static_cast<double>(error / kU));
  }
}

/// A ray is totally reflected fifty times between the sides of a bar: its path is a folded straight line.
void run_light_guide(Lab& lab) {
  GlassScene scene;
  scene.add(world::Box{vec3(0.0F), vec3(200.0F, 1.0F, 1.0F), vec3(0.0F)}, 1.5F);
  GlassTracer tracer(lab, scene);
  const auto rays = tracer.follow(dvec3(-100.0, 0.1, 0.2), dvec3(1.0, 0.37, 0.31), 60);
  const Vector d = direction_of(rays[0]);
  size_t reflections = 0;
  Real turned = 0;
  Real moved = 0;
  for (size_t i = 1; i < rays.size() && reflections < 50; ++i, ++reflections) {
    const Vector now = direction_of(rays[i]);
    turned = std::max(turned, glm::distance(glm::abs(now), glm::abs(d)));
    // The unfolded path is a straight line: its y and z are functions of the distance in x.
    const Vector at(rays[i].ray.origin);
    const Real way = (at.x - Real(rays[0].ray.origin.x)) / d.x;
    for (const int axis : {1, 2}) {
      const Real straight = Real(rays[0].ray.origin[axis]) + way * d[axis];
      const Real folded = std::abs(std::remainder(straight - 1, Real(4)));
      moved = std::max(moved, std::abs(at[axis] - (1 - folded)));
    }
  }
  lab.expect_at_most("50 less total reflections in a bar", 0.0, 50.0 - static_cast<double>(reflections));
  lab.expect_at_most("direction after 50 total reflections / u", 128.0, static_cast<double>(turned / kU));
  // Each ray begins off its face by the lift.
  lab.expect_at_most("place after 50 total reflections / (u S), of each", 16.0,
                     static_cast<double>(moved / (50 * kU * 200)));
}

/// Returns the direction behind the solids of the same ray, traced with the oracle's hits and faces.
Vector direction_behind(const world::Scene& scene, oracle::Ray ray) {
  oracle::Media media;
  for (int step = 0; step < 64; ++step) {
    const oracle::Hit hit = oracle::find_nearest_hit(scene, ray);
    if (!hit.exists()) break;
    const bool leaves = glm::dot(hit.normal, ray.direction) > 0;
    oracle::Media beyond;
    const oracle::Face face = media.meet(oracle::material_of(scene, hit), leaves, oracle::kGreen, beyond);
    const Vector normal = leaves ? -hit.normal : hit.normal;
    const Vector at = ray.origin + hit.t * ray.direction;
    const oracle::Refraction refraction = oracle::refract(glm::normalize(ray.direction), normal, normal, face);
    if (refraction.is_total) {
      ray = {at + 1e-15L * (1 + glm::length(at)) * normal, glm::reflect(ray.direction, normal)};
      continue;
    }
    media = beyond;
    ray = {at - 1e-15L * (1 + glm::length(at)) * normal, refraction.direction};
  }
  return glm::normalize(ray.direction);
}

/// Checks solids that touch, overlap, lie inside one another or far from the origin.
void run_solids(Lab& lab, const std::string& name, const GlassScene& scene, const vec3& center, Random& random) {
  GlassTracer tracer(lab, scene);
  std::vector<double> errors;
  for (int i = 0; i < 60; ++i) {
    const dvec3 along = random.direction();
    const dvec3 aside = random.perpendicular(along);
    const auto rays = tracer.follow(dvec3(center) - 4.0 * along + 0.6 * random.uniform() * aside, along, 32);
    const oracle::Ray first{Vector(rays[0].ray.origin), Vector(rays[0].ray.direction)};
    const Real scale = 4 + glm::length(Vector(center));
    const Real error = glm::distance(direction_of(rays.back()), direction_behind(scene.scene(), first));
    errors.push_back(static_cast<double>(error / (kU * scale)));
  }
  // Each face adds its own error. A few rays near total reflection have a much larger one.
  std::sort(errors.begin(), errors.end());
  lab.expect_at_most("direction behind " + name + " / (u S), of 3 in 4 rays", 64.0, errors[errors.size() * 3 / 4]);
  lab.note("the same, of 9 in 10", errors[errors.size() * 9 / 10]);
}

void run_nested(Lab& lab) {
  Random random(50);
  const auto sphere = [](const vec3& center, float radius) { return world::Sphere{center, radius}; };
  GlassScene touching;
  touching.add(sphere(vec3(-0.5F, 0, 0), 0.5F), 1.5F).add(sphere(vec3(0.5F, 0, 0), 0.5F), 1.33F);
  run_solids(lab, "touching spheres", touching, vec3(0.0F), random);
  GlassScene overlapping;
  overlapping.add(sphere(vec3(-0.4F, 0, 0), 0.6F), 1.5F).add(sphere(vec3(0.4F, 0, 0), 0.6F), 1.33F);
  run_solids(lab, "overlapping spheres", overlapping, vec3(0.0F), random);
  GlassScene bubble;
  bubble.add(sphere(vec3(0.0F), 1.0F), 1.5F).add(sphere(vec3(0.2F, 0.1F, 0), 0.5F), 1.0F);
  run_solids(lab, "a bubble", bubble, vec3(0.0F), random);
  const vec3 far(6e4F, -6e4F, 5e4F);
  GlassScene lens;
  lens.add(sphere(far + vec3(-0.5F, 0, 0), 0.75F), 1.5F).add(sphere(far + vec3(0.5F, 0, 0), 0.75F), 1.5F);
  run_solids(lab, "a lens of spheres at 1e5 from the origin", lens, far, random);
}

/// Two blocks share a face. The test uses both orders of the blocks. A ray goes from one into the other as if air were
/// between them. Its direction in the second block is then that of Snell's law for the two; behind both it is as
/// before.
void run_coincident_faces(Lab& lab) {
  for (const bool is_second_first : {false, true}) {
    const world::Box lower{vec3(0, -0.5F, 0), vec3(2.0F, 0.5F, 2.0F), vec3(0.0F)};
    const world::Box upper{vec3(0, 0.5F, 0), vec3(2.0F, 0.5F, 2.0F), vec3(0.0F)};
    GlassScene scene;
    if (is_second_first) {
      scene.add(lower, 1.33F).add(upper, 1.5F);
    } else {
      scene.add(upper, 1.5F).add(lower, 1.33F);
    }
    GlassTracer tracer(lab, scene);
    uint64_t wrong = 0;
    Real worst = 0;
    for (int i = 0; i < 20; ++i) {
      const double angle = 0.03 * i;
      const auto rays = tracer.follow(dvec3(-0.3, 1.5, 0.1), dvec3(std::sin(angle), -std::cos(angle), 0.0));
      const Vector d = direction_of(rays[0]);
      worst = std::max(worst, glm::distance(direction_of(rays.back()), d));
      // The direction is that in the lower block.
      const Vector inside = direction_of(rays[rays.size() - 2]);
      if (rays.size() != 5 && rays.size() != 4) ++wrong;
      if (std::abs(inside.x - d.x / 1.33L) > 16 * kU) ++wrong;
    }
    const std::string order = is_second_first ? ", lower one first" : ", upper one first";
    lab.expect_at_most("rays that miss a face where two coincide" + order, 0.0, static_cast<double>(wrong));
    lab.expect_at_most("direction behind blocks that share a face / u" + order, 32.0, static_cast<double>(worst / kU));
  }
}

/// The unit sphere as a mesh of 8 * 4^level triangles with normals, and the length of its longest edge.
struct MeshSphere {
  Mesh mesh;
  Real longest_edge = 0;
};

MeshSphere make_mesh_sphere(int level) {
  MeshSphere sphere;
  const uint32_t steps = 1U << static_cast<uint32_t>(level);
  Mesh& mesh = sphere.mesh;
  // The faces of an octahedron are all cut in the same way and moved out to the sphere.
  for (int face = 0; face < 8; ++face) {
    const dvec3 signs((face & 1) != 0 ? -1 : 1, (face & 2) != 0 ? -1 : 1, (face & 4) != 0 ? -1 : 1);
    const bool is_turned = signs.x * signs.y * signs.z < 0;
    std::vector<std::vector<uint32_t>> rows;
    for (uint32_t i = 0; i <= steps; ++i) {
      rows.emplace_back();
      for (uint32_t j = 0; j <= steps - i; ++j) {
        const dvec3 point = glm::normalize(signs * dvec3(i, j, steps - i - j));
        rows.back().push_back(static_cast<uint32_t>(mesh.positions.size()));
        mesh.positions.emplace_back(point);
        mesh.normals.emplace_back(point);
      }
    }
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
      mesh.triangles.emplace_back(a, is_turned ? c : b, is_turned ? b : c);
      for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        sphere.longest_edge =
            std::max(sphere.longest_edge, glm::distance(Vector(mesh.positions[from]), Vector(mesh.positions[to])));
      }
    };
    for (uint32_t i = 0; i < steps; ++i) {
      for (uint32_t j = 0; j < steps - i; ++j) {
        add(rows[i][j], rows[i + 1][j], rows[i][j + 1]);
        if (j + 1 < steps - i) add(rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]);
      }
    }
  }
  return sphere;
}

/// A mesh with a sphere's normals bends light as the sphere does, except that its triangles lie below the sphere. With
/// edges half as long this error is a quarter.
void run_mesh_spheres(Lab& lab) {
  GlassScene exact;
  exact.add(world::Sphere{vec3(0.0F), 1.0F}, 1.5F);
  GlassTracer exact_tracer(lab, exact);
  for (const int level : {3, 5, 7}) {
    const MeshSphere sphere = make_mesh_sphere(level);
    GlassScene scene;
    scene.add(sphere.mesh, 1.5F);
    GlassTracer tracer(lab, scene);
    Random random(53);
    Real worst = 0;
    uint64_t other = 0;
    for (const double impact : {0.0, 0.2, 0.4, 0.6, 0.8}) {
      for (int i = 0; i < 8; ++i) {
        const dvec3 along = random.direction();
        const dvec3 origin = -3.0 * along + impact * random.perpendicular(along);
        const auto rays = tracer.follow(origin, along);
        const auto exact_rays = exact_tracer.follow(origin, along);
        if (rays.size() != 3 || exact_rays.size() != 3) {
          ++other;
          continue;
        }
        worst = std::max(worst, glm::distance(direction_of(rays[2]), direction_of(exact_rays[2])));
      }
    }
    const Real below = sphere.longest_edge * sphere.longest_edge / 6;
    const std::string mesh = fmt::format(", {} triangles", sphere.mesh.triangles.size());
    lab.expect_at_most("rays lost in a mesh of a sphere" + mesh, 0.0, static_cast<double>(other));
    lab.expect_at_most("direction behind a mesh less behind the sphere / (edge^2 / 6)" + mesh, 4.0,
                       static_cast<double>(worst / below));
  }
}

/// If the same light comes from all directions, a colourless glass ball must have the colour of this light, for all
/// paths inside.
void run_furnace(Lab& lab) {
  for (const float ior : {1.1F, 1.5F, 2.4F}) {
    world::Scene scene;
    scene.environment.ambient = scene.environment.background = vec3(1.0F);
    MetallicRoughness glass;
    glass.metallic = 0.0F;
    glass.roughness = 0.0F;
    glass.transmission = 1.0F;
    glass.thickness = 1.0F;
    glass.ior = ior;
    Material material;
    material.model = glass;
    scene.materials = {material};
    scene.objects = {{"ball", world::Sphere{vec3(0.0F), 1.0F}, 0}};
    View view;
    view.size = uvec2(64);
    view.max_depth = 30;
    view.camera.projection = Projection::kOrthographic;
    view.camera.eye = vec3(0, 0, 4);
    view.camera.look = vec3(0, 0, -1);
    view.camera.up = vec3(0, 1, 0);
    view.camera.ymag = 1.01F;
    const RenderResult result = make_renderer(lab.device(), scene).render(view);
    double worst = 0.0;
    for (const vec3& pixel : result.image.pixels) {
      for (int i = 0; i < 3; ++i) worst = std::max(worst, std::abs(static_cast<double>(pixel[i]) - 1.0));
    }
    lab.expect_at_most(label("white furnace of a glass ball, |L - 1|, ior", ior), 0.01, worst);
  }
}

constexpr HardCase kRows[] = {HardCase{45, "GlassSphere", run_spheres},
                              HardCase{46, "GlassSlab", run_slabs},
                              HardCase{47, "TotalReflection", run_critical_angles},
                              HardCase{48, "GlassWedge", run_wedges},
                              HardCase{49, "LightGuide", run_light_guide},
                              HardCase{50, "GlassSolids", run_nested},
                              HardCase{51, "CoincidentFacesOfGlass", run_coincident_faces},
                              HardCase{52, "GlassFurnace", run_furnace},
                              HardCase{53, "GlassMeshSphere", run_mesh_spheres}};

}  // namespace

std::span<const HardCase> glass_cases() {
  return kRows;
}

}  // namespace promin::hard
