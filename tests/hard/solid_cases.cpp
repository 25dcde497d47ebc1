// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These cases check cylinders, cones and frustums.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>

#include "core/rounding.h"
#include "hard/hard_case.h"
#include "shapes/shapes.h"

namespace promin::hard {
namespace {

/// The number of rays for each of the four axes.
const size_t kSolidRayCount = some_of(25000);
/// For many of the rays that touch an edge, the answer differs from the oracle's, and finding the margin of one takes a
/// millisecond. Therefore B2 is checked for one in this many rays; all hits must lie on the surface.
constexpr size_t kEdgeRaysPerMargin = 64;
/// The number of rays at rims for each of the four axes: a quarter of a million for a form.
const size_t kRimRayCount = some_of(62500);
constexpr double kRadian = 57.29577951308232;

/// A cylinder, cone or frustum with the exact numbers of the device.
struct Solid {
  const char* kind;
  world::Shape shape;
  dvec3 center;
  dvec3 axis;
  double half_height;
  double radius_bottom;
  double radius_top;

  double widest() const { return std::max(radius_bottom, radius_top); }
  /// Returns the radius of the bounding sphere.
  double size() const { return std::hypot(half_height, widest()); }
  double slope() const { return (radius_top - radius_bottom) / (2.0 * half_height); }
  double radius_at(double z) const { return 0.5 * (radius_bottom + radius_top) + slope() * z; }
  dvec3 at(double z, const dvec3& radial) const { return center + z * axis + radial; }
  dvec3 apex() const { return at(half_height, dvec3(0.0)); }
};

Solid make_cylinder(const vec3& center, const dvec3& axis, double half_height, double radius) {
  const world::Cylinder c{center, vec3(glm::normalize(axis)), static_cast<float>(half_height),
                          static_cast<float>(radius)};
  return {"cylinder", c, dvec3(center), glm::normalize(dvec3(c.axis)), c.half_height, c.radius, c.radius};
}

/// Returns a cone whose apex is at the axis' end where `radius_top` is 0.
Solid make_cone(const vec3& center, const dvec3& axis, double half_height, double radius_bottom,
                double radius_top = 0.0) {
  const world::Cone c{center, vec3(glm::normalize(axis)), static_cast<float>(half_height),
                      static_cast<float>(radius_bottom), static_cast<float>(radius_top)};
  return {radius_top == 0.0 ? "cone" : "frustum",
          c,
          dvec3(center),
          glm::normalize(dvec3(c.axis)),
          c.half_height,
          c.radius_bottom,
          c.radius_top};
}

/// Returns a cone with this half angle in degrees; its width or its height is 1, whichever is larger.
Solid make_cone_of(double half_angle, const vec3& center, const dvec3& axis) {
  const double slope = std::tan(half_angle / kRadian);
  const double height = std::min(2.0, 1.0 / slope);
  return make_cone(center, axis, 0.5 * height, height * slope);
}

constexpr std::array<dvec3, 4> axes() {
  return {dvec3(0.0, 1.0, 0.0), dvec3(-1.0, 0.0, 0.0), dvec3(1.0, 2.0, -3.0), dvec3(1e-3, -1e-4, -1.0)};
}

/// Returns a point in the solid, which is enlarged by the factor `spread`.
dvec3 random_point_around(const Solid& solid, double spread, Random& random) {
  const double z = solid.half_height * random.uniform(-1.0, 1.0);
  const double radius = solid.radius_at(z) * std::sqrt(random.uniform());
  return solid.center + spread * (solid.at(z, radius * random.perpendicular(solid.axis)) - solid.center);
}

/// Returns rays from all directions at a distance from the centre. Most of them hit the solid.
std::vector<Ray> rays_around(const Solid& solid, double distance, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const dvec3 origin = solid.center + distance * random.direction();
    rays.push_back(ray_towards(origin, random_point_around(solid, 1.1, random)));
  }
  return rays;
}

/// Returns rays through points in the solid and around it, at an angle to the axis and in the opposite direction, from
/// a distance.
std::vector<Ray> rays_along_axis(const Solid& solid, double sine, double distance, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const dvec3 target = random_point_around(solid, 1.1, random);
    const dvec3 direction =
        (i % 2 == 0 ? 1.0 : -1.0) * std::sqrt(1.0 - sine * sine) * solid.axis + sine * random.perpendicular(solid.axis);
    rays.push_back(ray_towards(target - distance * direction, target));
  }
  return rays;
}

/// Expects the bounds BK and B2, and well-formed hits, for one kind of solid.
void expect_bk_b2(Lab& lab, const std::string& where, const Tally& tally, double factor = 1.0) {
  lab.expect_at_most("|P - surface| / uS (BK), " + where, factor * 8.0 * lab.rounding_factor(),
                     tally.max_surface_error);
  lab.expect_at_most("margin of other answers / uS (B2), " + where, 2.0, tally.max_margin);
  lab.expect_at_most("malformed hits, " + where, 0.0, static_cast<double>(tally.malformed));
}

Tally cast_at(Lab& lab, const Solid& solid, std::span<const Ray> rays) {
  const Tally tally = lab.cast_and_judge(scene_of({solid.shape}), rays);
  Lab::credit(solid.kind, tally);
  return tally;
}

/// Adds rays that touch an edge or an apex to the table of primitives, without B1. B1 has no meaning there, because the
/// normal is discontinuous or undefined.
void credit_at_edge(const Solid& solid, const Tally& tally, uint64_t leaks = 0) {
  Lab::credit(solid.kind, tally.without_t_errors(), leaks);
}

/// Returns |o + t d - surface| / (u S) of the worst hit; it is NaN if a t is not finite.
double worst_surface_error(const Solid& solid, std::span<const Ray> rays, std::span<const Hit> hits) {
  double worst = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (hits[i].object < 0) continue;
    const oracle::Ray ray{oracle::Vector(rays[i].origin), oracle::Vector(rays[i].direction)};
    const oracle::Vector p = ray.origin + oracle::Real(hits[i].t) * ray.direction;
    const oracle::Real error =
        oracle::surface_distance(solid.shape, 0, p) / (oracle::kRoundoff * oracle::scale_of(solid.shape, 0, ray));
    worst = error <= worst ? worst : static_cast<double>(error);
  }
  return worst;
}

/// Casts rays that touch an edge (see kEdgeRaysPerMargin).
Tally cast_at_edge(Lab& lab, const Solid& solid, std::span<const Ray> rays) {
  const world::Scene scene = scene_of({solid.shape});
  const std::vector<Hit> hits = lab.cast(scene, rays);
  std::vector<Ray> judged_rays;
  std::vector<Hit> judged_hits;
  for (size_t i = 0; i < rays.size(); i += kEdgeRaysPerMargin) {
    // The index within each run changes from run to run, because kinds of rays alternate.
    const size_t j = std::min(i + (i / kEdgeRaysPerMargin) % kEdgeRaysPerMargin, rays.size() - 1);
    judged_rays.push_back(rays[j]);
    judged_hits.push_back(hits[j]);
  }
  Tally tally = Lab::judge(scene, judged_rays, judged_hits);
  tally.rays = rays.size();
  tally.max_surface_error = worst_surface_error(solid, rays, hits);
  credit_at_edge(solid, tally);
  return tally;
}

/// The form of a solid, without its orientation.
struct Form {
  std::string name;
  Solid (*make)(const vec3& center, const dvec3& axis);
};

void run_around_solid(Lab& lab, const Form& form, std::initializer_list<double> distances, const vec3& center,
                      Random& random) {
  for (const double distance : distances) {
    Tally tally;
    for (const dvec3& axis : axes()) {
      const Solid solid = form.make(center, axis);
      tally.add(cast_at(lab, solid, rays_around(solid, distance, random)));
    }
    expect_bk_b2(lab, form.name + label(", distance", distance), tally);
  }
}

constexpr vec3 kOrigin(0.0F);
constexpr vec3 kFarAway(1e5F, -1e5F, 1e5F);

Solid unit_cylinder(const vec3& center, const dvec3& axis) {
  return make_cylinder(center, axis, 1.0, 1.0);
}
Solid long_cylinder(const vec3& center, const dvec3& axis) {
  return make_cylinder(center, axis, 20.0, 1.0);
}
Solid small_cylinder(const vec3& center, const dvec3& axis) {
  return make_cylinder(center, axis, 1e-3, 1e-3);
}
Solid disk(const vec3& center, const dvec3& axis) {
  return make_cylinder(center, axis, 1e-4, 1.0);
}
Solid needle(const vec3& center, const dvec3& axis) {
  return make_cylinder(center, axis, 1.0, 1e-4);
}
template <int kTenths>
Solid cone_of(const vec3& center, const dvec3& axis) {
  return make_cone_of(0.1 * kTenths, center, axis);
}
Solid frustum(const vec3& center, const dvec3& axis) {
  return make_cone(center, axis, 1.0, 0.5, 1.5);
}
Solid near_cone(const vec3& center, const dvec3& axis) {
  return make_cone(center, axis, 1.0, 1.0, 1e-5);
}
Solid near_cylinder(const vec3& center, const dvec3& axis) {
  return make_cone(center, axis, 1.0, 1.0, 1.0 + 0x1p-20);
}
Solid flat_frustum(const vec3& center, const dvec3& axis) {
  return make_cone(center, axis, 1e-4, 1.0, 0.5);
}

void run_cylinder_distances(Lab& lab) {
  Random random(12);
  run_around_solid(lab, {"cylinder", unit_cylinder}, {3.0, 1e1, 1e2, 1e3, 1e4, 1e5}, kOrigin, random);
  run_around_solid(lab, {"r = 1e-3", small_cylinder}, {10.0}, kOrigin, random);
  run_around_solid(lab, {"flat cylinder", disk}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"needle", needle}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"cylinder at 1e5", unit_cylinder}, {10.0}, kFarAway, random);
}

void run_along_axis(Lab& lab) {
  Random random(13);
  const Form forms[] = {
      {"cylinder", unit_cylinder}, {"long cylinder", long_cylinder}, {"cone 20", cone_of<200>}, {"frustum", frustum}};
  for (const Form& form : forms) {
    for (const auto& [sine, factor] : {std::array{1e-1, 1.0}, {1e-2, 1.0}, {1e-3, 2.0}, {1e-4, 8.0}}) {
      Tally tally;
      for (const dvec3& axis : axes()) {
        const Solid solid = form.make(kOrigin, axis);
        tally.add(cast_at(lab, solid, rays_along_axis(solid, sine, 100.0, random)));
      }
      expect_bk_b2(lab, form.name + label(", sine", sine), tally, factor);
    }
  }
}

/// Returns rays exactly along the axis onto the wide end, each at one of `impacts` times the radius of that end.
std::vector<Ray> parallel_rays(const Solid& solid, double distance, double low, double high, Random& random) {
  const bool is_upward = solid.radius_bottom >= solid.radius_top;
  const vec3 axis = std::visit(
      [](const auto& shape) {
        if constexpr (requires { shape.axis; }) return shape.axis;
        return vec3(0.0F);
      },
      solid.shape);
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const double impact = solid.widest() * random.uniform(low, high);
    const dvec3 foot = solid.at(0.0, impact * random.perpendicular(solid.axis));
    // A cylinder gets rays from both sides.
    const float sign = (solid.radius_bottom == solid.radius_top ? i % 2 == 0 : is_upward) ? 1.0F : -1.0F;
    Ray ray = ray_towards(foot - distance * static_cast<double>(sign) * solid.axis, foot);
    ray.direction = sign * axis;
    rays.push_back(ray);
  }
  return rays;
}

void run_parallel_to_solids(Lab& lab) {
  Random random(14);
  const Form forms[] = {{"cylinder", unit_cylinder},
                        {"disk", disk},
                        {"cone 20, from below", cone_of<200>},
                        {"frustum, from its wide end", frustum}};
  for (const Form& form : forms) {
    for (const double distance : {3.0, 100.0, 1e4}) {
      uint64_t not_caps = 0;
      uint64_t hits_outside = 0;
      Tally at_rim;
      for (const dvec3& axis : axes()) {
        const Solid solid = form.make(kOrigin, axis);
        // The gap is 4 u S, twice the error that B2 allows.
        const double gap = 4.0 * static_cast<double>(kUnitRoundoff) * (2.0 * distance + solid.size());
        const world::Scene scene = scene_of({solid.shape});
        for (const Hit& hit : lab.cast(scene, parallel_rays(solid, distance, 0.0, 1.0 - gap, random))) {
          const double cosine = std::abs(glm::dot(dvec3(hit.normal), solid.axis));
          not_caps += hit.object < 0 || !(cosine > 1.0 - 1e-6);
        }
        for (const Hit& hit : lab.cast(scene, parallel_rays(solid, distance, 1.0 + gap, 2.0, random))) {
          hits_outside += hit.object >= 0;
        }
        at_rim.add(cast_at_edge(lab, solid, parallel_rays(solid, distance, 1.0, 1.0, random)));
      }
      const std::string where = form.name + label(", distance", distance);
      lab.expect_at_most("impact < r: misses and sides, " + where, 0.0, static_cast<double>(not_caps));
      lab.expect_at_most("impact > r: hits, " + where, 0.0, static_cast<double>(hits_outside));
      expect_bk_b2(lab, "impact = r, " + where, at_rim);
    }
  }
}

/// Returns a direction from which both faces with these unit normals are visible, well inside the silhouette. The
/// cosine to each is at least about a fifth of the largest cosine that both can have.
dvec3 random_direction_onto(const dvec3& face, const dvec3& other, Random& random) {
  const dvec3 middle = glm::normalize(face + other);
  const dvec3 across = glm::normalize(face - other);
  // Up to this length along `across`, neither face is turned away. If the faces are almost one, the limit is 45
  // degrees.
  const double most = std::min(1.0, glm::dot(face, middle) / glm::dot(face, across));
  const double aside = random.uniform(-0.8, 0.8) * most;
  const double along_rim = random.uniform(-1.0, 1.0);
  return -glm::normalize(middle + aside * across + along_rim * glm::cross(middle, across));
}

/// Returns rays towards points of the rims, well inside the silhouette: cap and side both face the ray. The last
/// `around` rays come from all directions.
std::vector<Ray> rays_at_rims(const Solid& solid, size_t around, Random& random) {
  std::vector<Ray> rays;
  while (rays.size() < kRimRayCount) {
    const double end = solid.radius_bottom > 0.0 && (solid.radius_top == 0.0 || rays.size() % 2 == 0) ? -1.0 : 1.0;
    const dvec3 radial = random.perpendicular(solid.axis);
    const dvec3 rim = solid.at(end * solid.half_height, solid.radius_at(end * solid.half_height) * radial);
    const dvec3 side = glm::normalize(radial - solid.slope() * solid.axis);
    const dvec3 cap = end * solid.axis;
    // A very sharp rim is close to the silhouette. For distant origins, u S would exceed the distance to the
    // silhouette.
    const double most = glm::distance(side, -cap) > 0.1 ? 3.0 : 1.5;
    const double distance = solid.size() * std::pow(10.0, random.uniform(0.5, most));
    const dvec3 direction =
        rays.size() < kRimRayCount - around ? random_direction_onto(side, cap, random) : random.direction();
    rays.push_back(ray_towards(rim - distance * direction, rim));
  }
  return rays;
}

void run_rims(Lab& lab) {
  Random random(15);
  const Form forms[] = {{"cylinder", unit_cylinder}, {"cone 20", cone_of<200>},   {"cone 70", cone_of<700>},
                        {"frustum", frustum},        {"cone 89.9", cone_of<899>}, {"flat frustum", flat_frustum},
                        {"cone 1", cone_of<10>}};
  for (const Form& form : forms) {
    uint64_t leaks = 0;
    Tally tally;
    for (const dvec3& axis : axes()) {
      const Solid solid = form.make(kOrigin, axis);
      // Rays from all directions often hit the silhouette (see kEdgeRaysPerMargin).
      const size_t around = kRimRayCount / kEdgeRaysPerMargin;
      const std::vector<Ray> rays = rays_at_rims(solid, around, random);
      const world::Scene scene = scene_of({solid.shape});
      const std::vector<Hit> hits = lab.cast(scene, rays);
      const size_t facing = rays.size() - around;
      Tally judged = Lab::judge(scene, std::span(rays).first(facing), std::span(hits).first(facing));
      const uint64_t missed = judged.misses;
      judged.add(Lab::judge(scene, std::span(rays).subspan(facing), std::span(hits).subspan(facing)));
      credit_at_edge(solid, judged, missed);
      leaks += missed;
      tally.add(judged);
    }
    lab.expect_at_most("leaks, " + form.name, 0.0, static_cast<double>(leaks));
    expect_bk_b2(lab, form.name, tally);
  }
}

void run_inside_solids(Lab& lab) {
  Random random(16);
  const vec3 center(1.0F, 2.0F, 3.0F);
  const Form forms[] = {{"cylinder", unit_cylinder}, {"flat cylinder", disk},   {"long cylinder", long_cylinder},
                        {"cone 20", cone_of<200>},   {"cone 85", cone_of<850>}, {"frustum", frustum}};
  for (const Form& form : forms) {
    uint64_t by_cap = 0;
    uint64_t by_side = 0;
    Tally tally;
    for (const dvec3& axis : axes()) {
      const Solid solid = form.make(center, axis);
      std::vector<Ray> rays;
      while (rays.size() < kSolidRayCount) {
        const dvec3 origin = random_point_around(solid, 1.0, random);
        const Ray ray = ray_towards(origin, origin + random.direction());
        // The ray is inside also after rounding, by more than B2 allows as an error.
        const oracle::Ray exact{oracle::Vector(ray.origin), oracle::Vector(ray.direction)};
        const oracle::Real least = 4 * oracle::kRoundoff * oracle::scale_of(solid.shape, 0, exact);
        if (oracle::signed_distance(solid.shape, 0, exact.origin) < -least) rays.push_back(ray);
      }
      const world::Scene scene = scene_of({solid.shape});
      const std::vector<Hit> hits = lab.cast(scene, rays);
      for (const Hit& hit : hits) {
        if (hit.object < 0) continue;
        ++(std::abs(glm::dot(dvec3(hit.normal), solid.axis)) > 1.0 - 1e-6 ? by_cap : by_side);
      }
      const Tally judged = Lab::judge(scene, rays, hits);
      Lab::credit(solid.kind, judged);
      tally.add(judged);
    }
    expect_bk_b2(lab, form.name, tally);
    lab.expect_at_most("missed, " + form.name, 0.0, static_cast<double>(tally.misses));
    lab.expect_at_most("kinds of exit that were not tried, " + form.name, 0.0,
                       static_cast<double>((by_cap < 5) + (by_side < 5)));
  }
}

void run_cones(Lab& lab) {
  Random random(18);
  const std::initializer_list<double> distances = {3.0, 1e1, 1e2, 1e3, 1e4};
  run_around_solid(lab, {"cone 1", cone_of<10>}, distances, kOrigin, random);
  run_around_solid(lab, {"cone 20", cone_of<200>}, distances, kOrigin, random);
  run_around_solid(lab, {"cone 85", cone_of<850>}, distances, kOrigin, random);
  run_around_solid(lab, {"frustum", frustum}, distances, kOrigin, random);
  run_around_solid(lab, {"cone 0.1", cone_of<1>}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"cone 89.9", cone_of<899>}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"almost a cylinder", near_cylinder}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"almost a cone", near_cone}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"flat frustum", flat_frustum}, {3.0, 1e3}, kOrigin, random);
  run_around_solid(lab, {"cone 20 at 1e5", cone_of<200>}, {10.0}, kFarAway, random);
  run_around_solid(lab, {"frustum at 1e5", frustum}, {10.0}, kFarAway, random);
}

/// Returns rays parallel to a generator, as nearly as fp32 allows, through the solid and beside it.
std::vector<Ray> rays_along_generators(const Solid& solid, double distance, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const double sign = i % 2 == 0 ? 1.0 : -1.0;
    const dvec3 generator = sign * glm::normalize(solid.axis + solid.slope() * random.perpendicular(solid.axis));
    const dvec3 target = random_point_around(solid, 1.1, random);
    rays.push_back(ray_towards(target - distance * generator, target));
  }
  return rays;
}

/// Returns rays at the apex: from all around, along generators, and along the axis.
std::vector<Ray> rays_at_apex(const Solid& solid, double distance, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const dvec3 sideways = random.perpendicular(solid.axis);
    const dvec3 direction = i % 4 == 0   ? random.direction()
                            : i % 4 == 1 ? glm::normalize(solid.axis + solid.slope() * sideways)
                            : i % 4 == 2 ? solid.axis
                                         : glm::normalize(solid.axis + 1e-3 * random.uniform() * sideways);
    const double sign = i % 8 < 4 ? 1.0 : -1.0;
    rays.push_back(ray_towards(solid.apex() + sign * distance * direction, solid.apex()));
  }
  return rays;
}

void run_generators_and_apex(Lab& lab) {
  Random random(19);
  const std::pair<double, Form> forms[] = {{1.0, {"cone 1", cone_of<10>}},
                                           {20.0, {"cone 20", cone_of<200>}},
                                           {45.0, {"cone 45", cone_of<450>}},
                                           {85.0, {"cone 85", cone_of<850>}}};
  for (const auto& [half_angle, form] : forms) {
    for (const double distance : {3.0, 1e3}) {
      Tally along;
      Tally apex;
      for (const dvec3& axis : axes()) {
        const Solid solid = form.make(kOrigin, axis);
        const Tally judged =
            lab.cast_and_judge(scene_of({solid.shape}), rays_along_generators(solid, distance, random));
        credit_at_edge(solid, judged);
        along.add(judged);
        apex.add(cast_at_edge(lab, solid, rays_at_apex(solid, distance, random)));
      }
      const double factor = 1.0 / std::sin(half_angle / kRadian);
      const std::string where = form.name + label(", distance", distance);
      expect_bk_b2(lab, "along a generator, " + where, along, factor);
      expect_bk_b2(lab, "through the apex, " + where, apex, factor);
    }
  }

  // The directions of these generators are exact in fp32: (3, 4, 0) on a cone of slope 3/4, and (1, 1, 0) on a cone of
  // slope 1.
  Tally exact;
  for (const auto& [slope, direction] : {std::pair{0.75, vec3(3.0F, 4.0F, 0.0F)}, {1.0, vec3(1.0F, 1.0F, 0.0F)}}) {
    const Solid solid = make_cone(kOrigin, dvec3(0.0, 1.0, 0.0), 1.0, 2.0 * slope);
    std::vector<Ray> rays;
    for (size_t i = 0; i < kSolidRayCount; ++i) {
      // Every eighth ray goes through the apex.
      const dvec3 target = i % 8 == 0 ? solid.apex() : random_point_around(solid, 1.1, random);
      const float sign = i % 2 == 0 ? 1.0F : -1.0F;
      const vec3 step = sign * vec3(direction.x * (i % 4 < 2 ? 1.0F : -1.0F), direction.y, direction.z);
      rays.push_back({vec3(target) - 4.0F * step, 0.0F, step, std::numeric_limits<float>::infinity()});
    }
    const Tally judged = lab.cast_and_judge(scene_of({solid.shape}), rays);
    credit_at_edge(solid, judged);
    exact.add(judged);
  }
  expect_bk_b2(lab, "along generators that are exact", exact, 1.0 / 0.6);
}

/// Returns rays through the mirror nappe and the solid's box, past the solid.
std::vector<Ray> rays_at_mirror_nappe(const Solid& solid, Random& random) {
  // This solid is larger by a hundredth on all sides; it distinguishes rays past the solid from rays that touch it.
  const double more = 0.01 * solid.size();
  world::Cone grown = std::get<world::Cone>(solid.shape);
  const auto widen = [&](float radius) { return static_cast<float>(radius + more * (1.0 + std::abs(solid.slope()))); };
  grown.half_height += static_cast<float>(more);
  grown.radius_bottom = widen(grown.radius_bottom);
  grown.radius_top = widen(grown.radius_top);
  const world::Scene guard = scene_of({grown});
  const Bounds box = bounds_of(std::get<world::Cone>(solid.shape));

  const double slope = -solid.slope();
  const dvec3 apex = solid.at(solid.radius_at(0.0) / slope, dvec3(0.0));
  std::vector<Ray> rays;
  while (rays.size() < kSolidRayCount) {
    const double beyond = solid.size() * std::pow(10.0, random.uniform(-2.0, 1.0));
    const dvec3 on_nappe = apex + beyond * (solid.axis + slope * random.perpendicular(solid.axis));
    dvec3 in_box(0.0);
    for (int i = 0; i < 3; ++i) in_box[i] = random.uniform(box.lo[i], box.hi[i]);
    const dvec3 direction = (rays.size() % 2 == 0 ? 1.0 : -1.0) * glm::normalize(in_box - on_nappe);
    const Ray ray = ray_towards(in_box - 30.0 * solid.size() * direction, on_nappe);
    if (!oracle::is_occluded(guard, {oracle::Vector(ray.origin), oracle::Vector(ray.direction)})) rays.push_back(ray);
  }
  return rays;
}

void run_mirror_nappe(Lab& lab) {
  Random random(20);
  const Form forms[] = {
      {"cone 1", cone_of<10>}, {"cone 20", cone_of<200>}, {"cone 85", cone_of<850>}, {"almost a cone", near_cone}};
  for (const Form& form : forms) {
    uint64_t hits = 0;
    for (const dvec3& axis : axes()) {
      const Solid solid = form.make(kOrigin, axis);
      for (const Hit& hit : lab.cast(scene_of({solid.shape}), rays_at_mirror_nappe(solid, random))) {
        hits += hit.object >= 0 || !std::isinf(hit.t);
      }
    }
    lab.expect_at_most("hits of the mirror nappe, " + form.name, 0.0, static_cast<double>(hits));
  }
}

/// Returns rays in the plane of a disk or of an apex, or a few roundings beside it, across the disk and past its rim.
/// They are level, or tilted by so little that they meet the plane far beyond the solid or nowhere.
std::vector<Ray> rays_in_cap_planes(const Solid& solid, Random& random) {
  std::vector<Ray> rays;
  for (size_t i = 0; i < kSolidRayCount; ++i) {
    const double end = i % 2 == 0 ? -1.0 : 1.0;
    const double radius = solid.radius_at(end * solid.half_height);
    const dvec3 along = random.perpendicular(solid.axis);
    const dvec3 aside = glm::cross(solid.axis, along);
    // A third of all rays pass just beyond the rim.
    const double impact = i % 3 == 0 ? 1.0 + std::pow(10.0, random.uniform(-7.0, 0.0)) : random.uniform(0.0, 2.0);
    const dvec3 nearest = solid.at(end * solid.half_height, impact * radius * aside);
    const double distance = solid.size() * std::pow(10.0, random.uniform(-1.0, 3.0));
    const double beside = static_cast<double>(kUnitRoundoff) * solid.size() * std::round(random.uniform(-8.0, 8.0));
    const double tilt = i % 5 == 0 ? 0.0 : (i % 7 < 4 ? 1.0 : -1.0) * std::exp2(-random.uniform(8.0, 90.0));
    const vec3 origin(nearest - distance * along + beside * solid.axis);
    // The direction does not have unit length, so that the tilt is exact if the axis is a coordinate axis, even if the
    // tilt is tiny.
    rays.push_back({origin, 0.0F, vec3(along + tilt * solid.axis), std::numeric_limits<float>::infinity()});
  }
  return rays;
}

void run_cap_planes(Lab& lab) {
  Random random(54);
  const Form forms[] = {{"cylinder", unit_cylinder}, {"flat cylinder", disk},        {"needle", needle},
                        {"frustum", frustum},        {"flat frustum", flat_frustum}, {"cone 20", cone_of<200>},
                        {"cone 85", cone_of<850>}};
  for (const Form& form : forms) {
    Tally tally;
    for (const dvec3& axis : axes()) {
      const Solid solid = form.make(kOrigin, axis);
      tally.add(cast_at_edge(lab, solid, rays_in_cap_planes(solid, random)));
    }
    expect_bk_b2(lab, form.name, tally);
  }
}

constexpr std::array kSolidCases{HardCase{12, "CylinderFarAway", run_cylinder_distances},
                                 HardCase{13, "AlmostAlongTheAxis", run_along_axis},
                                 HardCase{14, "ParallelToTheAxis", run_parallel_to_solids},
                                 HardCase{15, "Rims", run_rims},
                                 HardCase{16, "SolidFromInside", run_inside_solids},
                                 HardCase{18, "ConeFarAway", run_cones},
                                 HardCase{19, "GeneratorsAndApex", run_generators_and_apex},
                                 HardCase{20, "MirrorNappe", run_mirror_nappe},
                                 HardCase{54, "PlanesOfDisks", run_cap_planes}};

}  // namespace

std::span<const HardCase> solid_cases() {
  return kSolidCases;
}

}  // namespace promin::hard
