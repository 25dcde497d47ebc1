// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "core/rounding.h"
#include "hard/bouncer.h"
#include "hard/hard_case.h"
#include "hard/self_hits.h"
#include "scene/choose_instances.h"

namespace promin::hard {
namespace {

using oracle::Real;
using oracle::Vector;
using Matrix = glm::tmat3x3<Real>;

constexpr int kMapsOfFamily = 16;
const size_t kRaysOfMap = some_of(4000);

/// A family of transforms, and the distances of rays in sizes of the instance.
struct Family {
  const char* name;
  /// The largest ratio of two scales, the range of scales, and the ratio of a shear; 1 for none.
  double ratio;
  double most_scale;
  double shear;
  /// The distance from the world's origin in sizes.
  double offset;
  double nearest;
  double farthest;
};

constexpr std::array kFamilies = {Family{"scales 1e-6...1e6", 1.0, 1e6, 1.0, 0.0, 1.2, 1e5},
                                  Family{"scales 1000 : 1, mirrored", 1000.0, 1.0, 1.0, 1.0, 1.2, 1e3},
                                  Family{"shear", 1.0, 1.0, 2.0, 1.0, 1.2, 1e3},
                                  Family{"1e6 sizes from the origin", 1.0, 1.0, 1.0, 1e6, 3.0, 10.0}};

dmat3 random_turn(Random& random) {
  const dvec3 axis = random.direction();
  return dmat3(glm::mat4_cast(glm::angleAxis(random.uniform(-3.0, 3.0), axis)));
}

/// Returns a transform of the family that may be an instance's.
dmat4 random_map(const Family& family, Random& random) {
  for (;;) {
    const double scale = std::pow(family.most_scale, random.uniform(-1.0, 1.0));
    dvec3 scales(scale);
    for (int i = 0; i < 3; ++i) scales[i] *= std::pow(family.ratio, random.uniform(-0.5, 0.5));
    if (family.ratio > 1.0 && random.uniform() < 0.5) scales.x = -scales.x;
    dmat3 turn = random_turn(random) * glm::mat3_cast(glm::dquat(1, 0, 0, 0));
    if (family.shear > 1.0) {
      dmat3 stretch(1.0);
      stretch[0][0] = random.uniform(1.0, family.shear);
      turn = turn * stretch * random_turn(random);
    }
    for (int i = 0; i < 3; ++i) turn[i] *= scales[i];
    dmat4 map(turn);
    map[3] = dvec4(family.offset * scale * random.direction(), 1.0);
    if (skeel_condition(map) <= kMostInstanceCondition) return map;
  }
}

/// Returns a convex ball of radius 1 with 2 * rows * (rows - 1) triangles or more.
Mesh make_ball(uint32_t rows) {
  Mesh mesh;
  const uint32_t columns = 2 * rows;
  mesh.positions.emplace_back(0, 1, 0);
  for (uint32_t row = 1; row < rows; ++row) {
    const double polar = 3.14159265358979 * row / rows;
    for (uint32_t column = 0; column < columns; ++column) {
      const double angle = 2.0 * 3.14159265358979 * column / columns;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(angle), std::cos(polar),
                                  std::sin(polar) * std::sin(angle));
    }
  }
  mesh.positions.emplace_back(0, -1, 0);
  const auto at = [&](uint32_t row, uint32_t column) { return 1 + (row - 1) * columns + column % columns; };
  for (uint32_t column = 0; column < columns; ++column) {
    mesh.triangles.emplace_back(0, at(1, column + 1), at(1, column));
    for (uint32_t row = 1; row + 1 < rows; ++row) {
      mesh.triangles.emplace_back(at(row, column), at(row, column + 1), at(row + 1, column));
      mesh.triangles.emplace_back(at(row, column + 1), at(row + 1, column + 1), at(row + 1, column));
    }
    mesh.triangles.emplace_back(at(rows - 1, column), at(rows - 1, column + 1),
                                static_cast<uint32_t>(mesh.positions.size() - 1));
  }
  return mesh;
}

/// Returns a square in the plane z = 0 with 2 * side^2 triangles, whose boxes have no thickness.
Mesh make_flat(uint32_t side) {
  Mesh mesh;
  for (uint32_t y = 0; y <= side; ++y) {
    for (uint32_t x = 0; x <= side; ++x) {
      mesh.positions.emplace_back(2.0F * static_cast<float>(x) / static_cast<float>(side) - 1.0F,
                                  2.0F * static_cast<float>(y) / static_cast<float>(side) - 1.0F, 0.0F);
    }
  }
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t p = y * (side + 1) + x;
      mesh.triangles.emplace_back(p, p + 1, p + side + 2);
      mesh.triangles.emplace_back(p, p + side + 2, p + side + 1);
    }
  }
  return mesh;
}

/// A scene of one mesh with instances, and the mesh alone in its own space for the oracle.
struct Instanced {
  world::Scene scene;
  world::Scene own;
  std::vector<world::InstanceMap> maps;

  Instanced(const Mesh& mesh, std::span<const dmat4> transforms) : own(scene_of({mesh})) {
    scene = scene_of(std::vector<world::Shape>(transforms.size()));
    scene.meshes = {mesh};
    for (uint32_t i = 0; i < transforms.size(); ++i) {
      maps.push_back(world::map_of(transforms[i]));
      scene.instances.push_back({i, 0, maps.back()});
    }
  }
};

Vector to_own(const world::InstanceMap& map, const Vector& v) {
  return Matrix(map.object_from_world) * v;
}
dvec3 to_world(const world::InstanceMap& map, const dvec3& p) {
  return dvec3(map.origin) + glm::inverse(dmat3(map.object_from_world)) * p;
}

oracle::Ray ray_in_own_space(const world::InstanceMap& map, const Ray& ray) {
  return {to_own(map, Vector(ray.origin) - Vector(map.origin)), to_own(map, Vector(ray.direction)), ray.tmin, ray.tmax};
}

/// The errors of an instance's hits in the world, in u S, where S includes the triangle's size in the world.
struct Errors {
  double t = 0.0;
  double margin = 0.0;
  double normal = 0.0;
  uint64_t hits = 0;
  uint64_t different = 0;

  void add(const Errors& other) {
    t = std::max(t, other.t);
    margin = std::max(margin, other.margin);
    normal = std::max(normal, other.normal);
    hits += other.hits;
    different += other.different;
  }
};

double size_of_triangle(const world::InstanceMap& map, const Mesh& mesh, uint32_t triangle, const dvec3& origin) {
  std::array<dvec3, 3> corners;
  for (int i = 0; i < 3; ++i) {
    corners[static_cast<size_t>(i)] = to_world(map, dvec3(mesh.positions[mesh.triangles[triangle][i]]));
  }
  const dvec3 center = (corners[0] + corners[1] + corners[2]) / 3.0;
  double radius = 0.0;
  for (const dvec3& corner : corners) radius = std::max(radius, glm::distance(corner, center));
  return glm::distance(origin, center) + radius;
}

Errors judge_in_world(const Instanced& instanced, std::span<const Ray> rays, std::span<const Hit> hits) {
  Errors errors;
  const world::InstanceMap& map = instanced.maps[0];
  const Mesh& mesh = instanced.scene.meshes[0];
  Mesh turned = mesh;
  for (vec3& p : turned.positions) p = vec3(glm::inverse(dmat3(map.object_from_world)) * dvec3(p));
  const world::Scene placed = scene_of({turned});
  for (size_t i = 0; i < rays.size(); ++i) {
    const oracle::Ray own = ray_in_own_space(map, rays[i]);
    const oracle::Verdict verdict = oracle::judge(instanced.own, own, {hits[i].t, hits[i].object, hits[i].primitive});
    if (!verdict.is_same) {
      ++errors.different;
      // Two measures of the distance are right: that in the space of the mesh, and that in the world.
      const oracle::Ray about_origin{Vector(rays[i].origin) - Vector(map.origin), Vector(rays[i].direction),
                                     rays[i].tmin, rays[i].tmax};
      const oracle::Verdict in_world =
          oracle::judge(placed, about_origin, {hits[i].t, hits[i].object, hits[i].primitive});
      const Real margin = std::min(verdict.margin, in_world.is_same ? Real(0) : in_world.margin);
      errors.margin = std::max(errors.margin, static_cast<double>(margin));
      continue;
    }
    if (hits[i].object < 0) continue;
    ++errors.hits;
    const Vector along = glm::transpose(Matrix(map.object_from_world)) * verdict.exact.normal;
    const Vector normal = along / glm::length(along);
    const Real along_normal = std::abs(glm::dot(Vector(rays[i].direction), normal));
    const double scale = size_of_triangle(map, mesh, static_cast<uint32_t>(hits[i].primitive), dvec3(rays[i].origin));
    const Real t_error = std::abs(Real(hits[i].t) - verdict.exact.t) * along_normal;
    errors.t = std::max(errors.t, static_cast<double>(t_error) / (double{kUnitRoundoff} * scale));
    errors.normal = std::max(errors.normal, static_cast<double>(glm::distance(Vector(hits[i].normal), normal)));
  }
  return errors;
}

/// Returns rays at points, edges and corners of the mesh of an instance, and past its rim.
std::vector<Ray> make_rays_at(const Instanced& instanced, const Family& family, Random& random) {
  const world::InstanceMap& map = instanced.maps[0];
  const Mesh& mesh = instanced.scene.meshes[0];
  const double size = glm::distance(to_world(map, dvec3(1, 1, 1)), to_world(map, dvec3(-1, -1, -1)));
  std::vector<Ray> rays;
  for (size_t i = 0; i < kRaysOfMap; ++i) {
    const uvec3 triangle = mesh.triangles[static_cast<size_t>(random.uniform() * mesh.triangles.size())];
    const dvec3 a(mesh.positions[triangle.x]);
    const dvec3 b(mesh.positions[triangle.y]);
    dvec3 target = random.inside(a, b, dvec3(mesh.positions[triangle.z]));
    if (i % 4 == 1) target = glm::mix(a, b, random.uniform());
    if (i % 4 == 2) target = a;
    if (i % 4 == 3) target = 1.02 * random.direction();
    const double distance = size * family.nearest * std::pow(family.farthest / family.nearest, random.uniform());
    const dvec3 origin = to_world(map, dvec3(0.0)) + distance * random.direction();
    rays.push_back(ray_towards(origin, to_world(map, target)));
  }
  return rays;
}

void run_maps(Lab& lab) {
  const Mesh ball = make_ball(12);
  const Mesh flat = make_flat(16);
  for (const Family& family : kFamilies) {
    Random random(56);
    Errors errors;
    for (int i = 0; i < kMapsOfFamily; ++i) {
      const dmat4 map = random_map(family, random);
      const Instanced instanced(i % 2 == 0 ? ball : flat, {&map, 1});
      const std::vector<Ray> rays = make_rays_at(instanced, family, random);
      errors.add(judge_in_world(instanced, rays, lab.cast(instanced.scene, rays)));
    }
    const std::string name = std::string(", ") + family.name;
    lab.expect_at_most("K of t" + name, oracle::kB1 * lab.rounding_factor() * (family.shear > 1.0 ? 2.0 : 1.0),
                       errors.t);
    lab.expect_at_most("distance from an edge where answers differ" + name, 4.0 * lab.rounding_factor(), errors.margin);
    lab.expect_at_most("error of the normal" + name, 2e-6, errors.normal);
    lab.note("hits" + name, static_cast<double>(errors.hits));
    lab.note("other answers" + name, static_cast<double>(errors.different));
  }
}

/// Rays from inside a closed mesh must not leave it.
void run_leaks(Lab& lab) {
  const Mesh ball = make_ball(24);
  for (const Family& family : kFamilies) {
    Random random(57);
    uint64_t leaks = 0;
    for (int i = 0; i < kMapsOfFamily; ++i) {
      const dmat4 map = random_map(family, random);
      const Instanced instanced(ball, {&map, 1});
      std::vector<Ray> rays;
      for (size_t k = 0; k < kRaysOfMap; ++k) {
        const uvec3 triangle = ball.triangles[static_cast<size_t>(random.uniform() * ball.triangles.size())];
        const dvec3 a(ball.positions[triangle.x]);
        const dvec3 target = k % 3 == 0 ? a : glm::mix(a, dvec3(ball.positions[triangle.y]), random.uniform());
        rays.push_back(
            ray_towards(to_world(instanced.maps[0], 0.3 * random.direction()), to_world(instanced.maps[0], target)));
      }
      const std::vector<Hit> hits = lab.cast(instanced.scene, rays);
      leaks += static_cast<uint64_t>(std::ranges::count_if(hits, [](const Hit& hit) { return hit.object < 0; }));
    }
    lab.expect_at_most(std::string("leaks, ") + family.name, 0.0, static_cast<double>(leaks));
  }
}

/// Secondary rays of a convex mesh must not hit it, and start above it.
void run_lifts(Lab& lab) {
  const Mesh ball = make_ball(12);
  for (const Family& family : kFamilies) {
    Random random(58);
    uint64_t self_hits = 0;
    uint64_t below = 0;
    double most_lift = 0.0;
    for (int i = 0; i < kMapsOfFamily; ++i) {
      const dmat4 map = random_map(family, random);
      const Instanced instanced(ball, {&map, 1});
      const world::InstanceMap& placed = instanced.maps[0];
      const std::vector<Ray> rays = make_rays_at(instanced, family, random);
      const std::vector<Hit> hits = lab.cast(instanced.scene, rays);
      const std::vector<Bounce> bounces = Bouncer(lab.device(), instanced.scene).bounce(rays);
      std::vector<Ray> next;
      for (size_t k = 0; k < rays.size(); ++k) {
        if (!bounces[k].is_hit || hits[k].object < 0) continue;
        const dvec3 n = glm::normalize(dvec3(hits[k].normal));
        if (glm::dot(n, dvec3(rays[k].direction)) > 0.0) continue;
        const uvec3 triangle = ball.triangles[bounces[k].id.primitive];
        const Vector own = to_own(placed, Vector(bounces[k].origin) - Vector(placed.origin));
        const Vector a(ball.positions[triangle.x]);
        const Vector own_normal =
            glm::cross(Vector(ball.positions[triangle.y]) - a, Vector(ball.positions[triangle.z]) - a);
        below += glm::dot(own - a, own_normal) > 0 ? 0 : 1;
        const dvec3 origin(bounces[k].origin);
        const double scale = size_of_triangle(placed, ball, bounces[k].id.primitive, origin) + glm::length(origin);
        most_lift = std::max(most_lift, double{bounces[k].lift} / (double{kUnitRoundoff} * scale));
        next.push_back({bounces[k].origin, 0.0F, direction_at(n, uniform_cosine(random), random),
                        std::numeric_limits<float>::infinity()});
      }
      const std::vector<Hit> again = lab.cast(instanced.scene, next);
      self_hits += static_cast<uint64_t>(std::ranges::count_if(again, [](const Hit& hit) { return hit.object >= 0; }));
    }
    const std::string name = std::string(", ") + family.name;
    lab.expect_at_most("secondary rays that start below the surface" + name, 0.0, static_cast<double>(below));
    lab.expect_at_most("self-hits" + name, 0.0, static_cast<double>(self_hits));
    lab.note("largest lift in u (|P| + size)" + name, most_lift);
  }
}

/// If several instances are in one place, a ray hits the first, whatever the tree.
void run_ties(Lab& lab) {
  Random random(59);
  const Mesh ball = make_ball(12);
  std::vector<dmat4> maps;
  for (int i = 0; i < 8; ++i) {
    const dmat4 map = random_map(kFamilies[1], random);
    for (int copy = 0; copy < 3; ++copy) maps.push_back(map);
  }
  const Instanced instanced(ball, maps);
  std::vector<Ray> rays;
  for (size_t i = 0; i < kRaysOfMap; ++i) {
    const world::InstanceMap& map = instanced.maps[i % maps.size()];
    rays.push_back(ray_towards(3e3 * random.direction(), to_world(map, random.direction())));
  }
  const std::vector<Hit> hits = lab.cast(instanced.scene, rays);
  const auto is_copy = [](const Hit& hit) { return hit.object >= 0 && hit.object % 3 != 0; };
  lab.expect_at_most("hits of a copy that is not the first", 0.0,
                     static_cast<double>(std::ranges::count_if(hits, is_copy)));
  std::array<std::vector<layout::HitRecord>, 2> records;
  for (size_t i = 0; i < records.size(); ++i) {
    const PackedScene packed = pack_scene(instanced.scene, i == 0 ? "median" : "sah");
    records[i] = lab.cast_packed(packed, packed.features, rays);
  }
  lab.expect_at_most("hits that differ between trees", 0.0,
                     static_cast<double>(count_differences(records[0], records[1])));
}

constexpr std::array kInstanceCases{
    HardCase{56, "InstancesByManyMaps", run_maps}, HardCase{57, "ClosedInstances", run_leaks},
    HardCase{58, "LiftsOfInstances", run_lifts}, HardCase{59, "InstancesInOnePlace", run_ties}};

}  // namespace

std::span<const HardCase> instance_cases() {
  return kInstanceCases;
}

}  // namespace promin::hard
