// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "bvh/builder.h"
#include "gpu/test_scenes.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Returns about 1e4 triangles: a bumpy sheet over [-1, 1]^2.
Mesh make_sheet() {
  constexpr uint32_t kSide = 70;
  Mesh mesh;
  for (uint32_t y = 0; y <= kSide; ++y) {
    for (uint32_t x = 0; x <= kSide; ++x) {
      const double px = 2.0 * x / kSide - 1.0;
      const double py = 2.0 * y / kSide - 1.0;
      mesh.positions.emplace_back(px, 0.1 * std::sin(9.0 * px) * std::cos(7.0 * py), py);
    }
  }
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      const uint32_t p = y * (kSide + 1) + x;
      mesh.triangles.emplace_back(p, p + kSide + 1, p + kSide + 2);
      mesh.triangles.emplace_back(p, p + kSide + 2, p + 1);
    }
  }
  return mesh;
}

Ray ordinary_ray(Random& random) {
  const dvec3 target{random.uniform(-1.0, 1.0), 0.0, random.uniform(-1.0, 1.0)};
  return ray_towards(3.0 * random.direction(), target);
}

/// Returns invalid rays. In each ray another member is NaN or infinite, or the direction is 0.
std::vector<Ray> make_invalid_rays(size_t count_each, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < count_each; ++i) {
    const Ray ray = ordinary_ray(random);
    const auto add = [&](const auto& change) {
      rays.push_back(ray);
      change(rays.back());
    };
    for (const float bad : {kNan, -kNan, kInfinity, -kInfinity}) {
      for (int axis = 0; axis < 3; ++axis) {
        add([&](Ray& r) { r.origin[axis] = bad; });
        add([&](Ray& r) { r.direction[axis] = bad; });
      }
      add([&](Ray& r) { r.origin = vec3(bad); });
      add([&](Ray& r) { r.direction = vec3(bad); });
    }
    add([](Ray& r) { r.tmin = kNan; });
    add([](Ray& r) { r.tmax = kNan; });
    add([](Ray& r) { r.tmin = kInfinity; });
    add([](Ray& r) { r.tmax = -kInfinity; });
    add([](Ray& r) { r.tmin = r.tmax = kInfinity; });
    for (const vec3& none : {vec3(0.0F), vec3(-0.0F), vec3(0.0F, -0.0F, 0.0F)}) {
      add([&](Ray& r) { r.direction = none; });
    }
  }
  return rays;
}

double mean_node_steps(std::span<const layout::HitRecord> records) {
  double sum = 0.0;
  for (const layout::HitRecord& record : records) sum += record.b.w & 0xFFFFU;
  return sum / static_cast<double>(records.size());
}

void run_invalid_rays(Lab& lab) {
  Random random(30);
  world::Scene scene = scene_of({make_sheet()});
  std::vector<Ray> finite;
  for (int i = 0; i < 50000; ++i) {
    finite.push_back(ordinary_ray(random));
    finite.back().tmax = 1e30F;
  }
  const std::vector<Ray> invalid = make_invalid_rays(1250, random);
  const PackedScene packed = pack_scene(scene, builder_names().front());
  double finite_ms = 0.0;
  double invalid_ms = 0.0;
  const FeatureMask features = features_of(scene) | layout::FEATURE_STEP_COUNTS;
  const auto finite_records = lab.cast_packed(packed, features, finite, &finite_ms);
  const auto invalid_records = lab.cast_packed(packed, features, invalid, &invalid_ms);
  uint64_t hit_count = 0;
  for (const layout::HitRecord& record : invalid_records) hit_count += record.a.y != layout::NO_ORDER ? 1 : 0;
  lab.expect_at_most("node steps of such a ray over a finite one's", 2.5,
                     mean_node_steps(invalid_records) / mean_node_steps(finite_records));
  lab.note("node steps of a finite ray", mean_node_steps(finite_records));
  lab.note("ns for such a ray", 1e6 * invalid_ms / static_cast<double>(invalid.size()));
  lab.note("ns for a finite ray", 1e6 * finite_ms / static_cast<double>(finite.size()));

  // A plane and a solid are also in the scene: a plane has no box, and a solid has another formula.
  scene.objects.push_back({"", world::Plane{vec3(0, -2, 0), vec3(0, 1, 0)}, 0});
  scene.objects.push_back({"", world::Sphere{vec3(0, 1, 0), 0.5F}, 0});
  scene.objects.push_back({"", world::Cylinder{vec3(1, 1, 0), vec3(0, 1, 0), 0.5F, 0.25F}, 0});
  scene.objects.push_back({"", world::Cone{vec3(-1, 1, 0), vec3(0, 1, 0), 0.5F, 0.25F, 0.0F}, 0});
  for (const HitQuery query : {HitQuery::kNearest, HitQuery::kAny}) {
    for (const Hit& hit : lab.cast(scene, invalid, query)) {
      hit_count += hit.object >= 0 || !std::isinf(hit.t) ? 1 : 0;
    }
  }
  lab.expect_at_most("hits or not finite of invalid rays", 0.0, static_cast<double>(hit_count));

  // tmax = +Inf is a valid value.
  std::vector<Ray> endless(finite.begin(), finite.begin() + 10000);
  const std::vector<Hit> ended = lab.cast(scene, endless);
  for (Ray& ray : endless) ray.tmax = kInfinity;
  const std::vector<Hit> not_ended = lab.cast(scene, endless);
  uint64_t differences = 0;
  for (size_t i = 0; i < ended.size(); ++i)
    differences += std::memcmp(&ended[i], &not_ended[i], sizeof(Hit)) != 0 ? 1 : 0;
  lab.expect_at_most("other answers with tmax = +Inf than with 1e30", 0.0, static_cast<double>(differences));
}

/// Expects the correct hits for directions with denormal components, and with lengths that the shader does not accept.
/// `scale` keeps t between overflow and underflow.
void expect_directions(Lab& lab, double scale, double length, bool has_denormals, const std::string& where) {
  Random random(301);
  const auto size = static_cast<float>(scale);
  const world::Scene scene =
      scene_of({world::Sphere{vec3(0.0F), size}, world::Plane{vec3(0.0F, -2.0F * size, 0.0F), vec3(0, 1, 0)}});
  std::vector<Ray> rays;
  for (size_t i = 0; i < some_of(20000); ++i) {
    const double reach = 0.9 * scale * random.uniform();
    const dvec3 target = reach * random.direction();
    Ray ray = ray_towards(1.5 * scale * random.direction(), target);
    ray.direction = vec3(length * dvec3(ray.direction));
    if (has_denormals) {
      // The direction goes along an axis, except for the two small components.
      const int axis = static_cast<int>(i % 3);
      ray.origin = vec3(target);
      ray.origin[axis] = 1.5F * size;
      ray.direction = vec3(1e-39F, -1e-41F, 1e-45F);
      ray.direction[axis] = -1.0F;
    }
    rays.push_back(ray);
  }
  const Tally tally = lab.cast_and_judge(scene, rays);
  lab.expect_at_most("margin of other answers / uS (B2), " + where, 2.0, tally.max_margin);
  lab.expect_at_most("K of t (B1), " + where, 8.0 * lab.rounding_factor(), tally.max_t_error);
  lab.expect_at_most("rays without a hit, " + where, 0.0, static_cast<double>(tally.rays - tally.hits));
}

void run_invalid_and_extreme(Lab& lab) {
  run_invalid_rays(lab);
  expect_directions(lab, 1e-2, 1e-40, false, "|d| = 1e-40");
  expect_directions(lab, 1e4, 3e38, false, "|d| = 3e38");
  expect_directions(lab, 1.0, 1.0, true, "denormal components");
}

bool is_same_hit(const Hit& a, const Hit& b) {
  return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

/// The interval of a ray is exactly the open interval (max(tmin, 0), tmax), for each kind of primitive that the ray
/// hits first.
void run_intervals(Lab& lab) {
  Random random(31);
  std::vector<std::pair<const char*, world::Scene>> scenes;
  const vec3 axis(random.direction());
  Mesh mesh;
  mesh.positions = {{-1, -1, 0.1F}, {1.5F, -0.8F, -0.2F}, {0, 1.3F, 0.3F}};
  mesh.triangles = {{0, 1, 2}};
  scenes.emplace_back("triangle", scene_of({mesh}));
  scenes.emplace_back("plane", scene_of({world::Plane{vec3(0.1F, 0.2F, 0.3F), axis}}));
  scenes.emplace_back("sphere", scene_of({world::Sphere{vec3(0.1F, 0.2F, 0.3F), 1.1F}}));
  scenes.emplace_back("cylinder", scene_of({world::Cylinder{vec3(0.1F, 0.2F, 0.3F), axis, 0.7F, 0.6F}}));
  scenes.emplace_back("cone", scene_of({world::Cone{vec3(0.1F, 0.2F, 0.3F), axis, 0.7F, 0.9F, 0.1F}}));
  scenes.emplace_back("everything", test::make_scene_of_everything(50));
  for (const auto& [name, scene] : scenes) {
    std::vector<Ray> rays;
    for (int i = 0; i < 6000; ++i) {
      // A sixth of the rays start so far away that they are moved nearer for the tree (shaders/trace/make_ray.glsl).
      const double distance = i % 6 != 0 ? 4.0 : std::pow(10.0, 4.0 + 3.0 * random.uniform(0.0, 1.0));
      const dvec3 origin = distance * random.direction();
      Ray ray = ray_towards(origin, 0.8 * random.direction());
      // The factor is not a power of two, so that rounding of the scaled ray would show.
      ray.direction *= i % 2 == 0 ? 1.0F : 0.0123F;
      rays.push_back(ray);
    }
    std::vector<Hit> hits = lab.cast(scene, rays);
    for (size_t i = rays.size(); i-- > 0;) {
      if (hits[i].object >= 0) continue;
      rays.erase(rays.begin() + static_cast<std::ptrdiff_t>(i));
      hits.erase(hits.begin() + static_cast<std::ptrdiff_t>(i));
    }
    // Casts the rays with one end changed, and counts those whose answer breaks the rule.
    const auto count = [&](const auto& change, const auto& is_right) {
      std::vector<Ray> changed = rays;
      for (size_t i = 0; i < rays.size(); ++i) change(changed[i], hits[i].t);
      const std::vector<Hit> answers = lab.cast(scene, changed);
      const std::vector<Hit> any = lab.cast(scene, changed, HitQuery::kAny);
      uint64_t wrong = 0;
      for (size_t i = 0; i < rays.size(); ++i) {
        const bool agrees = (answers[i].object >= 0) == (any[i].t == 0.0F);
        wrong += is_right(answers[i], hits[i]) && agrees ? 0 : 1;
      }
      return static_cast<double>(wrong);
    };
    const auto is_miss = [](const Hit& answer, const Hit&) { return answer.object == -1 && std::isinf(answer.t); };
    const auto is_same = [](const Hit& answer, const Hit& first) { return is_same_hit(answer, first); };
    const auto is_later = [](const Hit& answer, const Hit& first) { return answer.t > first.t; };
    const auto above = [](float t) { return std::nextafter(t, kInfinity); };
    const auto below = [](float t) { return std::nextafter(t, 0.0F); };
    const auto expect_none = [&](const char* what, double wrong) {
      lab.expect_at_most(std::string("wrong with ") + what + ", " + name, 0.0, wrong);
    };
    lab.note(std::string("rays, ") + name, static_cast<double>(rays.size()));
    expect_none("tmax = t", count([](Ray& r, float t) { r.tmax = t; }, is_miss));
    expect_none("tmax just above t", count([&](Ray& r, float t) { r.tmax = above(t); }, is_same));
    expect_none("tmin = t", count([](Ray& r, float t) { r.tmin = t; }, is_later));
    expect_none("tmin just below t", count([&](Ray& r, float t) { r.tmin = below(t); }, is_same));
    expect_none("tmin > tmax", count([](Ray& r, float t) { r.tmin = 2.0F * t, r.tmax = 0.5F * t; }, is_miss));
    expect_none("tmin = tmax", count([](Ray& r, float t) { r.tmin = r.tmax = t; }, is_miss));
    expect_none("tmin and tmax about t",
                count([&](Ray& r, float t) { r.tmin = below(t), r.tmax = above(t); }, is_same));
    expect_none("tmin = -0", count([](Ray& r, float) { r.tmin = -0.0F; }, is_same));
    expect_none("tmin < 0", count([](Ray& r, float t) { r.tmin = -3.0F * t; }, is_same));
    expect_none("tmin = -Inf", count([](Ray& r, float) { r.tmin = -kInfinity; }, is_same));
    expect_none("tmax = 0", count([](Ray& r, float) { r.tmax = 0.0F; }, is_miss));
    expect_none("tmax = -0", count([](Ray& r, float) { r.tmax = -0.0F; }, is_miss));
    expect_none("tmax < 0", count([](Ray& r, float t) { r.tmin = -2.0F * t, r.tmax = -t; }, is_miss));
    // The rays have the opposite direction. A negative tmin must not give hits behind the origin.
    if (scene.objects.size() == 1) {
      expect_none("tmin < 0, all behind", count(
                                              [](Ray& r, float t) {
                                                r.direction = -r.direction;
                                                r.tmin = -10.0F * t;
                                              },
                                              is_miss));
    }
  }
}

constexpr std::array kRayCases{HardCase{30, "InvalidRays", run_invalid_and_extreme},
                               HardCase{31, "OpenIntervals", run_intervals}};

}  // namespace

std::span<const HardCase> ray_cases() {
  return kRayCases;
}

}  // namespace promin::hard
