// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>

#include "hard/bouncer.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

using oracle::Real;
using oracle::Vector;

constexpr double kPi = std::numbers::pi;
const size_t kTriangleRayCount = some_of(100000);

/// Returns a closed UV sphere as in Embree's watertightness tests: `steps` + 1 rows of 2 * `steps` vertices; all
/// vertices of a pole are at the same place.
Mesh make_uv_sphere(const dvec3& center, uint32_t steps, const std::function<double(uint32_t, uint32_t)>& radius_of) {
  Mesh mesh;
  const uint32_t width = 2 * steps;
  for (uint32_t row = 0; row <= steps; ++row) {
    const double phi = kPi * row / steps;
    for (uint32_t column = 0; column < width; ++column) {
      const double theta = 2.0 * kPi * column / width;
      const bool is_pole = row == 0 || row == steps;
      const double across = is_pole ? 0.0 : std::sin(phi);
      const double radius = radius_of(row, is_pole ? 0 : column);
      mesh.positions.emplace_back(center +
                                  radius * dvec3(across * std::sin(theta), std::cos(phi), across * std::cos(theta)));
    }
  }
  for (uint32_t row = 1; row <= steps; ++row) {
    for (uint32_t column = 0; column < width; ++column) {
      const uint32_t next = (column + 1) % width;
      const uint32_t p00 = (row - 1) * width + column;
      const uint32_t p01 = (row - 1) * width + next;
      const uint32_t p10 = row * width + column;
      const uint32_t p11 = row * width + next;
      if (row > 1) mesh.triangles.emplace_back(p10, p01, p00);
      if (row < steps) mesh.triangles.emplace_back(p11, p01, p10);
    }
  }
  return mesh;
}

size_t pick(Random& random, size_t count) {
  return std::min(count - 1, static_cast<size_t>(random.uniform() * static_cast<double>(count)));
}

dvec3 pick_vertex(const Mesh& mesh, Random& random) {
  const uvec3& corners = mesh.triangles[pick(random, mesh.triangles.size())];
  return mesh.positions[corners[static_cast<int>(pick(random, 3))]];
}

dvec3 pick_on_edge(const Mesh& mesh, Random& random) {
  const uvec3& corners = mesh.triangles[pick(random, mesh.triangles.size())];
  const int first = static_cast<int>(pick(random, 3));
  return glm::mix(dvec3(mesh.positions[corners[first]]), dvec3(mesh.positions[corners[(first + 1) % 3]]),
                  random.uniform());
}

dvec3 pick_inside(const Mesh& mesh, Random& random) {
  const uvec3& corners = mesh.triangles[pick(random, mesh.triangles.size())];
  return random.inside(mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]);
}

template <typename MakeRay>
std::vector<Ray> repeat_ray(size_t count, const MakeRay& make_ray) {
  std::vector<Ray> rays;
  rays.reserve(count);
  for (size_t i = 0; i < count; ++i) rays.push_back(make_ray());
  return rays;
}

uint64_t count_misses(std::span<const Hit> hits) {
  return static_cast<uint64_t>(std::count_if(
      hits.begin(), hits.end(), [](const Hit& hit) { return !(hit.object >= 0 && std::isfinite(hit.t)); }));
}

uint64_t count_hits(std::span<const Hit> hits) {
  return hits.size() - static_cast<uint64_t>(std::count_if(hits.begin(), hits.end(), [](const Hit& hit) {
           return hit.object == -1 && std::isinf(hit.t);
         }));
}

/// Each of these rays must hit the mesh.
void expect_no_leaks(Lab& lab, const world::Scene& scene, std::span<const Ray> rays, const std::string& what) {
  const std::vector<Hit> hits = lab.cast(scene, rays);
  const uint64_t leaks = count_misses(hits);
  lab.expect_at_most("leaks, " + what, 0.0, static_cast<double>(leaks));
  // The oracle tries every triangle, and at vertices its search for the margin takes long.
  const size_t judged = std::clamp<size_t>(500000 / primitive_count(scene.objects.front().shape), 1, 200);
  Tally tally = Lab::judge(scene, rays.first(judged), std::span(hits).first(judged));
  tally.rays = rays.size();
  Lab::credit("triangle", tally, leaks);
}

void cast_at_closed_mesh(Lab& lab, const dvec3& center, uint32_t steps, size_t random_count, const std::string& where) {
  Random random(steps);
  const Mesh mesh = make_uv_sphere(center, steps, [](uint32_t, uint32_t) { return 2.0; });
  const world::Scene scene = scene_of({mesh});
  const auto origin = [&] {
    const double reach = random.uniform();
    return center + reach * random.direction();
  };
  const auto at_random = [&] {
    const dvec3 from = origin();
    return ray_towards(from, dvec3(vec3(from)) + random.direction());
  };
  expect_no_leaks(lab, scene, repeat_ray(random_count, at_random), "random rays from inside" + where);
  const auto at = [&](dvec3 (*pick_target)(const Mesh&, Random&)) {
    const dvec3 from = origin();
    return ray_towards(from, pick_target(mesh, random));
  };
  expect_no_leaks(lab, scene, repeat_ray(kTriangleRayCount, [&] { return at(pick_vertex); }),
                  "at vertices from inside" + where);
  expect_no_leaks(lab, scene, repeat_ray(kTriangleRayCount, [&] { return at(pick_on_edge); }),
                  "at edges from inside" + where);

  // The rays come from outside and pass through the inside. If a hit is beyond the middle, the ray has passed through
  // the near side.
  std::vector<Ray> rays;
  while (rays.size() < kTriangleRayCount) {
    const dvec3 from = center + 10.0 * random.direction();
    const dvec3 target = rays.size() % 2 == 0 ? pick_vertex(mesh, random) : pick_on_edge(mesh, random);
    Ray ray = ray_towards(from, target);
    const dvec3 to_center = center - dvec3(ray.origin);
    const dvec3 along = glm::normalize(dvec3(ray.direction));
    if (glm::length(glm::cross(to_center, along)) > 1.8) continue;
    ray.tmax = static_cast<float>(glm::dot(to_center, along));
    rays.push_back(ray);
  }
  expect_no_leaks(lab, scene, rays, "at vertices and edges from outside" + where);
}

/// Casts rays at a triangle whose three corners lie in a line, with two triangles below and one above: the middle
/// corner lies on the edge of the triangle above. There are many such groups side by side.
void cast_at_collinear_corners(Lab& lab) {
  Random random(210);
  Mesh mesh;
  std::vector<std::array<dvec3, 2>> seams;
  // Coordinates are in fixed point, so that the middle is exact.
  const auto point = [&](double reach) { return glm::round(reach * random.direction() * 1024.0) / 1024.0; };
  for (int i = 0; i < 256; ++i) {
    const dvec3 center(4.0 * (i % 16), 0.0, 4.0 * (i / 16));
    const dvec3 half = point(1.0);
    const dvec3 across = 0.8 * random.perpendicular(glm::normalize(half));
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const dvec3& p : {center - half, center, center + half, center + across, center - across}) {
      mesh.positions.emplace_back(p);
    }
    for (const uvec3& corners : {uvec3(0, 1, 2), uvec3(0, 4, 1), uvec3(1, 4, 2), uvec3(2, 3, 0)}) {
      mesh.triangles.push_back(corners + first);
    }
    seams.push_back({center - half, center + half});
  }
  std::vector<Ray> rays;
  while (rays.size() < kTriangleRayCount) {
    const auto& seam = seams[pick(random, seams.size())];
    const dvec3 target = glm::mix(seam[0], seam[1], random.uniform(0.01, 0.99));
    Ray ray = ray_towards(target + random.direction(), target);
    // Other groups lie behind.
    ray.tmax = 1.1F;
    const uint32_t group = static_cast<uint32_t>(&seam - seams.data());
    const vec3* corners = &mesh.positions[5 * group];
    const dvec3 normal = glm::normalize(glm::cross(dvec3(corners[2] - corners[0]), dvec3(corners[3] - corners[0])));
    if (std::abs(glm::dot(normal, dvec3(ray.direction))) > 0.1) rays.push_back(ray);
  }
  const world::Scene scene = scene_of({mesh});
  expect_no_leaks(lab, scene, rays, "at edges with a collinear corner");
  const Tally tally = lab.cast_and_judge(scene, std::span(rays).first(300));
  lab.expect_at_most("margin of other answers / uS (B2), collinear corner", 2.0, tally.max_margin);
  lab.expect_at_most("K of t (B1), collinear corner", 8.0 * lab.rounding_factor(), tally.max_t_error);
  lab.expect_at_most("malformed hits, collinear corner", 0.0, static_cast<double>(tally.malformed));
}

void run_closed_mesh(Lab& lab) {
  cast_at_collinear_corners(lab);
  const dvec3 center(148376.0, 1234.0, -223423.0);
  cast_at_closed_mesh(lab, center, 50, some_of(1000000), ", 50 steps");
  cast_at_closed_mesh(lab, center, 200, some_of(1000000), ", 200 steps");
  // On a coarse grid in all three axes, many triangles have three corners in a line: they are not packed, and the
  // corner in the middle lies on the edge of a neighbour.
  cast_at_closed_mesh(lab, dvec3(148376.0, 171234.0, -223423.0), 200, kTriangleRayCount, ", collinear corners");
}

void run_spikes(Lab& lab) {
  Random random(22);
  const Mesh mesh = make_uv_sphere(dvec3(0.0), 16,
                                   [](uint32_t row, uint32_t column) { return (row + column) % 2 == 0 ? 10.0 : 0.5; });
  const world::Scene scene = scene_of({mesh});
  const dvec3 center(0.0);
  expect_no_leaks(lab, scene, repeat_ray(kTriangleRayCount, [&] { return ray_towards(center, random.direction()); }),
                  "random rays from the centre");
  expect_no_leaks(lab, scene,
                  repeat_ray(some_of(50000), [&] { return ray_towards(center, pick_vertex(mesh, random)); }),
                  "at vertices from the centre");
  expect_no_leaks(lab, scene,
                  repeat_ray(some_of(50000), [&] { return ray_towards(center, pick_on_edge(mesh, random)); }),
                  "at edges from the centre");
}

/// Places a drawing of [-1, 1]^2 in space. It is axis-aligned, or rotated so that no coordinate is a round number.
struct Placement {
  const char* name;
  dvec3 center;
  dvec3 right;
  dvec3 up;

  dvec3 at(double x, double y) const { return center + x * right + y * up; }
  dvec3 normal() const { return glm::cross(right, up); }
};

std::array<Placement, 2> placements(Random& random) {
  const dvec3 right = random.direction();
  const dvec3 up = random.perpendicular(right);
  return {Placement{"as it lies", dvec3(0.0), {1, 0, 0}, {0, 1, 0}},
          Placement{"turned", dvec3(12.3, -45.6, 78.9), right, up}};
}

Mesh make_square(const Placement& place, uint32_t width, uint32_t height) {
  Mesh mesh;
  for (uint32_t y = 0; y <= height; ++y) {
    for (uint32_t x = 0; x <= width; ++x) {
      mesh.positions.emplace_back(place.at(2.0 * x / width - 1.0, 2.0 * y / height - 1.0));
    }
  }
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const uint32_t p = y * (width + 1) + x;
      const uint32_t q = p + width + 1;
      mesh.triangles.emplace_back(p, p + 1, q + 1);
      mesh.triangles.emplace_back(p, q + 1, q);
    }
  }
  return mesh;
}

Mesh make_fan(const Placement& place, uint32_t count) {
  Mesh mesh;
  mesh.positions.emplace_back(place.at(0.0, 0.0));
  for (uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * i / count;
    mesh.positions.emplace_back(place.at(std::cos(angle), std::sin(angle)));
    mesh.triangles.emplace_back(0, i + 1, (i + 1) % count + 1);
  }
  return mesh;
}

/// Casts 256^2 rays at a lattice inside [-reach, reach]^2 and half as many at vertices and edges there, along the
/// normal and at other angles. Returns the number of leaks.
uint64_t count_surface_leaks(Lab& lab, const Placement& place, const Mesh& mesh, double reach, Random& random) {
  const dvec3 oblique = glm::normalize(place.normal() + 1.5 * place.right - 0.7 * place.up);
  std::vector<Ray> rays;
  const auto add = [&](const dvec3& target, bool is_oblique) {
    const dvec3 from_center = target - place.center;
    const double farthest =
        std::max(std::abs(glm::dot(from_center, place.right)), std::abs(glm::dot(from_center, place.up)));
    if (farthest <= reach) rays.push_back(ray_towards(target + 3.0 * (is_oblique ? oblique : place.normal()), target));
  };
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 256; ++x) {
      // Multiples of 1/2, 1/4 and so on are vertices of the square.
      add(place.at((x - 128) / 128.0, (y - 128) / 128.0), (x + y) % 2 != 0);
      if (x % 2 == 0) add(x % 4 == 0 ? pick_vertex(mesh, random) : pick_on_edge(mesh, random), y % 2 != 0);
    }
  }
  const uint64_t leaks = count_misses(lab.cast(scene_of({mesh}), rays));
  Tally tally;
  tally.rays = rays.size();
  Lab::credit("triangle", tally, leaks);
  return leaks;
}

void run_squares_and_fans(Lab& lab) {
  Random random(23);
  for (const Placement& place : placements(random)) {
    uint64_t leaks = 0;
    for (uint32_t side = 1; side <= 128; side *= 2) {
      // The meshes have 4, 16 ... 65536 triangles.
      leaks += count_surface_leaks(lab, place, make_square(place, 2 * side, side), 0.99, random);
    }
    lab.expect_at_most(std::string("leaks of squares of 4...65536, ") + place.name, 0.0, static_cast<double>(leaks));
    leaks = 0;
    for (uint32_t count = 4; count <= 1024; count *= 4) {
      // The square that fits into a fan of four triangles has corners at (0.5, 0.5).
      leaks += count_surface_leaks(lab, place, make_fan(place, count), 0.49, random);
    }
    lab.expect_at_most(std::string("leaks of fans of 4...1024, ") + place.name, 0.0, static_cast<double>(leaks));
  }
}

Mesh mesh_of(const vec3& a, const vec3& b, const vec3& c) {
  Mesh mesh;
  mesh.positions = {a, b, c};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

/// Rays lie in the plane of a triangle and pass beside it. They must miss for any rounding of the plane.
void cast_edge_on(Lab& lab) {
  Random random(240);
  uint64_t hit_count = 0;
  uint64_t ray_count = 0;
  for (int i = 0; i < 8; ++i) {
    const dvec3 right = random.direction();
    const dvec3 up = random.perpendicular(right);
    const Mesh mesh = mesh_of(vec3(0.1 * up), vec3(right), vec3(0.3 * right + 0.8 * up));
    std::vector<Ray> rays;
    while (rays.size() < some_of(10000)) {
      const double angle = random.uniform(0.0, 2.0 * kPi);
      const dvec3 along = std::cos(angle) * right + std::sin(angle) * up;
      const dvec3 across = std::cos(angle) * up - std::sin(angle) * right;
      // These are the sides of the triangle as the ray sees it.
      double lo = std::numeric_limits<double>::infinity();
      double hi = -lo;
      for (const vec3& p : mesh.positions) {
        lo = std::min(lo, glm::dot(dvec3(p), across));
        hi = std::max(hi, glm::dot(dvec3(p), across));
      }
      const double beside = random.uniform(0.01, 1.0);
      const dvec3 target = across * (random.uniform() < 0.5 ? lo - beside : hi + beside);
      rays.push_back(ray_towards(target - 3.0 * along, target));
    }
    ray_count += rays.size();
    hit_count += count_hits(lab.cast(scene_of({mesh}), rays));
  }
  lab.expect_at_most("hits of rays in the plane beside a triangle", 0.0, static_cast<double>(hit_count));
  Tally tally;
  tally.rays = ray_count;
  Lab::credit("triangle", tally, 0);
}

/// The largest distances of o + t d of the hits from the triangle's plane, and from the box around its corners, in u S.
struct Stray {
  Real off_plane = 0;
  Real off_box = 0;

  void add(const Mesh& mesh, std::span<const Ray> rays, std::span<const Hit> hits) {
    // This form of the maximum keeps NaN.
    const auto raise = [](Real& worst, Real error) { worst = error <= worst ? worst : error; };
    for (size_t i = 0; i < rays.size(); ++i) {
      if (hits[i].object < 0) continue;
      const uvec3& corners = mesh.triangles[static_cast<size_t>(hits[i].primitive)];
      const Vector a(mesh.positions[corners.x]);
      const Vector b(mesh.positions[corners.y]);
      const Vector c(mesh.positions[corners.z]);
      const oracle::Ray ray{Vector(rays[i].origin), Vector(rays[i].direction)};
      const Vector p = ray.origin + Real(hits[i].t) * ray.direction;
      const Vector beyond = glm::max(glm::min(glm::min(a, b), c) - p, p - glm::max(glm::max(a, b), c));
      const Real unit = oracle::kRoundoff * oracle::scale_of(mesh, hits[i].primitive, ray);
      raise(off_plane, std::abs(glm::dot(p - a, glm::normalize(glm::cross(b - a, c - a)))) / unit);
      raise(off_box, std::max({beyond.x, beyond.y, beyond.z}) / unit);
    }
  }

  void expect_little(Lab& lab, const std::string& where) const {
    lab.expect_at_most("|o + t d - plane| / uS, " + where, 8.0 * lab.rounding_factor(), static_cast<double>(off_plane));
    // The bound is a multiple of BK. The correction moves P along the ray, because all code that uses the hit needs a
    // point on the triangle.
    lab.expect_at_most("o + t d outside the triangle's box / uS, " + where, 24.0 * lab.rounding_factor(),
                       static_cast<double>(off_box));
  }
};

/// Rays lie almost in the plane of a triangle and cross the triangle. Rounding may decide whether they hit. If they
/// hit, the hit must be a point of the triangle, from which shadow rays and reflections start.
void cast_across(Lab& lab) {
  Random random(241);
  Tally tally;
  for (const double offset : {0.0, 100.0}) {
    Stray stray;
    for (int i = 0; i < 32; ++i) {
      const Mesh mesh = make_triangle(dvec3(offset) + random.direction(), random);
      const std::vector<Ray> rays =
          repeat_ray(some_of(10000), [&] { return ray_grazing(mesh, mesh.triangles.front(), random); });
      stray.add(mesh, rays, lab.cast(scene_of({mesh}), rays));
      tally.rays += rays.size();
    }
    stray.expect_little(lab, label("grazing, offset", offset));
  }
  // The rays start in the plane of a rotated wall.
  Stray stray;
  for (int i = 0; i < 16; ++i) {
    const dvec3 right = random.direction();
    const dvec3 up = random.perpendicular(right);
    const Mesh mesh = make_square({"wall", dvec3(0.0), right, up}, 1, 1);
    const std::vector<Ray> rays = repeat_ray(some_of(10000), [&] {
      const double angle = random.uniform(-0.35, 0.35);
      const dvec3 along = std::cos(angle) * right + std::sin(angle) * up;
      return ray_towards(-3.0 * right, -3.0 * right + along);
    });
    stray.add(mesh, rays, lab.cast(scene_of({mesh}), rays));
    tally.rays += rays.size();
  }
  stray.expect_little(lab, "in the plane of a wall");
  Lab::credit("triangle", tally);
}

void run_degenerate(Lab& lab) {
  cast_edge_on(lab);
  cast_across(lab);
  Random random(24);
  struct Degenerate {
    const char* name;
    Mesh mesh;
  };
  const vec3 corner(1.25F, -2.5F, 3.75F);
  const std::array cases{
      Degenerate{"a repeated vertex", mesh_of(corner, vec3(0.1F, 0.2F, 0.3F), corner)},
      Degenerate{"one point", mesh_of(corner, corner, corner)},
      Degenerate{"area 0", mesh_of(vec3(0, 1, 2), vec3(1, 2, 3), vec3(4, 5, 6))},
      Degenerate{"area 1e-40, needle", mesh_of(vec3(0.0F), vec3(1, 0, 0), vec3(0, 1e-40F, 0))},
      Degenerate{"area 1e-40, 1e-20 each way", mesh_of(vec3(0.0F), vec3(1e-20F, 0, 0), vec3(0, 1e-20F, 0))},
      // This triangle is from pbrt's test Triangle.BadCases.
      Degenerate{"collinear near -1113.45459",
                 mesh_of(vec3(-1113.45459F, -79.049614F, -56.2431908F), vec3(-1113.45459F, -87.0922699F, -56.2431908F),
                         vec3(-1113.45459F, -79.2090149F, -56.2431908F))},
  };
  for (const Degenerate& each : cases) {
    std::vector<Ray> rays;
    rays.push_back(
        {vec3(-1081.47925F, 99.9999542F, 87.7701111F), 0.0F, vec3(-32.1072998F, -183.355865F, -144.607635F), 0.9999F});
    const auto add = [&](const dvec3& target, const dvec3& direction) {
      rays.push_back(ray_towards(target - direction, target));
    };
    for (int i = 0; i < 2000; ++i) {
      for (const dvec3& target :
           {pick_vertex(each.mesh, random), pick_on_edge(each.mesh, random), pick_inside(each.mesh, random)}) {
        add(target, random.direction());
        add(target, 1e-18 * random.direction());
        for (int axis = 0; axis < 3; ++axis) {
          dvec3 direction(0.0);
          direction[axis] = i % 2 == 0 ? 1.0 : -1.0;
          add(target, direction);
        }
      }
    }
    std::erase_if(rays, [](const Ray& ray) { return !(glm::length(dvec3(ray.direction)) > 0.5); });
    const std::vector<Hit> hits = lab.cast(scene_of({each.mesh}), rays);
    lab.expect_at_most(std::string("hits or not finite, ") + each.name, 0.0, static_cast<double>(count_hits(hits)));
  }
}

constexpr uint32_t kSliverRows = 64;

/// Returns a strip of slivers side by side, with a height of at most 1. A sliver is `aspect` times as long as it is
/// thick. The slivers are needles, whose short sides lie on two lines, or caps, where every other row of vertices is
/// shifted by half a side.
Mesh make_slivers(const Placement& place, double aspect, bool is_cap) {
  const double thickness = std::min(1.0 / aspect, 1.0 / kSliverRows);
  const double length = thickness * aspect;
  Mesh mesh;
  const auto add = [&](double x, double y) {
    mesh.positions.emplace_back(place.at(length * x, y));
    return static_cast<uint32_t>(mesh.positions.size() - 1);
  };
  std::vector<uint32_t> below;
  for (uint32_t row = 0; row <= kSliverRows; ++row) {
    const double y = (row - 0.5 * kSliverRows) * thickness;
    std::vector<uint32_t> here;
    if (!is_cap) {
      here = {add(-0.5, y), add(0.5, y)};
    } else if (row % 2 == 0) {
      here = {add(-1.0, y), add(0.0, y), add(1.0, y)};
    } else {
      here = {add(-1.0, y), add(-0.5, y), add(0.5, y), add(1.0, y)};
    }
    // Triangles join the two rows like a zipper. The next vertex always comes from the row whose next vertex is nearer
    // to the start.
    for (size_t i = 0, j = 0; !below.empty() && (i + 1 < below.size() || j + 1 < here.size());) {
      const bool takes_below = j + 1 == here.size() || (i + 1 < below.size() && i <= j);
      if (takes_below) {
        mesh.triangles.emplace_back(below[i], below[i + 1], here[j]);
        ++i;
      } else {
        mesh.triangles.emplace_back(below[i], here[j + 1], here[j]);
        ++j;
      }
    }
    below = here;
  }
  return mesh;
}

/// Returns |P(u,v) - plane| / uS of the worst hit, with P as the renderer computes it.
double worst_plane_distance(Lab& lab, const world::Scene& scene, const Mesh& mesh, std::span<const Ray> rays) {
  const std::vector<Bounce> bounces = Bouncer(lab.device(), scene).bounce(rays);
  Real worst = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    if (!bounces[i].is_hit) continue;
    const uint32_t triangle = bounces[i].id.primitive;
    const uvec3& corners = mesh.triangles[triangle];
    const Vector a(mesh.positions[corners.x]);
    const Vector b(mesh.positions[corners.y]);
    const Vector c(mesh.positions[corners.z]);
    const Vector normal = glm::normalize(glm::cross(b - a, c - a));
    // The rounding of the lift counts as an error of P.
    const Real error = std::abs(std::abs(glm::dot(Vector(bounces[i].origin) - a, normal)) - bounces[i].lift);
    const oracle::Ray ray{Vector(rays[i].origin), Vector(rays[i].direction)};
    const Real units = error / (oracle::kRoundoff * oracle::scale_of(mesh, static_cast<int32_t>(triangle), ray));
    // This form of the maximum keeps NaN.
    worst = units <= worst ? worst : units;
  }
  return static_cast<double>(worst);
}

void run_slivers(Lab& lab) {
  Random random(25);
  for (const bool is_cap : {false, true}) {
    const std::string kind = is_cap ? "caps" : "needles";
    for (const double aspect : {1.0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
      Tally tally;
      uint64_t leaks = 0;
      double worst = 0.0;
      for (Placement place : placements(random)) {
        // At the origin, the vertices' rounding is small compared with the slivers' thickness.
        place.center = dvec3(0.0);
        const Mesh mesh = make_slivers(place, aspect, is_cap);
        const double inner = 0.4 * kSliverRows * std::min(1.0 / aspect, 1.0 / kSliverRows);
        const auto target = [&](size_t i) {
          for (;;) {
            const dvec3 p = i % 3 == 0   ? pick_on_edge(mesh, random)
                            : i % 3 == 1 ? pick_inside(mesh, random)
                                         : pick_vertex(mesh, random);
            const dvec3 from_center = p - place.center;
            if (std::abs(glm::dot(from_center, place.up)) > inner) continue;
            const double along = std::abs(glm::dot(from_center, place.right)) * std::max(1.0, kSliverRows / aspect);
            if (along < (is_cap ? 0.8 : 0.4)) return p;
            if (i % 3 == 2) i = 0;  // needles have no inner vertices
          }
        };
        std::vector<Ray> rays;
        for (size_t i = 0; i < some_of(4000); ++i) {
          const dvec3 p = target(i);
          const dvec3 away = random.direction();
          if (std::abs(glm::dot(away, place.normal())) > 0.1) rays.push_back(ray_towards(p + 2.0 * away, p));
        }
        const world::Scene scene = scene_of({mesh});
        const std::vector<Hit> hits = lab.cast(scene, rays);
        leaks += count_misses(hits);
        constexpr size_t kJudgedHits = 100;  // the number of rays that are checked by brute force
        tally.add(Lab::judge(scene, std::span(rays).first(kJudgedHits), std::span(hits).first(kJudgedHits)));
        tally.rays += rays.size() - kJudgedHits;
        worst = std::max(worst, worst_plane_distance(lab, scene, mesh, rays));
      }
      const std::string where = ", " + kind + label(" of aspect", aspect);
      lab.expect_at_most("leaks" + where, 0.0, static_cast<double>(leaks));
      lab.expect_at_most("|P(u,v) - plane| / uS" + where, 8.0 * lab.rounding_factor(), worst);
      lab.note("K of t" + where, tally.max_t_error);
      lab.note("margin of other answers / uS" + where, tally.max_margin);
      // K of t is a property of slivers and not of the primitive, so the document has separate lines for it.
      Lab::credit("triangle", tally.without_t_errors(), leaks);
    }
  }
}

void run_coincident(Lab& lab) {
  Random random(26);
  const vec3 a(0.1F, 0.2F, 0.3F);
  const vec3 b(1.3F, 0.1F, 0.7F);
  const vec3 c(0.4F, 1.5F, 0.2F);
  Mesh mesh = mesh_of(a, b, c);
  mesh.triangles.assign(10000, mesh.triangles[0]);
  const world::Scene scene = scene_of({mesh});
  const std::vector<Ray> rays = repeat_ray(1000, [&] {
    const dvec3 away = 3.0 * random.direction();
    const dvec3 target = pick_inside(mesh, random);
    return ray_towards(target + away, target);
  });
  const std::vector<Hit> first = lab.cast(scene, rays);
  const std::vector<Hit> second = lab.cast(scene, rays);
  uint64_t hit_count = 0;
  uint64_t others = 0;
  uint64_t changed = 0;
  for (size_t i = 0; i < rays.size(); ++i) {
    hit_count += first[i].object >= 0 ? 1 : 0;
    others += first[i].object >= 0 && first[i].primitive != 0 ? 1 : 0;
    changed += first[i].primitive != second[i].primitive || first[i].t != second[i].t ? 1 : 0;
  }
  lab.expect_at_most("other than the first of 1e4 coincident triangles", 0.0, static_cast<double>(others));
  lab.expect_at_most("changed from run to run", 0.0, static_cast<double>(changed));
  lab.expect_at_most("missed", 0.0, static_cast<double>(rays.size() - hit_count));
}

void run_unit_triangle(Lab& lab) {
  Random random(27);
  const Mesh mesh = mesh_of(vec3(0.0F), vec3(1, 0, 0), vec3(0, 1, 0));
  for (const bool is_oblique : {false, true}) {
    std::vector<Ray> rays;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        // The target is a point of a lattice that is folded into the triangle.
        dvec3 target((x + 0.25) / 16.0, (y + 0.5) / 16.0, 0.0);
        if (target.x + target.y > 1.0) target = dvec3(1.0 - target.x, 1.0 - target.y, 0.0);
        const dvec3 slant = is_oblique ? dvec3{random.uniform(-1, 1), random.uniform(-1, 1), 0.0} : dvec3(0.0);
        rays.push_back(ray_towards(target + slant + dvec3(0, 0, 1), target));
      }
    }
    const std::vector<Hit> hits = lab.cast(scene_of({mesh}), rays);
    double worst = count_misses(hits) > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    for (size_t i = 0; i < rays.size(); ++i) {
      const Vector o(rays[i].origin);
      const Vector d(rays[i].direction);
      const Real t = -o.z / d.z;
      for (const Real error : {hits[i].t - t, hits[i].u - (o.x + t * d.x), hits[i].v - (o.y + t * d.y)}) {
        worst = std::max(worst, static_cast<double>(std::abs(error)));
      }
    }
    lab.expect_at_most(std::string("error of u, v, t / 2^-23, ") + (is_oblique ? "oblique" : "perpendicular"), 16.0,
                       worst * 0x1p23);
  }
}

constexpr std::array kTriangleCases{HardCase{21, "ClosedMeshFarFromTheOrigin", run_closed_mesh},
                                    HardCase{22, "SpikySphere", run_spikes},
                                    HardCase{23, "SquaresAndFans", run_squares_and_fans},
                                    HardCase{24, "DegenerateTriangles", run_degenerate},
                                    HardCase{25, "Slivers", run_slivers},
                                    HardCase{26, "CoincidentTriangles", run_coincident},
                                    HardCase{27, "UnitTriangle", run_unit_triangle}};

}  // namespace

std::span<const HardCase> triangle_cases() {
  return kTriangleCases;
}

}  // namespace promin::hard
