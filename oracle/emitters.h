// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "oracle/oracle.h"
#include "oracle/samples.h"

/// Surfaces that emit light as sources, and the choice of one of many sources (docs/model.md, "Surfaces that emit
/// light"), by sums and bisection.
namespace promin::oracle {

/// A triangle, a rectangle of two triangles, or a part of a shape that emits light, or a light.
struct Emitter {
  /// Index into the scene's objects, and the triangle, of a rectangle the first one; or the light's index if there is
  /// no object.
  int32_t object = -1;
  int32_t primitive = 0;
  /// The part of a shape: a face of a box (x from -1 on, x to 1, y …), or the side, the bottom and the top.
  uint32_t part = 0;
  uint32_t light = 0;
  /// A rectangle has the place at which two sides meet, and the ends of these sides. The sides and the normal are
  /// right-handed.
  std::optional<std::array<Vector, 3>> rectangle = std::nullopt;
  /// Its flux divided by pi.
  Real weight = 0;

  bool is_light() const { return object < 0; }
};

/// A point of an emissive surface as seen from another point.
struct LampPoint {
  Vector place{0};
  /// Unit normal on the front.
  Vector normal{0};
  /// Weights of a triangle's second and third corner.
  Real u = 0;
  Real v = 0;
  /// 1 / density per steradian; 0 if the sample has no point.
  Real inverse_density = 0;
};

class Emitters {
 public:
  /// The scene's lights are all on.
  explicit Emitters(const world::Scene& scene);

  /// Returns the number of sources that choose from a table.
  size_t source_count() const { return tables_.size(); }
  /// Returns whether the lights are elements of the only table, and so no sources of their own.
  bool are_lights_chosen() const { return are_lights_chosen_; }

  struct Choice {
    Emitter emitter;
    Real chance = 0;
    /// The point of the unit square that remains.
    std::array<Real, 2> u{};
  };
  /// Returns the element of a source's table for a pair of dimensions.
  Choice choose(size_t source, const SampleId& id, uint32_t pair) const;

  /// Returns the point of a surface for a point of the unit square, as seen from a position with this geometric normal.
  LampPoint sample(const Emitter& emitter, const Vector& position, const Vector& facing,
                   const std::array<Real, 2>& u) const;

  /// Returns the factor of the radiance of surfaces: lights have the power of Phong's model if there is no other.
  Real radiance_factor() const { return radiance_factor_; }

 private:
  /// The elements of a source, and the first of 2^32 numbers of each; then 2^32.
  struct Table {
    std::vector<Emitter> elements;
    std::vector<Real> begins;
  };
  static Table make_table(std::vector<Emitter> elements);
  /// Replaces the triangles of all objects by rectangles if each is one half of a rectangle whose other half is next.
  void join_rectangles(std::vector<std::vector<Emitter>>& of_objects) const;

  const world::Scene& scene_;
  std::vector<Table> tables_;
  bool are_lights_chosen_ = false;
  Real radiance_factor_ = 1;
};

/// A rectangle, or the ellipse in it.
struct FlatShape {
  Vector center{0};
  /// Unit vectors along the width and the height. They and their product are an orthonormal frame.
  Vector right{0};
  Vector up{0};
  /// Half of the width and of the height.
  std::array<Real, 2> half{};
  bool is_disk = false;
};
/// Returns the point of a flat shape for a point of the unit square, as seen from a position. It is chosen by solid
/// angle if the rectangle has at least the solid angle 1/16, otherwise by area.
LampPoint sample_flat(const FlatShape& shape, const Vector& position, const std::array<Real, 2>& u);

/// Returns the solid angle of a triangle whose corners are at these places, seen from the origin.
Real solid_angle_of(const std::array<Vector, 3>& corners);

}  // namespace promin::oracle
