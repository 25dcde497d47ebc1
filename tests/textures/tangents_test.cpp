// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "textures/tangents.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "core/stopwatch.h"

namespace promin {
namespace {

/// A grid of `side` squares a side, whose vertices `make(s, t)` fills for s and t from 0 to 1.
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

/// A square in the plane z = 0, seen from +Z, with v growing downwards as images do.
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

void expect_near(const vec4& a, const vec4& b, float tolerance) {
  for (int i = 0; i < 4; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

/// Whether the corners of triangles are where they were.
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
  for (const vec4& tangent : mesh.tangents) expect_near(tangent, {1, 0, 0, 1}, 1e-6F);
}

TEST(Tangents, OfTheSecondSetAreItsOwn) {
  Mesh mesh = make_plane(1);
  for (vec4& uv : mesh.uvs) uv = {uv.x, uv.y, uv.y, uv.x};
  add_tangents(mesh, 1);
  // u grows downwards, and v to the right: with v upwards that is another hand.
  for (const vec4& tangent : mesh.tangents) expect_near(tangent, {0, -1, 0, -1}, 1e-6F);
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
    // Along the seam the squares of one side alone count, half a square's angle off.
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
      expect_near(tangent_at(mesh, i, corner), is_left ? vec4(-1, 0, 0, -1) : vec4(1, 0, 0, 1), 1e-6F);
    }
  }
}

/// Each corner's tangent as the paper defines it, in quadratic time: of triangles that have a hand and points of
/// their own, with at most two triangles at an edge.
std::vector<vec4> make_reference(const Mesh& mesh) {
  using Real = long double;
  using Vector = glm::vec<3, Real>;
  const auto vertex = [&](size_t c) { return mesh.triangles[c / 3][static_cast<int>(c % 3)]; };
  const auto point = [&](size_t c) { return Vector(mesh.positions[vertex(c)]); };
  const auto is_one = [&](size_t a, size_t b) {
    return mesh.positions[vertex(a)] == mesh.positions[vertex(b)] &&
           mesh.normals[vertex(a)] == mesh.normals[vertex(b)] && vec2(mesh.uvs[vertex(a)]) == vec2(mesh.uvs[vertex(b)]);
  };
  const size_t count = 3 * mesh.triangles.size();
  std::vector<Vector> weighted(count);
  std::vector<float> hands(count);
  for (size_t c = 0; c < count; ++c) {
    const size_t first = c / 3 * 3;
    const auto uv = [&](size_t k) {
      return glm::vec<2, Real>(mesh.uvs[vertex(first + k)].x, 1 - Real(mesh.uvs[vertex(first + k)].y));
    };
    const auto d1 = uv(1) - uv(0);
    const auto d2 = uv(2) - uv(0);
    hands[c] = d1.x * d2.y > d1.y * d2.x ? 1.0F : -1.0F;
    const Vector n = glm::normalize(Vector(mesh.normals[vertex(c)]));
    const auto across = [&](const Vector& v) { return glm::normalize(v - glm::dot(v, n) * n); };
    const Vector t =
        Real(hands[c]) * (d2.y * (point(first + 1) - point(first)) - d1.y * (point(first + 2) - point(first)));
    const size_t next = first + (c + 1 - first) % 3;
    const size_t last = first + (c + 2 - first) % 3;
    const Real cosine = glm::dot(across(point(next) - point(c)), across(point(last) - point(c)));
    weighted[c] = std::acos(std::clamp(cosine, Real(-1), Real(1))) * across(t);
  }
  // Corners are in one group that a common edge brings together, over and over.
  std::vector<size_t> group(count);
  for (size_t c = 0; c < count; ++c) group[c] = c;
  for (bool has_changed = true; has_changed;) {
    has_changed = false;
    for (size_t a = 0; a < count; ++a) {
      for (size_t b = 0; b < count; ++b) {
        if (a / 3 == b / 3 || !is_one(a, b) || hands[a] != hands[b] || group[a] <= group[b]) continue;
        const auto other = [](size_t c, size_t k) { return c / 3 * 3 + (c + k) % 3; };
        const bool shares_edge = is_one(other(a, 1), other(b, 2)) || is_one(other(a, 2), other(b, 1));
        if (!shares_edge) continue;
        group[a] = group[b];
        has_changed = true;
      }
    }
  }
  std::vector<vec4> tangents(count);
  for (size_t c = 0; c < count; ++c) {
    Vector sum(0);
    for (size_t k = 0; k < count; ++k) {
      if (group[k] == group[c]) sum += weighted[k];
    }
    tangents[c] = vec4(vec3(glm::normalize(sum)), hands[c]);
  }
  return tangents;
}

/// A rough surface with coordinates that run to and fro, cut along some columns.
Mesh make_wild(uint32_t seed) {
  std::mt19937 random(seed);
  const auto noise = [&] { return static_cast<double>(random() % 1000) / 1000.0 - 0.5; };
  return make_grid(7, [&](double s, double t, vec3& position, vec3& normal, vec4& uv) {
    position = {s, t, 0.2 * noise()};
    normal = glm::normalize(vec3(dvec3(noise(), noise(), 1.0)));
    uv = {std::sin(9.0 * s) + 0.1 * noise(), 1.0 - t + 0.1 * noise(), 0.0, 0.0};
  });
}

TEST(Tangents, AreThoseOfTheDefinition) {
  for (uint32_t seed = 0; seed < 10; ++seed) {
    const Mesh before = make_wild(seed);
    const std::vector<vec4> wanted = make_reference(before);
    Mesh mesh = before;
    add_tangents(mesh, 0);
    EXPECT_GT(mesh.positions.size(), before.positions.size()) << "some are split";
    expect_same_surface(before, mesh);
    for (size_t c = 0; c < wanted.size(); ++c) {
      expect_near(tangent_at(mesh, c / 3, static_cast<int>(c % 3)), wanted[c], 1e-5F);
    }
  }
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
  // Two walls that meet at a right angle, with coordinates that go on around the edge.
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
      expect_near(tangent_at(mesh, i, corner), i < 2 ? vec4(1, 0, 0, 1) : vec4(0, 0, -1, 1), 1e-6F);
    }
  }
}

TEST(Tangents, WithoutADirectionAreInherited) {
  Mesh mesh = make_plane(2);
  // A triangle that is a line, and one whose coordinates are, on vertices that others have.
  mesh.triangles.push_back({0, 0, 1});
  mesh.positions.push_back({-1, 0, 0});
  mesh.normals.push_back({0, 0, 1});
  mesh.uvs.push_back(mesh.uvs[0]);
  mesh.triangles.push_back({9, 0, 3});
  // And one that stands alone.
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
    for (int corner = 0; corner < 3; ++corner) expect_near(tangent_at(mesh, i, corner), {1, 0, 0, 1}, 1e-6F);
  }
  expect_near(tangent_at(mesh, 9, 1), {1, 0, 0, 1}, 1e-6F);
  expect_near(tangent_at(mesh, 9, 2), {1, 0, 0, 1}, 1e-6F);
  for (int corner = 0; corner < 3; ++corner) expect_near(tangent_at(mesh, 10, corner), {0, 0, 0, 1}, 0.0F);
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

/// Random indices and numbers: edges of many triangles, triangles twice, points and lines among them.
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
  // Fans whose triangles each have a hand of their own: the vertex in the middle is split that often.
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

/// Not a limit of the test's, only told.
TEST(Tangents, OfAMillionTriangles) {
  Mesh mesh = make_sphere(708);
  const Stopwatch time;
  add_tangents(mesh, 0);
  RecordProperty("milliseconds", static_cast<int>(time.ms()));
  EXPECT_EQ(mesh.tangents.size(), mesh.positions.size());
}

}  // namespace
}  // namespace promin
