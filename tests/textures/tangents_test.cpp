// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/tangents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/stopwatch.h"
#include "oracle/tangents.h"

namespace promin {
namespace {

/// Returns a grid of `side` squares on each side, whose vertices `make(s, t)` fills for s and t from 0 to 1.
using MakeVertex = std::function<void(double s, double t, vec3& position, vec3& normal, vec4& uv)>;
Mesh make_grid(uint32_t side, const MakeVertex& make) {
  Mesh mesh;
  for (uint32_t j = 0; j <= side; ++j) {
    for (uint32_t i = 0; i <= side; ++i) {
      vec3 position;
      vec3 normal;
      vec4 uv(0.0F);
      make(static_cast<double>(i) / side, static_cast<double>(j) / side, position, normal, uv);
      mesh.positions.push_back(position);
      mesh.normals.push_back(normal);
      mesh.uvs.push_back(uv);
    }
  }
  for (uint32_t j = 0; j < side; ++j) {
    for (uint32_t i = 0; i < side; ++i) {
      const uint32_t a = j * (side + 1) + i;
      mesh.triangles.push_back({a, a + 1, a + side + 2});
      mesh.triangles.push_back({a, a + side + 2, a + side + 1});
    }
  }
  return mesh;
}

/// Returns a square in the plane z = 0, seen from +Z, whose v grows downwards as in images.
Mesh make_plane(uint32_t side) {
  return make_grid(side, [](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.0};
    normal = {0, 0, 1};
    uv = {s, 1.0 - t, 0.0, 0.0};
  });
}

Mesh make_sphere(uint32_t side) {
  return make_grid(side, [](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    const double phi = 2.0 * std::numbers::pi * s;
    const double theta = std::numbers::pi * (0.1 + 0.8 * t);
    position = normal = vec3(dvec3(std::sin(theta) * std::sin(phi), -std::cos(theta), std::sin(theta) * std::cos(phi)));
    uv = {s, 1.0 - t, 0.0, 0.0};
  });
}

const vec4& tangent_at(const Mesh& mesh, size_t triangle, int corner) {
  return mesh.tangents.at(mesh.triangles.at(triangle)[corner]);
}

void expect_close(const vec4& a, const vec4& b, float tolerance) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

/// Expects that the corners of triangles are at the same places.
void expect_same_surface(const Mesh& before, const Mesh& after) {
  ASSERT_EQ(before.triangles.size(), after.triangles.size());
  for (size_t i = 0; i < before.triangles.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t old_vertex = before.triangles[i][corner];
      const uint32_t vertex = after.triangles[i][corner];
      ASSERT_EQ(before.positions[old_vertex], after.positions[vertex]);
      ASSERT_EQ(before.uvs[old_vertex], after.uvs[vertex]);
      if (before.normals.empty()) continue;
      ASSERT_EQ(before.normals[old_vertex], after.normals[vertex]);
    }
  }
  EXPECT_EQ(after.tangents.size(), after.positions.size());
}

TEST(Tangents, OfAPlaneGoAlongU) {
  const Mesh before = make_plane(3);
  Mesh mesh = before;
  add_tangents(mesh, 0);
  EXPECT_EQ(mesh.positions.size(), before.positions.size()) << "nothing is split";
  expect_same_surface(before, mesh);
  for (const vec4& tangent : mesh.tangents) expect_close(tangent, {1, 0, 0, 1}, 1e-6F);
}

TEST(Tangents, OfTheSecondSetAreItsOwn) {
  Mesh mesh = make_plane(1);
  for (vec4& uv : mesh.uvs) uv = {uv.x, uv.y, uv.y, uv.x};
  add_tangents(mesh, 1);
  // u grows downwards, and v to the right. With v upwards this is the opposite handedness.
  for (const vec4& tangent : mesh.tangents) expect_close(tangent, {0, -1, 0, -1}, 1e-6F);
}

TEST(Tangents, OfASphereGoAlongItsCircles) {
  constexpr uint32_t kSide = 64;
  const Mesh before = make_sphere(kSide);
  Mesh mesh = before;
  add_tangents(mesh, 0);
  EXPECT_EQ(mesh.positions.size(), before.positions.size());
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    const vec3& n = mesh.normals[i];
    const vec3 along = glm::normalize(vec3(n.z, 0.0F, -n.x));
    EXPECT_EQ(mesh.tangents[i].w, 1.0F);
    EXPECT_NEAR(glm::dot(vec3(mesh.tangents[i]), n), 0.0F, 1e-6F);
    // At the seam only the squares of one side count, so the direction differs by half a square's angle.
    const size_t column = i % (kSide + 1);
    const bool is_at_seam = column == 0 || column == kSide;
    EXPECT_GT(glm::dot(vec3(mesh.tangents[i]), along), is_at_seam ? 0.998F : 0.99999F) << i;
  }
}

TEST(Tangents, MirroredCoordinatesTurnTheHandAndSplitTheSeam) {
  const Mesh before = make_grid(2, [](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.0};
    normal = {0, 0, 1};
    uv = {std::abs(s - 0.5), 1.0 - t, 0.0, 0.0};
  });
  Mesh mesh = before;
  add_tangents(mesh, 0);
  EXPECT_EQ(mesh.positions.size(), before.positions.size() + 3) << "the vertices of the seam";
  expect_same_surface(before, mesh);
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool is_left = i % 4 < 2;
    for (int corner = 0; corner < 3; ++corner) {
      expect_close(tangent_at(mesh, i, corner), is_left ? vec4(-1, 0, 0, -1) : vec4(1, 0, 0, 1), 1e-6F);
    }
  }
}

/// Returns a rough surface whose coordinates go to and fro, cut along some columns.
Mesh make_wild(uint32_t seed) {
  std::mt19937 random(seed);
  const auto noise = [&] { return static_cast<double>(random() % 1000) / 1000.0 - 0.5; };
  return make_grid(7, [&](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.2 * noise()};
    normal = glm::normalize(vec3(dvec3(noise(), noise(), 1.0)));
    uv = {std::sin(9.0 * s) + 0.1 * noise(), 1.0 - t + 0.1 * noise(), 0.0, 0.0};
  });
}

/// Adds a triangle with a separate vertex for each corner. All three vertices have the same normal.
void add_triangle(Mesh& mesh, const std::array<vec3, 3>& positions, const std::array<vec2, 3>& places,
                  const vec3& normal = vec3(0, 0, 1)) {
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (size_t i = 0; i < 3; ++i) {
    mesh.positions.push_back(positions[i]);
    mesh.normals.push_back(normal);
    mesh.uvs.emplace_back(places[i], -places[i]);
  }
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

/// Returns a mesh with continuous positions. Its coordinates have a seam along one column, and its normals along
/// another.
Mesh make_seams() {
  Mesh mesh;
  for (const int part : {0, 1, 2}) {
    const Mesh plane = make_grid(3, [&](double s, double t, vec3& position, vec3& normal, vec4& uv) {
      position = {part + s, t, s * t};
      normal = part == 2 ? vec3(0, 0.6F, 0.8F) : vec3(0, 0, 1);
      uv = {(part == 0 ? 5.0 : 0.0) + part + s + 0.5 * t, 1.0 - t * t, 0.0, 0.0};
    });
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), plane.positions.begin(), plane.positions.end());
    mesh.normals.insert(mesh.normals.end(), plane.normals.begin(), plane.normals.end());
    mesh.uvs.insert(mesh.uvs.end(), plane.uvs.begin(), plane.uvs.end());
    for (const uvec3& triangle : plane.triangles) mesh.triangles.push_back(triangle + first);
  }
  return mesh;
}

/// Returns a sphere whose first and last rows of squares end in a point. The point has as many coordinates as there are
/// corners, so half of the triangles there are lines.
Mesh make_poles() {
  return make_grid(8, [](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    const bool is_pole = t == 0.0 || t == 1.0;
    const double phi = 2.0 * std::numbers::pi * s;
    const double sine = is_pole ? 0.0 : std::sin(std::numbers::pi * t);
    position = normal = vec3(dvec3(sine * std::sin(phi), -std::cos(std::numbers::pi * t), sine * std::cos(phi)));
    uv = {s, 1.0 - t, 0.0, 0.0};
  });
}

/// Returns a mesh whose coordinates are at a few places, so that those of many triangles are lines and points.
Mesh make_flat_places(uint32_t seed) {
  std::mt19937 random(seed);
  return make_grid(6, [&](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.1 * static_cast<double>(random() % 3)};
    normal = {0, 0, 1};
    uv = {static_cast<float>(random() % 3), static_cast<float>(random() % 2), 0.0F, 0.0F};
  });
}

/// Returns triangles around a vertex, closed or not, on which the orientation of the coordinates alternates.
Mesh make_fan(uint32_t count, bool is_closed, uint32_t seed) {
  std::mt19937 random(seed);
  Mesh mesh;
  mesh.positions.emplace_back(0.0F);
  for (uint32_t i = 0; i <= count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    mesh.positions.emplace_back(dvec3(std::cos(angle), std::sin(angle), 0.3 * (i % 2)));
  }
  for (size_t i = 0; i < mesh.positions.size(); ++i) {
    mesh.normals.push_back(glm::normalize(vec3(0.1F * static_cast<float>(i % 3), 0.0F, 1.0F)));
    mesh.uvs.emplace_back(static_cast<float>(random() % 5), static_cast<float>(random() % 5), 0.0F, 0.0F);
  }
  for (uint32_t i = 1; i <= count; ++i) {
    mesh.triangles.emplace_back(0, i, is_closed && i == count ? 1 : i + 1);
  }
  return mesh;
}

/// Returns triangles that share one edge like the pages of a book, with corners in either order. It tests which of more
/// than two triangles at an edge form pairs.
Mesh make_book(uint32_t pages, uint32_t seed) {
  std::mt19937 random(seed);
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {0, 0, 1}};
  mesh.normals.assign(2, vec3(0, 1, 0));
  mesh.uvs = {{0, 0, 0, 0}, {0, 1, 0, 0}};
  for (uint32_t i = 0; i < pages; ++i) {
    mesh.positions.emplace_back(std::cos(0.7 * i), std::sin(0.7 * i), 0.3 * i);
    mesh.normals.push_back(glm::normalize(vec3(0.3F, 1.0F, 0.2F)));
    mesh.uvs.emplace_back(static_cast<float>(random() % 5) - 2.0F, 0.25F, 0.0F, 0.0F);
    mesh.triangles.push_back(random() % 2 == 0 ? uvec3(0, 1, i + 2) : uvec3(1, 0, i + 2));
  }
  return mesh;
}

/// Returns a strip that is closed with half a twist. Neighbours share their vertices, and at the joint the edge has the
/// same direction in both triangles.
Mesh make_moebius(uint32_t count) {
  Mesh mesh;
  for (uint32_t i = 0; i < count; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / count;
    for (const double side : {-0.3, 0.3}) {
      const double radius = 1.0 + side * std::cos(angle / 2);
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), side * std::sin(angle / 2));
      mesh.normals.push_back(glm::normalize(vec3(dvec3(std::sin(angle), std::cos(angle), 1.0))));
      mesh.uvs.emplace_back(std::sin(angle), side, 0.0F, 0.0F);
    }
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t a = 2 * i;
    const uint32_t c = i + 1 < count ? a + 2 : 1;
    const uint32_t d = i + 1 < count ? a + 3 : 0;
    mesh.triangles.emplace_back(a, c, a + 1);
    mesh.triangles.emplace_back(c, d, a + 1);
  }
  return mesh;
}

/// Returns two pairs of triangles. The first two share an edge, whose coordinates agree only at its ends, and one has
/// the opposite order of corners. The other two have only a vertex in common.
Mesh make_opposite() {
  Mesh mesh;
  const vec3 a(0, 0, 0);
  const vec3 b(1, 0, 0);
  const vec2 at_a(0, 0);
  const vec2 at_b(1, 0);
  add_triangle(mesh, {a, b, vec3(0, 1, 0)}, {at_a, at_b, vec2(0, -1)});
  add_triangle(mesh, {a, b, vec3(0, -1, 0)}, {at_a, at_b, vec2(0.5F, 1)});
  add_triangle(mesh, {b, a, vec3(1, -1, 1)}, {at_b, at_a, vec2(1, 2)});
  add_triangle(mesh, {a, vec3(-1, 1, 0), vec3(-1, 0, 0)}, {at_a, vec2(3, 3), vec2(0, 3)});
  add_triangle(mesh, {a, vec3(-1, -1, 0), vec3(0, -1, 1)}, {at_a, vec2(2, -3), vec2(1, 3)});
  return mesh;
}

/// Returns a mesh of random indices and of numbers with few bits. It contains points, lines, edges of many triangles,
/// duplicate triangles, coordinates without area and directions that cancel.
Mesh make_soup(uint32_t seed) {
  std::mt19937 random(seed);
  const auto small = [&](uint32_t count) { return static_cast<float>(random() % count) - 1.0F; };
  Mesh mesh;
  const uint32_t count = 3 + random() % 8;
  for (uint32_t i = 0; i < count; ++i) {
    mesh.positions.emplace_back(small(3), small(4), small(3));
    if (seed % 2 == 0) mesh.normals.emplace_back(small(3), seed % 4 == 0 ? 0.0F : small(3), 2.0F);
    mesh.uvs.emplace_back(0.25F * small(5), 0.25F * small(3), small(3), small(3));
  }
  const uint32_t triangles = 2 + random() % (2 * count);
  for (uint32_t i = 0; i < triangles; ++i) {
    mesh.triangles.emplace_back(random() % count, random() % count, random() % count);
  }
  return mesh;
}

/// The agreement of tangents with the oracle's.
struct Agreement {
  size_t corners = 0;
  /// The number of corners that have a direction although they belong to no group.
  size_t left = 0;
  /// The number of corners at which directions nearly cancel, so that rounding decides.
  size_t unsure = 0;
  oracle::Real largest = 0;

  Agreement& operator+=(const Agreement& other) {
    corners += other.corners;
    left += other.left;
    unsure += other.unsure;
    largest = std::max(largest, other.largest);
    return *this;
  }
};

/// If the error reaches this angle, the oracle does not decide the result. The product drops sums below 1e-12 of their
/// parts, because rounding in double can turn such sums by this angle.
constexpr oracle::Real kUnsure = 1e-4L;

/// Compares a mesh's tangents with the oracle's, corner by corner.
Agreement expect_tangents_of_oracle(const Mesh& before, uint32_t uv_set) {
  const std::vector<oracle::CornerTangent> wanted = oracle::corner_tangents(before, uv_set);
  const bool has_any = std::ranges::any_of(wanted, [](const auto& corner) { return corner.group >= 0; });
  Mesh mesh = before;
  add_tangents(mesh, uv_set);
  EXPECT_EQ(has_any, !mesh.tangents.empty());
  if (!has_any || mesh.tangents.empty()) return {};
  expect_same_surface(before, mesh);
  const auto of_group = [&](int group) {
    return *std::ranges::find_if(wanted, [&](const auto& corner) { return corner.group == group; });
  };
  Agreement agreement;
  for (size_t c = 0; c < wanted.size(); ++c) {
    const vec4& got = tangent_at(mesh, c / 3, static_cast<int>(c % 3));
    const bool has_none = vec3(got) == vec3(0.0F);
    ++agreement.corners;
    oracle::CornerTangent expected = wanted[c];
    if (expected.group < 0) {
      // The corner belongs to the vertex's first group. It belongs to no group if its triangle takes part and has the
      // opposite handedness at another vertex.
      if (expected.groups_at_vertex.empty()) {
        EXPECT_TRUE(has_none) << "corner " << c;
        continue;
      }
      expected = of_group(expected.groups_at_vertex.front());
      if (!wanted[c].is_degenerate && has_none && got.w != static_cast<float>(expected.hand)) continue;
      ++agreement.left;
    }
    EXPECT_EQ(got.w, static_cast<float>(expected.hand)) << "corner " << c;
    if (expected.error > kUnsure) {
      ++agreement.unsure;
      continue;
    }
    const oracle::Real off = glm::distance(oracle::Vector(vec3(got)), expected.direction);
    EXPECT_LE(off, expected.error) << "corner " << c << ", " << got.x << " " << got.y << " " << got.z << " for "
                                   << expected.direction.x << " " << expected.direction.y << " "
                                   << expected.direction.z;
    agreement.largest = std::max(agreement.largest, off);
  }
  return agreement;
}

void tell(const char* name, const Agreement& agreement) {
  std::printf("%s: %zu corners, %zu left over, %zu unsure, largest angle %.3Lg\n", name, agreement.corners,
              agreement.left, agreement.unsure, agreement.largest);
}

// According to docs/model.md, "Textures", the difference is at most the angle by which rounding to fp32 rotates a unit
// vector, plus the error of double.
TEST(Tangents, OfHardMeshesAreTheOracles) {
  const auto mirrored = make_grid(4, [](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.3 * s * t};
    normal = glm::normalize(vec3(0.1F, 0.2F, 1.0F));
    uv = {std::abs(s - 0.5), t < 0.5 ? t : 1.0 - t, 0.0, 0.0};
  });
  const std::vector<std::pair<const char*, std::vector<Mesh>>> hard = {
      {"mirrored", {mirrored}},
      {"seams", {make_seams()}},
      {"poles", {make_poles(), make_sphere(6)}},
      {"places without area", {make_flat_places(1), make_flat_places(2), make_flat_places(3)}},
      {"fans", {make_fan(3, true, 1), make_fan(7, true, 2), make_fan(24, true, 3), make_fan(24, false, 4)}},
      {"edges of many triangles", {make_book(3, 1), make_book(5, 2), make_book(12, 3)}},
      {"a strip of one side", {make_moebius(3), make_moebius(12)}},
      {"opposite windings", {make_opposite()}},
      {"rough surfaces", {make_wild(0), make_wild(1), make_wild(2)}}};
  for (const auto& [name, meshes] : hard) {
    SCOPED_TRACE(name);
    Agreement agreement;
    for (const Mesh& mesh : meshes) agreement += expect_tangents_of_oracle(mesh, 0);
    tell(name, agreement);
    EXPECT_GT(agreement.corners, 0U);
    EXPECT_EQ(agreement.unsure, 0U);
  }
}

/// A mesh with the tangents of Mikkelsen's program; w is 0 for corners that the program leaves at its initial value.
struct Precedent {
  const char* name;
  /// The position and the coordinates of each corner, all in the plane z = 0.
  std::vector<std::array<vec4, 3>> triangles;
  std::vector<std::array<vec4, 3>> tangents;
};

/// Returns meshes with the tangents of npm's package `mikktspace` 1.1.1, a WebAssembly of Mikkelsen's program, for
/// coordinates (u, 1 - v) and normals +Z. Each mesh ends in a triangle that stands alone, because the program does not
/// sort edges whose lower vertex is the highest of all.
std::vector<Precedent> precedents() {
  const std::array<vec4, 3> alone = {vec4(9, 0, 0, 0), vec4(10, 0, 1, 0), vec4(9, 1, 0, -1)};
  const vec4 left(0.0F);
  const vec4 x(1, 0, 0, 1);
  const std::array<vec4, 3> of_alone = {x, x, x};
  const vec4 down(-0.70710677F, -0.70710677F, 0, 1);
  const vec4 up(0.70710677F, 0.70710677F, 0, 1);
  const vec4 y(0, 1, 0, 1);
  const vec4 flat(0.89442718F, -0.44721359F, 0, -1);
  const vec4 a1(0.92387944F, 0.38268343F, 0, 1);
  const vec4 a2(0.72964251F, -0.68382871F, 0, 1);
  const vec4 b2(0.9008944F, 0.43403858F, 0, 1);
  const vec4 steep(-0.31622776F, -0.94868326F, 0, -1);
  return {
      {"u grows nowhere on a line",
       {{vec4(0, 0, 0, 0), vec4(1, 0, 1, 1), vec4(2, 0, 0, 2)},
        {vec4(2, 0, 0, 2), vec4(1, 0, 1, 1), vec4(1, 1, 0, 0)},
        alone},
       {{left, down, down}, {down, down, down}, of_alone}},
      {"v grows nowhere on a line",
       {{vec4(0, 0, 0, 0), vec4(1, 0, 1, 1), vec4(2, 0, 2, 0)},
        {vec4(2, 0, 2, 0), vec4(1, 0, 1, 1), vec4(1, 1, 3, 2)},
        alone},
       {{left, up, up}, {up, up, up}, of_alone}},
      {"a degenerate triangle between two hands",
       {{vec4(0, 0, 0, 0), vec4(3, 0, 0, 1), vec4(0, 0, 0, 0)},
        {vec4(0, 0, 0, 0), vec4(0, 2, 1, 0), vec4(-2, 0, 0, -1)},
        {vec4(3, 0, 0, 1), vec4(4, 0, 1, 2), vec4(3, 1, 1, 3)},
        alone},
       {{y, flat, y}, {y, y, y}, {flat, flat, flat}, of_alone}},
      {"five triangles at an edge",
       {{vec4(0, 0, 0, 0), vec4(0, 1, 0, 1), vec4(1, 0, 1, 0)},
        {vec4(0, 0, 0, 0), vec4(0, 1, 0, 1), vec4(2, -1, 1, 2)},
        {vec4(0, 1, 0, 1), vec4(0, 0, 0, 0), vec4(-1, 0, -2, 1)},
        {vec4(0, 1, 0, 1), vec4(0, 0, 0, 0), vec4(-1, 2, -1, 3)},
        {vec4(0, 0, 0, 0), vec4(0, 1, 0, 1), vec4(1, 3, 2, 2)},
        alone},
       {{a1, a1, x},
        {a2, b2, vec4(0.5547002F, -0.83205032F, 0, 1)},
        {a1, a1, up},
        {b2, a2, up},
        {up, up, up},
        of_alone}},
      {"coordinates without area between two hands",
       {{vec4(0, 0, 0, 0), vec4(2, 0, 2, 2), vec4(0, 2, 1, 1)},
        {vec4(0, 2, 1, 1), vec4(2, 0, 2, 2), vec4(3, 3, 0, 2)},
        {vec4(2, 0, 2, 2), vec4(0, 0, 0, 0), vec4(1, -2, 0, 3)},
        alone},
       {{left, steep, steep}, {steep, steep, steep}, {up, up, up}, of_alone}},
  };
}

TEST(Tangents, OfMeshesThatAreNoSurfacesAreThoseOfMikkelsensProgram) {
  for (const Precedent& precedent : precedents()) {
    SCOPED_TRACE(precedent.name);
    Mesh mesh;
    for (const std::array<vec4, 3>& corners : precedent.triangles) {
      const auto first = static_cast<uint32_t>(mesh.positions.size());
      for (const vec4& corner : corners) {
        mesh.positions.emplace_back(corner.x, corner.y, 0.0F);
        mesh.normals.emplace_back(0, 0, 1);
        mesh.uvs.emplace_back(corner.z, corner.w, 0.0F, 0.0F);
      }
      mesh.triangles.emplace_back(first, first + 1, first + 2);
    }
    expect_tangents_of_oracle(mesh, 0);
    add_tangents(mesh, 0);
    ASSERT_FALSE(mesh.tangents.empty());
    for (size_t i = 0; i < precedent.tangents.size(); ++i) {
      for (size_t corner = 0; corner < 3; ++corner) {
        SCOPED_TRACE(3 * i + corner);
        const vec4& wanted = precedent.tangents[i][corner];
        if (wanted.w == 0.0F) continue;
        expect_close(tangent_at(mesh, i, static_cast<int>(corner)), wanted, 1e-6F);
      }
    }
  }
}

TEST(Tangents, OfRandomMeshesAreTheOracles) {
  const char* word = std::getenv("PROMIN_TEST_TANGENT_MESHES");
  const auto count = static_cast<uint32_t>(word == nullptr ? 2000 : std::stoul(word));
  Agreement agreement;
  for (uint32_t seed = 0; seed < count && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    agreement += expect_tangents_of_oracle(make_soup(seed), seed / 2 % 2);
  }
  tell("random meshes", agreement);
  EXPECT_GT(agreement.left, agreement.corners / 100);
  EXPECT_LT(agreement.unsure, agreement.corners / 20);
}

TEST(Tangents, DoNotDependOnWhatVerticesAreShared) {
  Mesh welded = make_wild(3);
  Mesh apart;
  for (const uvec3& triangle : welded.triangles) {
    for (int corner = 0; corner < 3; ++corner) {
      apart.positions.push_back(welded.positions[triangle[corner]]);
      apart.normals.push_back(welded.normals[triangle[corner]]);
      apart.uvs.push_back(welded.uvs[triangle[corner]]);
    }
    const auto first = static_cast<uint32_t>(apart.positions.size() - 3);
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  add_tangents(welded, 0);
  add_tangents(apart, 0);
  for (size_t i = 0; i < welded.triangles.size(); ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      EXPECT_EQ(tangent_at(welded, i, corner), tangent_at(apart, i, corner));
    }
  }
}

TEST(Tangents, WithoutNormalsAreOfFlatTriangles) {
  // Two walls form a right angle, and their coordinates continue around the edge.
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 0, -1}, {1, 1, -1}};
  mesh.uvs = {{0, 1, 0, 0}, {1, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}, {2, 1, 0, 0}, {2, 0, 0, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  const Mesh before = mesh;
  add_tangents(mesh, 0);
  expect_same_surface(before, mesh);
  EXPECT_EQ(mesh.positions.size(), 8U) << "the edge is split";
  for (size_t i = 0; i < 4; ++i) {
    for (int corner = 0; corner < 3; ++corner) {
      expect_close(tangent_at(mesh, i, corner), i < 2 ? vec4(1, 0, 0, 1) : vec4(0, 0, -1, 1), 1e-6F);
    }
  }
}

TEST(Tangents, WithoutADirectionAreInherited) {
  Mesh mesh = make_plane(2);
  // The corners of one triangle lie on a line, and the coordinates of another lie on a line. Both use vertices of other
  // triangles.
  mesh.triangles.push_back({0, 0, 1});
  mesh.positions.push_back({-1, 0, 0});
  mesh.normals.push_back({0, 0, 1});
  mesh.uvs.push_back(mesh.uvs[0]);
  mesh.triangles.push_back({9, 0, 3});
  // Another degenerate triangle stands alone.
  for (const float x : {5.0F, 6.0F, 7.0F}) {
    mesh.positions.push_back({x, x * x, 0});
    mesh.normals.push_back({0, 0, 1});
    mesh.uvs.push_back(vec4(0.5F));
  }
  mesh.triangles.push_back({10, 11, 12});
  const Mesh before = mesh;
  add_tangents(mesh, 0);
  expect_same_surface(before, mesh);
  for (size_t i = 0; i < 9; ++i) {
    for (int corner = 0; corner < 3; ++corner) expect_close(tangent_at(mesh, i, corner), {1, 0, 0, 1}, 1e-6F);
  }
  expect_close(tangent_at(mesh, 9, 1), {1, 0, 0, 1}, 1e-6F);
  expect_close(tangent_at(mesh, 9, 2), {1, 0, 0, 1}, 1e-6F);
  for (int corner = 0; corner < 3; ++corner) expect_close(tangent_at(mesh, 10, corner), {0, 0, 0, 1}, 0.0F);
}

TEST(Tangents, OfCoordinatesWithoutAreaAreLeftOut) {
  Mesh mesh = make_plane(2);
  for (vec4& uv : mesh.uvs) uv.y = uv.x;
  add_tangents(mesh, 0);
  EXPECT_TRUE(mesh.tangents.empty());
  Mesh without;
  add_tangents(without, 0);
  EXPECT_TRUE(without.tangents.empty());
}

/// Indices and numbers are random. The meshes contain edges of many triangles, duplicate triangles, points and lines.
TEST(Tangents, OfAnyMeshAreFiniteAndAcrossNormals) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    Mesh mesh;
    const uint32_t count = 3 + random() % 10;
    const auto small = [&] { return static_cast<float>(static_cast<int>(random() % 3)) - 1.0F; };
    const float scale = std::pow(10.0F, static_cast<float>(random() % 31) - 15.0F);
    for (uint32_t i = 0; i < count; ++i) {
      mesh.positions.emplace_back(scale * small(), scale * small(), scale * small());
      if (round % 2 == 0) mesh.normals.emplace_back(small(), small(), 2.0F);
      mesh.uvs.emplace_back(scale * small(), small(), 0.0F, 0.0F);
    }
    for (uint32_t i = 0; i < 2 * count; ++i) {
      mesh.triangles.emplace_back(random() % count, random() % count, random() % count);
    }
    const Mesh before = mesh;
    add_tangents(mesh, 0);
    if (mesh.tangents.empty()) continue;
    expect_same_surface(before, mesh);
    for (size_t i = 0; i < mesh.tangents.size(); ++i) {
      const vec3 tangent(mesh.tangents[i]);
      const float length = glm::length(tangent);
      EXPECT_TRUE(length == 0.0F || std::abs(length - 1.0F) < 1e-6F) << length;
      EXPECT_EQ(std::abs(mesh.tangents[i].w), 1.0F);
      if (!mesh.normals.empty()) {
        EXPECT_NEAR(glm::dot(tangent, glm::normalize(mesh.normals[i])), 0.0F, 1e-5F);
      }
    }
  }
}

TEST(Tangents, ManyTrianglesAtAVertexTakeNoLonger) {
  // These are fans in which neighbouring triangles have different handedness, so the vertex in the middle is split into
  // as many vertices as there are triangles.
  constexpr uint32_t kCount = 200000;
  Mesh mesh;
  mesh.positions.emplace_back(0.0F);
  mesh.uvs.emplace_back(0.0F);
  for (uint32_t i = 0; i <= kCount; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCount;
    mesh.positions.emplace_back(dvec3(std::cos(angle), std::sin(angle), 0.5));
    mesh.uvs.emplace_back(i % 2 == 0 ? 1.0F : 0.0F, i % 4 < 2 ? 1.0F : 0.5F, 0.0F, 0.0F);
  }
  for (uint32_t i = 1; i <= kCount; ++i) mesh.triangles.emplace_back(0, i, i + 1);
  const Mesh before = mesh;
  add_tangents(mesh, 0);
  expect_same_surface(before, mesh);
  EXPECT_GT(mesh.positions.size(), before.positions.size() + kCount / 4);
}

/// The test prints the time but does not limit it.
TEST(Tangents, OfAMillionTriangles) {
  Mesh mesh = make_sphere(708);
  const Stopwatch time;
  add_tangents(mesh, 0);
  RecordProperty("milliseconds", static_cast<int>(time.ms()));
  EXPECT_EQ(mesh.tangents.size(), mesh.positions.size());
}

}  // namespace
}  // namespace promin
