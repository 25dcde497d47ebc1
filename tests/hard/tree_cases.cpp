// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>

#include "bvh/builder.h"
#include "gpu/test_scenes.h"
#include "hard/hard_case.h"
#include "hard/random_shapes.h"
#include "oracle/distance.h"
#include "support/pipes.h"

namespace promin::hard {
namespace {

const size_t kRaysPerScene = some_of(250000);
const size_t kJudged = some_of(4000);
constexpr int kFarShapes = 10;
const size_t kRaysPerFarShape = some_of(1000);

struct TreeScene {
  const char* name;
  world::Scene scene;
  /// The targets of the rays are around this point.
  dvec3 center;
  double radius;
};

vec3 turned_axis(Random& random) {
  return vec3(random.direction());
}

/// Returns a point in a ball; all points are equally likely.
dvec3 random_point_within(const dvec3& center, double radius, Random& random) {
  const double distance = radius * std::cbrt(random.uniform());
  return center + distance * random.direction();
}

/// Returns shapes of every kind scattered in a ball; some are much larger than others.
world::Scene make_strewn(const dvec3& center, double radius, int count, Random& random) {
  std::vector<world::Shape> shapes;
  for (int i = 0; i < count; ++i) {
    const vec3 place(random_point_within(center, radius, random));
    const auto size = static_cast<float>(0.02 * radius * std::pow(10.0, random.uniform()));
    switch (i % 7) {
      case 0:
        shapes.emplace_back(world::Sphere{place, size});
        break;
      case 1:
        shapes.emplace_back(world::Cylinder{place, turned_axis(random), size, 0.5F * size});
        break;
      case 2:
        shapes.emplace_back(world::Cone{place, turned_axis(random), size, size, i % 2 == 0 ? 0.0F : 0.4F * size});
        break;
      case 3:
        shapes.emplace_back(world::Box{place, size * vec3(1.0F, 0.6F, 0.3F), 0.4F * turned_axis(random)});
        break;
      case 4:
        shapes.emplace_back(world::Capsule{place, turned_axis(random), size, 0.6F * size, 0.2F * size});
        break;
      default: {
        Mesh mesh;
        for (int corner = 0; corner < 3; ++corner) mesh.positions.push_back(place + 2.0F * size * turned_axis(random));
        mesh.triangles = {{0, 1, 2}};
        shapes.emplace_back(std::move(mesh));
      }
    }
  }
  shapes.emplace_back(world::Plane{vec3(center - dvec3(0.0, radius, 0.0)), turned_axis(random)});
  return scene_of(std::move(shapes));
}

/// Returns a field of squares with shared edges. Every second square exists twice, so that many crossings have equal t.
world::Scene make_ties() {
  Mesh mesh;
  for (int i = 0; i < 8 * 8; ++i) mesh.positions.emplace_back(i % 8, 0.1F * static_cast<float>((i * i) % 7), i / 8);
  for (uint32_t i = 0; i < 49; ++i) {
    const uint32_t p = i / 7 * 8 + i % 7;
    for (uint32_t repeat = 0; repeat <= i % 2; ++repeat) {
      mesh.triangles.emplace_back(p, p + 1, p + 9);
      mesh.triangles.emplace_back(p, p + 9, p + 8);
    }
  }
  return scene_of({mesh, world::Plane{vec3(0.0F), vec3(0, 1, 0)}, world::Sphere{vec3(3.5F, 0, 3.5F), 1.5F},
                   world::Sphere{vec3(3.5F, 0, 3.5F), 1.5F}});
}

Ray ray_through(const TreeScene& in, Random& random, size_t index) {
  // The ray starts outside, inside, or inside along an axis.
  const dvec3 within = random_point_within(in.center, in.radius, random);
  const dvec3 target = random_point_within(in.center, in.radius, random);
  if (index % 8 < 5) return ray_towards(in.center + 3.0 * in.radius * random.direction(), target);
  Ray ray = ray_towards(within, target);
  if (index % 8 == 7) {
    ray.direction = vec3(0.0F);
    ray.direction[static_cast<int>(index / 8 % 3)] = index % 16 < 8 ? 1.0F : -1.0F;
  }
  if (index % 8 == 6) ray.tmax = static_cast<float>(in.radius * random.uniform());
  return ray;
}

/// Compares the hits with each builder's boxes with the hits without boxes.
void expect_as_brute_force(Lab& lab, const std::string& name, const world::Scene& scene, std::span<const Ray> rays) {
  const FeatureMask features = features_of(scene);
  std::vector<layout::HitRecord> expected;
  for (const std::string_view builder : builder_names()) {
    const PackedScene packed = pack_scene(scene, builder);
    if (expected.empty()) expected = lab.cast_packed(with_infinite_boxes(packed), features, rays);
    lab.expect_at_most("other id or bits of t than brute force, " + std::string(builder) + ", " + name, 0.0,
                       static_cast<double>(count_differences(expected, lab.cast_packed(packed, features, rays))));
  }
}

/// Rays graze triangles. If the t of a hit were outside the triangle's box, the tree would find the hit or not,
/// depending on the builder.
void run_grazed_trees(Lab& lab) {
  Random random(380);
  Mesh mesh;
  for (uint32_t i = 0; i < 300; ++i) {
    const dvec3 center{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
    const Mesh one = make_triangle(center, random);
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    mesh.triangles.push_back(uvec3(0, 1, 2) + 3 * i);
  }
  std::vector<Ray> rays;
  for (size_t i = 0; i < kRaysPerScene; ++i) {
    rays.push_back(ray_grazing(mesh, mesh.triangles[i % mesh.triangles.size()], random));
  }
  expect_as_brute_force(lab, "grazed", scene_of({mesh}), rays);
}

void run_trees(Lab& lab) {
  run_grazed_trees(lab);
  Random random(38);
  const dvec3 far_away(1e5, -2e5, 3e5);
  const std::array scenes{
      TreeScene{"everything", test::make_scene_of_everything(40), dvec3(0, 1.5, 0), 5.0},
      TreeScene{"strewn", make_strewn(dvec3(0.0), 1.0, 80, random), dvec3(0.0), 1.0},
      TreeScene{"strewn at 1e5", make_strewn(far_away, 10.0, 80, random), far_away, 10.0},
      TreeScene{"ties", make_ties(), dvec3(3.5, 0, 3.5), 4.5},
      TreeScene{"pipes", scene_of({test::make_pipes(60)}), dvec3(0.5), 0.9},
  };
  for (const TreeScene& in : scenes) {
    std::vector<Ray> rays;
    for (size_t i = 0; i < kRaysPerScene; ++i) rays.push_back(ray_through(in, random, i));
    expect_as_brute_force(lab, in.name, in.scene, rays);
    const Tally tally = lab.cast_and_judge(in.scene, std::span(rays).first(kJudged));
    lab.expect_at_most(std::string("margin of other answers than the oracle's / uS (B2), ") + in.name, 2.0,
                       tally.max_margin);
    lab.note(std::string("K of t, ") + in.name, tally.max_t_error);
  }
}

/// Small shapes lie far from the world's origin. The origins of rays are at similar and at much larger distances. The
/// step that moves origins nearer may cause an error of at most u S, for any distance of the scene from the origin.
void run_far_from_the_origin(Lab& lab) {
  Random random(55);
  for (const vec3& center : {vec3(1e3F, -8e2F, 1.2e3F), vec3(1e5F, -1e5F, 1e5F)}) {
    for (const double distance : {1e2, 1e3, 1e4, 1e5, 1e6}) {
      Tally tally;
      for (int i = 0; i < kFarShapes; ++i) {
        for_each_solid(center, random, [&](const auto& shape) {
          const auto bound = oracle::bounding_sphere(shape, 0);
          const auto size = static_cast<double>(bound.radius);
          std::vector<Ray> rays;
          for (size_t k = 0; k < kRaysPerFarShape; ++k) {
            // The calls are separate statements, because compilers evaluate arguments in different orders.
            const dvec3 target = random_point_within(dvec3(bound.center), size, random);
            const dvec3 origin = dvec3(bound.center) + distance * size * random.direction();
            rays.push_back(ray_towards(origin, target));
          }
          tally.add(lab.cast_and_judge(scene_of({shape}), rays));
        });
      }
      const std::string where = label("at", center.x) + label(", distance / size", distance);
      lab.expect_at_most("|P - surface| / uS (BK), " + where, 8.0 * lab.rounding_factor(), tally.max_surface_error);
      lab.expect_at_most("margin of other answers / uS (B2), " + where, 2.0, tally.max_margin);
      lab.expect_at_most("malformed hits, " + where, 0.0, static_cast<double>(tally.malformed));
    }
  }
}

constexpr std::array kTreeCases{HardCase{38, "TreesAgainstBruteForce", run_trees},
                                HardCase{55, "TreeFarFromTheOrigin", run_far_from_the_origin}};

}  // namespace

std::span<const HardCase> tree_cases() {
  return kTreeCases;
}

}  // namespace promin::hard
