// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/clip_triangle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/rounding.h"

namespace promin {
namespace {

using Real = long double;
using Vector = glm::vec<3, Real>;
using Triangle = std::array<vec3, 3>;

/// Finds the bounds of the part of a triangle in a window. It lists all points that can be a corner of that part: the
/// triangle's corners, the points of its sides on the window's planes, and the points of the window's edges in the
/// triangle's plane.
struct Corners {
  Vector lo{std::numeric_limits<Real>::infinity()};
  Vector hi{-lo};

  Corners(const Triangle& triangle, const Bounds& window) : window_(window) {
    for (int i = 0; i < 3; ++i) {
      const Vector a(triangle[i]);
      const Vector side = Vector(triangle[(i + 1) % 3]) - a;
      add(a, -1);
      for (int axis = 0; axis < 3; ++axis) {
        for (const Real plane : {Real(window.lo[axis]), Real(window.hi[axis])}) {
          const Real s = (plane - a[axis]) / side[axis];
          if (s >= 0 && s <= 1) add(a + s * side, axis);
        }
      }
    }
    for (int axis = 0; axis < 3; ++axis) add_edges(triangle, axis);
  }
  bool is_empty() const { return lo.x > hi.x; }

 private:
  /// Adds the points on the window's four edges that are parallel to an axis.
  void add_edges(const Triangle& triangle, int axis) {
    const int i = (axis + 1) % 3;
    const int j = (axis + 2) % 3;
    const auto area = [&](const Vector& p, const Vector& q, const Vector& r) {
      return (q[i] - p[i]) * (r[j] - p[j]) - (q[j] - p[j]) * (r[i] - p[i]);
    };
    const Vector a(triangle[0]);
    const Vector b(triangle[1]);
    const Vector c(triangle[2]);
    const Real whole = area(a, b, c);
    for (int edge = 0; edge < 4; ++edge) {
      Vector p(0);
      p[i] = edge % 2 == 0 ? window_.lo[i] : window_.hi[i];
      p[j] = edge < 2 ? window_.lo[j] : window_.hi[j];
      const Real u = area(p, b, c) / whole;
      const Real v = area(a, p, c) / whole;
      const Real w = area(a, b, p) / whole;
      if (!(u >= 0 && v >= 0 && w >= 0)) continue;
      p[axis] = u * a[axis] + v * b[axis] + w * c[axis];
      if (p[axis] >= window_.lo[axis] && p[axis] <= window_.hi[axis]) extend(p);
    }
  }
  /// Adds a point if it is inside. `on_plane` is an axis along which the point counts as inside, regardless of
  /// rounding.
  void add(const Vector& p, int on_plane) {
    for (int axis = 0; axis < 3; ++axis) {
      if (axis != on_plane && !(p[axis] >= window_.lo[axis] && p[axis] <= window_.hi[axis])) return;
    }
    extend(p);
  }
  void extend(const Vector& p) {
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }

  const Bounds& window_;
};

struct Kind {
  const char* name;
  double scale;
  double offset;
  /// The width divided by the length.
  double thickness;
};

class ClipTriangle : public testing::TestWithParam<Kind> {
 protected:
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random_()) * 0x1p-32; }
  dvec3 random_point() {
    const double x = uniform(-1, 1);
    const double y = uniform(-1, 1);
    return {x, y, uniform(-1, 1)};
  }
  vec3 place(const dvec3& p) const { return vec3(GetParam().scale * (p + GetParam().offset)); }

  /// Every eighth triangle lies in a plane perpendicular to an axis.
  Triangle random_triangle() {
    const dvec3 a = random_point();
    const dvec3 b = random_point();
    const dvec3 c = glm::mix(a, b, uniform(0, 1)) + GetParam().thickness * random_point();
    Triangle triangle{place(a), place(b), place(c)};
    if (random_() % 8 == 0) {
      const auto axis = static_cast<int>(random_() % 3);
      triangle[1][axis] = triangle[2][axis] = triangle[0][axis];
    }
    return triangle;
  }
  /// Returns a window of any size; some contain the whole triangle, some have a side through a corner of it.
  Bounds random_window(const Triangle& triangle) {
    const dvec3 center = random_point();
    const double size = std::pow(10.0, uniform(-4, 0.5));
    Bounds window{place(center - size), place(center + size)};
    for (int axis = 0; axis < 3; ++axis) {
      if (random_() % 8 == 0) window.lo[axis] = std::min(triangle[random_() % 3][axis], window.hi[axis]);
      if (random_() % 8 == 0) window.hi[axis] = std::max(triangle[random_() % 3][axis], window.lo[axis]);
    }
    return window;
  }

  std::mt19937 random_{11};
};

TEST_P(ClipTriangle, HoldsThePartInTheWindowAndLittleElse) {
  int met = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Triangle triangle = random_triangle();
    const Bounds window = random_window(triangle);
    const Bounds box = clip_triangle(triangle, window);
    const Corners exact(triangle, window);
    if (exact.is_empty()) continue;
    ++met;
    Real size = 0;
    for (const vec3& corner : triangle) size = std::max(size, Real(max_abs_component(corner)));
    for (int axis = 0; axis < 3; ++axis) {
      // The slack is long double's own rounding; the margin for double's is 2^16 times larger.
      const Real slack = 0x1p-60L * size;
      ASSERT_LE(Real(box.lo[axis]), exact.lo[axis] + slack) << i;
      ASSERT_GE(Real(box.hi[axis]), exact.hi[axis] - slack) << i;
      ASSERT_GE(box.lo[axis], window.lo[axis]) << i;
      ASSERT_LE(box.hi[axis], window.hi[axis]) << i;
    }
  }
  EXPECT_GT(met, 10'000);
}

INSTANTIATE_TEST_SUITE_P(Kinds, ClipTriangle,
                         testing::Values(Kind{"ordinary", 1, 0, 1}, Kind{"slivers", 1, 0, 1e-6},
                                         Kind{"far_away", 1, 1e4, 1}, Kind{"slivers_far_away", 1, 1e4, 1e-3},
                                         Kind{"huge", 1e18, 0, 1}, Kind{"tiny", 1e-18, 0, 1}),
                         [](const auto& kind) { return kind.param.name; });

TEST(ClipTriangleBox, IsTight) {
  // The triangle is cut at x = 1 and y = 0.5. The rest reaches from (1, 0.5) to (3, 0.5) and up to (1, 1.5), with z =
  // x.
  const Triangle triangle{vec3(0, 0, 0), vec3(4, 0, 4), vec3(0, 2, 0)};
  const Bounds box = clip_triangle(triangle, {vec3(1, 0.5F, -9), vec3(9)});
  EXPECT_LE(max_abs_component(box.lo - vec3(1, 0.5F, 1)), 1e-6F);
  EXPECT_LE(max_abs_component(box.hi - vec3(3, 1.5F, 3)), 1e-6F);
  EXPECT_TRUE(clip_triangle(triangle, {vec3(3, 1, -9), vec3(9)}).is_empty()) << "meets the triangle's box alone";
  const Bounds whole = clip_triangle(triangle, {vec3(-9), vec3(9)});
  EXPECT_EQ(whole.lo, vec3(0.0F));
  EXPECT_EQ(whole.hi, vec3(4, 2, 4));
}

}  // namespace
}  // namespace promin
