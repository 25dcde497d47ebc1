// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cmath>

#include "hard/hard_case.h"

namespace promin::hard {
namespace {

const size_t kSphereRayCount = some_of(100000);

/// Returns rays from random points at a distance from the centre. Their targets lie in a disk of `spread` radii
/// perpendicular to the line to the centre.
std::vector<Ray> rays_at(const world::Sphere& sphere, double distance, double spread, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSphereRayCount; ++i) {
    const dvec3 view = random.direction();
    const double impact = spread * sphere.radius * std::sqrt(random.uniform());
    rays.push_back(ray_towards(dvec3(sphere.center) - distance * view,
                               dvec3(sphere.center) + impact * random.perpendicular(view)));
  }
  return rays;
}

void expect_b1_b2(Lab& lab, const world::Sphere& sphere, std::span<const Ray> rays, const std::string& where) {
  const Tally tally = lab.cast_and_judge(scene_of({sphere}), rays);
  lab.expect_at_most("K of t (B1), " + where, 8.0 * lab.rounding_factor(), tally.max_t_error);
  lab.expect_at_most("margin of other answers / uS (B2), " + where, 2.0, tally.max_margin);
  lab.expect_at_most("malformed hits, " + where, 0.0, static_cast<double>(tally.malformed));
  Lab::credit("sphere", tally);
}

void run_distances(Lab& lab) {
  Random random(1);
  const world::Sphere sphere{vec3(0.0F), 1.0F};
  for (const double distance : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
    expect_b1_b2(lab, sphere, rays_at(sphere, distance, 1.05, random), label("distance", distance));
  }
}

void run_small(Lab& lab) {
  Random random(2);
  const world::Sphere sphere{vec3(0.0F), 1e-3F};
  for (const double distance : {1.0, 100.0}) {
    expect_b1_b2(lab, sphere, rays_at(sphere, distance, 1.05, random), label("distance", distance));
  }
}

/// Expects that P = o + t d lies on the surface.
void expect_bk(Lab& lab, const world::Sphere& sphere, std::span<const Ray> rays, const std::string& where) {
  const Tally tally = lab.cast_and_judge(scene_of({sphere}), rays);
  lab.expect_at_most("|P - surface| / uS (BK), " + where, 8.0 * lab.rounding_factor(), tally.max_surface_error);
  lab.expect_at_most("missed, " + where, 0.0, static_cast<double>(tally.misses));
  Lab::credit("sphere", tally);
}

void run_large(Lab& lab) {
  Random random(3);
  const world::Sphere sphere{vec3(0.0F), 1e6F};
  std::vector<Ray> rays;
  while (rays.size() < kSphereRayCount) {
    const dvec3 up = random.direction();
    const dvec3 origin = (1e6 + 1.0) * up;
    // The ray points down far enough to hit the sphere in spite of rounding. The horizon is 1.4e-3 below the
    // horizontal.
    const dvec3 direction = random.direction();
    if (glm::dot(direction, up) < -3e-3) rays.push_back(ray_towards(origin, origin + direction));
  }
  expect_bk(lab, sphere, rays, "origin 1 above");
}

void run_extreme_sizes(Lab& lab) {
  Random random(4);
  for (const auto& [radius, distance] : {std::array{1e6, 1e9}, std::array{1e-20, 1e-18}}) {
    const world::Sphere sphere{vec3(0.0F), static_cast<float>(radius)};
    const std::string where = label("r =", radius) + label(" at", distance);
    expect_b1_b2(lab, sphere, rays_at(sphere, distance, 1.05, random), where);
  }
}

void run_grazing(Lab& lab) {
  Random random(6);
  const world::Sphere sphere{vec3(0.0F), 1.0F};
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSphereRayCount; ++i) {
    const dvec3 view = random.direction();
    const double impact = i % 2 == 0 ? 1.0 + 0x1p-22 : 1.0 - 0x1p-22;
    const dvec3 offset = impact * random.perpendicular(view);
    rays.push_back(ray_towards(offset - 3.0 * view, offset));
  }
  expect_b1_b2(lab, sphere, rays, "impact r (1 +- 2^-22)");
}

void run_inside(Lab& lab) {
  Random random(7);
  const world::Sphere sphere{vec3(1.0F, 2.0F, 3.0F), 2.0F};
  for (const double depth : {0.0, 0.5, 0.999}) {
    std::vector<Ray> rays;
    for (size_t i = 0; i < kSphereRayCount; ++i) {
      const dvec3 origin = dvec3(sphere.center) + 2.0 * depth * random.direction();
      rays.push_back(ray_towards(origin, origin + random.direction()));
    }
    expect_bk(lab, sphere, rays, label("from inside at r times", depth));
  }
  // The rays go from the surface inwards to the far side. They must not hit their start, which rounding has put a few u
  // S beside the surface; S is 2 r. On a ray that is not grazing, tmin is larger than this error.
  std::vector<Ray> rays;
  while (rays.size() < kSphereRayCount) {
    const dvec3 outward = random.direction();
    const dvec3 origin = dvec3(sphere.center) + 2.0 * outward;
    const dvec3 direction = random.direction();
    if (glm::dot(direction, outward) > -0.1) continue;
    rays.push_back(ray_towards(origin, origin + direction));
    rays.back().tmin = 1e-5F * sphere.radius;
  }
  expect_bk(lab, sphere, rays, "from the surface");
}

void run_direction_lengths(Lab& lab) {
  Random random(8);
  const world::Sphere sphere{vec3(0.0F), 1.0F};
  for (const double length : {1e-3, 1e3, 1e-30, 1e30}) {
    std::vector<Ray> rays = rays_at(sphere, 10.0, 1.05, random);
    for (Ray& ray : rays) ray.direction = vec3(length * dvec3(ray.direction));
    expect_b1_b2(lab, sphere, rays, label("|d| =", length));
  }
}

void run_offsets(Lab& lab) {
  Random random(9);
  for (const float offset : {1e5F, 1e7F}) {
    const world::Sphere sphere{vec3(offset, -offset, offset), 1.0F};
    expect_b1_b2(lab, sphere, rays_at(sphere, 10.0, 1.05, random), label("centre at", offset));
  }
}

constexpr std::array kSphereCases{HardCase{1, "SphereFarAway", run_distances},
                                  HardCase{2, "SmallSphere", run_small},
                                  HardCase{3, "LargeSphereFromNear", run_large},
                                  HardCase{4, "ExtremeSizes", run_extreme_sizes},
                                  HardCase{6, "SphereGrazed", run_grazing},
                                  HardCase{7, "SphereFromInside", run_inside},
                                  HardCase{8, "DirectionLengths", run_direction_lengths},
                                  HardCase{9, "SphereFarFromTheOrigin", run_offsets}};

}  // namespace

std::span<const HardCase> sphere_cases() {
  return kSphereCases;
}

}  // namespace promin::hard
