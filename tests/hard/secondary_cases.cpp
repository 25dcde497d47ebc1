// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// Rays that start where others ended: the renderer's own lift and mirror direction, by tests/hard/bounce.comp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/rounding.h"
#include "hard/bouncer.h"
#include "hard/hard_case.h"
#include "hard/self_hits.h"

namespace promin::hard {
namespace {

using oracle::Real;
using oracle::Vector;

constexpr float kNoEnd = std::numeric_limits<float>::infinity();
constexpr Real kRoundoff = kUnitRoundoff;

Mesh make_octahedron(const vec3& center, float size) {
  Mesh mesh;
  for (const vec3& axis : {vec3(size, 0, 0), vec3(0, size, 0), vec3(0, 0, size)}) {
    mesh.positions.push_back(center + axis);
    mesh.positions.push_back(center - axis);
  }
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

void run_self_hits(Lab& lab) {
  Random random(32);
  const vec3 axis(glm::normalize(dvec3(1.0, 2.0, -0.5)));
  uint64_t near_origin = 0;
  uint64_t far_away = 0;
  for (int exponent = -8; exponent <= 8; exponent += 4) {
    const double scale = std::pow(10.0, exponent);
    const auto size = static_cast<float>(scale);
    const auto shapes_at = [&](const vec3& center) {
      return std::vector<world::Shape>{world::Sphere{center, size},
                                       world::Cylinder{center, axis, size, 0.5F * size},
                                       world::Cone{center, axis, size, 0.7F * size, 0.0F},
                                       world::Cone{center, axis, size, 0.3F * size, 0.8F * size},
                                       world::Box{center, size * vec3(1.0F, 0.7F, 0.4F), vec3(0.2F, -0.1F, 0.3F)},
                                       world::Capsule{center, axis, 0.5F * size, 0.5F * size, 0.2F * size},
                                       make_octahedron(center, size)};
    };
    for (const world::Shape& shape : shapes_at(vec3(0.0F))) {
      near_origin += count_self_hits(lab, shape, scale, dvec3(0.0), random);
    }
    const vec3 center(100.0F * size, -70.0F * size, 30.0F * size);
    for (const world::Shape& shape : shapes_at(center)) {
      far_away += count_self_hits(lab, shape, scale, dvec3(center), random);
    }
  }
  lab.expect_at_most("self-hits, scales 1e-8...1e8 at the origin", 0.0, static_cast<double>(near_origin));
  lab.expect_at_most("self-hits, scales 1e-8...1e8 at 100 sizes from it", 0.0, static_cast<double>(far_away));
}

void run_plane_lift(Lab& lab) {
  Random random(33);
  for (const double offset : {0.0, 1.0, 1e2, 1e4, 1e6}) {
    const world::Plane plane{vec3(offset * random.direction()), vec3(random.direction())};
    const world::Scene scene = scene_of({plane});
    const dvec3 n = glm::normalize(dvec3(plane.normal));
    std::vector<Ray> rays;
    for (size_t i = 0; i < some_of(100000); ++i) {
      const double side = random.uniform() < 0.5 ? 1.0 : -1.0;
      const double cosine = std::pow(10.0, random.uniform(-3.0, 0.0));
      const vec3 direction = direction_at(-side * n, cosine, random);
      const double distance = std::pow(10.0, random.uniform(-2.0, 4.0));
      const double reach = 10.0 * random.uniform();
      const dvec3 target = dvec3(plane.point) + reach * random.perpendicular(n);
      rays.push_back({vec3(target - distance * dvec3(direction)), 0.0F, direction, kNoEnd});
    }
    const std::vector<Hit> hits = lab.cast(scene, rays);
    const std::vector<Bounce> bounces = Bouncer(lab.device(), scene).bounce(rays);
    uint64_t acne = 0;
    uint64_t hit_count = 0;
    double worst_lift = 0.0;
    std::vector<Ray> next;
    for (size_t i = 0; i < rays.size(); ++i) {
      if (!bounces[i].is_hit || hits[i].object < 0) continue;  // the start was rounded to the other side
      ++hit_count;
      const Vector exact_n(plane.normal);
      const auto height = [&](const vec3& p) { return glm::dot(Vector(p) - Vector(plane.point), exact_n); };
      // On the plane itself is right as well: t = 0 is no hit.
      if (!(height(bounces[i].origin) * height(rays[i].origin) >= 0)) ++acne;
      const double reach = max_abs_component(rays[i].origin) +
                           static_cast<double>(hits[i].t) * max_abs_component(rays[i].direction) +
                           max_abs_component(plane.point);
      worst_lift = std::max(worst_lift, static_cast<double>(bounces[i].lift) / (kUnitRoundoff * reach));
      const dvec3 facing = height(rays[i].origin) > 0 ? n : -n;
      next.push_back({bounces[i].origin, 0.0F, bounces[i].mirrored, kNoEnd});
      next.push_back({bounces[i].origin, 0.0F, direction_at(facing, uniform_cosine(random), random), kNoEnd});
    }
    // At 1e6 an ulp is more than the height of a tenth of the starts.
    EXPECT_GT(hit_count, rays.size() * 3 / 4);
    // A direction that rounding has turned towards the plane may meet it far away: it is no acne.
    const auto is_acne = [&](const Ray& ray, const Hit& hit) {
      const Real slope = glm::dot(Vector(ray.direction), Vector(plane.normal));
      const Real height = glm::dot(Vector(ray.origin) - Vector(plane.point), Vector(plane.normal));
      return hit.object >= 0 && (height == 0 || slope * height > 0);
    };
    const std::vector<Hit> again = lab.cast(scene, next);
    for (size_t i = 0; i < next.size(); ++i) acne += is_acne(next[i], again[i]) ? 1 : 0;
    lab.expect_at_most(label("acne, plane at", offset), 0.0, static_cast<double>(acne));
    lab.expect_at_most(label("lift / u(|o| + |t||d| + |q|), plane at", offset), 16.0, worst_lift);
  }
}

/// Points on the plane and on the sphere about where they touch, and a light that is low.
void run_contact(Lab& lab) {
  Random random(34);
  const world::Scene scene = scene_of({world::Plane{}, world::Sphere{vec3(0.0F, 1.0F, 0.0F), 1.0F}});
  Bouncer bouncer(lab.device(), scene);
  for (const double elevation_deg : {10.0, 1.0, 0.1}) {
    const double elevation = glm::radians(elevation_deg);
    const vec3 to_light(dvec3(std::cos(elevation), std::sin(elevation), 0.0));
    std::vector<Ray> rays;
    for (size_t i = 0; i < some_of(100000); ++i) {
      const double radius = std::pow(10.0, random.uniform(-3.0, 0.0));
      const double angle = random.uniform(0.0, 6.283185307179586);
      const dvec3 target(radius * std::cos(angle), 0.0, radius * std::sin(angle));
      // From beside, close to the floor, so that the ray passes under the sphere.
      rays.push_back(
          ray_towards(target + 3.0 * glm::normalize(target) + dvec3(0.0, 0.05 * random.uniform(), 0.0), target));
    }
    const std::vector<Bounce> bounces = bouncer.bounce(rays);
    std::vector<Ray> shadow_rays;
    for (const Bounce& bounce : bounces) shadow_rays.push_back({bounce.origin, 0.0F, to_light, kNoEnd});
    const std::vector<Hit> blockers = lab.cast(scene, shadow_rays, HitQuery::kAny);
    uint64_t leaks = 0;
    uint64_t shadowed = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const oracle::Hit exact =
          oracle::find_nearest_hit(scene, {Vector(rays[i].origin), Vector(rays[i].direction), 0, oracle::kInfinity});
      if (!bounces[i].is_hit || !exact.exists() || glm::dot(exact.normal, Vector(to_light)) <= 0) continue;
      const Vector point = Vector(rays[i].origin) + exact.t * Vector(rays[i].direction);
      const oracle::Ray exact_shadow{point, Vector(to_light), 1e-12L, oracle::kInfinity};
      if (!oracle::is_occluded(scene, exact_shadow)) continue;
      ++shadowed;
      if (blockers[i].t == 0.0F) continue;
      // Lit, though exactly it is not: by how much does the exact ray pass inside of what blocks it?
      const Real depth = oracle::judge(scene, exact_shadow, {}).margin * kRoundoff * 2;  // S = |o - c| + r is about 2
      if (depth > glm::distance(point, Vector(bounces[i].origin)) + 2 * kRoundoff * 2) ++leaks;
    }
    EXPECT_GT(shadowed, rays.size() / 100);
    lab.expect_at_most(label("light leaks beyond the lift, elevation in degrees", elevation_deg), 0.0,
                       static_cast<double>(leaks));
  }
}

void run_reflections(Lab& lab) {
  Random random(35);
  Bouncer bouncer(lab.device(), scene_of({world::Sphere{vec3(0.0F), 1.0F}}));
  std::vector<Ray> rays;
  for (int i = 0; i < 1000; ++i) {
    const dvec3 origin = 0.5 * random.direction();
    rays.push_back(ray_towards(origin, origin + random.direction()));
  }
  double worst = 0.0;
  uint64_t lost = 0;
  for (int bounce = 1; bounce <= 1000; ++bounce) {
    const std::vector<Bounce> bounces = bouncer.bounce(rays);
    for (size_t i = 0; i < rays.size(); ++i) {
      lost += bounces[i].is_hit ? 0 : 1;
      rays[i] = {bounces[i].origin, 0.0F, bounces[i].mirrored, kNoEnd};
      worst = std::max(worst, std::abs(glm::length(dvec3(bounces[i].mirrored)) - 1.0));
    }
    if (bounce == 50) lab.expect_at_most("||d| - 1| after 50 reflections", 4e-6, worst);
  }
  lab.expect_at_most("||d| - 1| after 1000 reflections", 1e-5, worst);
  lab.expect_at_most("rays that left the closed mirror", 0.0, static_cast<double>(lost));
}

void run_facing_mirrors(Lab& lab) {
  Random random(36);
  for (const float gap : {0.5F, 1.0F, 2.0F}) {
    const world::Scene scene = scene_of({world::Plane{vec3(0.0F), vec3(0.0F, 0.0F, 1.0F)},
                                         world::Plane{vec3(0.0F, 0.0F, gap), vec3(0.0F, 0.0F, -1.0F)}});
    Bouncer bouncer(lab.device(), scene);
    std::vector<Ray> rays;
    for (size_t i = 0; i < some_of(10000); ++i) {
      const dvec3 origin{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), 0.5 * static_cast<double>(gap)};
      rays.push_back(
          {vec3(origin), 0.0F, direction_at(dvec3(0.0, 0.0, 1.0), random.uniform(0.1, 1.0), random), kNoEnd});
    }
    const std::vector<Ray> first = rays;
    double worst = 0.0;
    for (int bounce = 0; bounce <= 10; ++bounce) {
      const std::vector<Hit> hits = lab.cast(scene, rays);
      const std::vector<Bounce> bounces = bouncer.bounce(rays);
      for (size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].object < 0) {
          worst = std::numeric_limits<double>::infinity();
          continue;
        }
        // With its reflections unfolded, the exact ray is a straight line: it has crossed half a gap and one more a
        // bounce.
        const Vector d(first[i].direction);
        const Real t = (Real(0.5) + bounce) * Real(gap) / d.z;
        Vector exact = Vector(first[i].origin) + t * d;
        exact.z = bounce % 2 == 0 ? Real(gap) : 0;
        const Vector point = Vector(rays[i].origin) + Real(hits[i].t) * Vector(rays[i].direction);
        worst = std::max(worst, static_cast<double>(glm::distance(point, exact)));
        rays[i] = {bounces[i].origin, 0.0F, bounces[i].mirrored, kNoEnd};
      }
    }
    lab.expect_at_most(label("|dP| up to bounce 10, gap", gap), 1e-3, worst);
  }
}

constexpr std::array kSecondaryCases{
    HardCase{32, "NoSelfHits", run_self_hits}, HardCase{33, "LiftOffPlanes", run_plane_lift},
    HardCase{34, "SphereOnAPlane", run_contact}, HardCase{35, "ManyReflections", run_reflections},
    HardCase{36, "FacingMirrors", run_facing_mirrors}};

}  // namespace

std::span<const HardCase> secondary_cases() {
  return kSecondaryCases;
}

}  // namespace promin::hard
