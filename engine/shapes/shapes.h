// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <initializer_list>
#include <optional>

#include "promin/shapes.h"
#include "shapes/placement.h"

namespace promin {

namespace layout {
struct Primitive;
}

/// A size of a shape in the world, in double.
struct NamedSize {
  const char* name = "";
  double size = 0.0;
  /// True if the size may be 0, as for an apex.
  bool may_be_zero = false;
};

/// The sizes of a shape, at most three. It allocates no heap memory, because sizes are computed for every shape of a
/// scene.
class NamedSizes {
 public:
  NamedSizes(std::initializer_list<NamedSize> sizes) : count_(sizes.size()) {
    std::copy(sizes.begin(), sizes.end(), sizes_.begin());
  }

  const NamedSize* begin() const { return sizes_.data(); }
  const NamedSize* end() const { return begin() + count_; }
  const NamedSize& front() const { return sizes_.front(); }
  const NamedSize& operator[](size_t i) const { return sizes_.at(i); }

 private:
  std::array<NamedSize, 3> sizes_;
  size_t count_;
};

/// Converts a device record back to a shape. Each shape has a specialisation in its own file.
template <class Shape>
Shape unpack(const layout::Primitive& primitive);

// Each shape of promin/kinds/primitives.def defines these functions in engine/shapes/<shape>.cpp:
//   place      returns the shape in the world; nullopt if the transform does not keep its form
//   sizes_of   returns the sizes of the placed shape
//   center_of  returns the center of the placed shape, in double
//   pack       writes the shape's numbers to a device record; the caller sets order, kind and hashes
//   unpack     reads the same numbers back
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME)               \
  std::optional<world::TYPE> place(const TYPE& shape, const Placement& placement); \
  NamedSizes sizes_of(const TYPE& shape, const Placement& placement);              \
  dvec3 center_of(const TYPE& shape, const Placement& placement);                  \
  layout::Primitive pack(const world::TYPE& shape);                                \
  template <>                                                                      \
  world::TYPE unpack(const layout::Primitive& primitive);
#include "promin/kinds/primitives.def"

// Returns conservative fp32 bounds of each bounded shape, tight up to rounding.
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) Bounds bounds_of(const world::TYPE& shape);
#include "promin/kinds/primitives.def"

// Returns the point of each bounded shape that lies farthest in a direction of any length except 0.
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  dvec3 farthest_of(const world::TYPE& shape, const dvec3& direction);
#include "promin/kinds/primitives.def"

/// The number KIND_* of a shape.
template <class Shape>
struct KindOf;
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  template <>                                                        \
  struct KindOf<world::TYPE> {                                       \
    static constexpr uint32_t value = NUMBER;                        \
  };
#include "promin/kinds/primitives.def"

/// Returns a box rounded outward. Axes in fp32 are unit vectors only up to rounding, so a shape's true extent may
/// exceed the computed one by a few roundings. The function adds 2 ulp of the largest magnitude involved.
Bounds round_outward(const dvec3& lo, const dvec3& hi, const dvec3& magnitude);

/// Returns the bounds of the convex hull of two disks around an axis, at the distance half_height on both sides of the
/// center. The axis may have any length except 0.
Bounds bounds_of_disks(const vec3& center, const vec3& axis, double half_height, double radius_bottom,
                       double radius_top);
/// Returns the point of the convex hull of the two disks that lies farthest in a direction.
dvec3 farthest_of_disks(const vec3& center, const vec3& axis, double half_height, double radius_bottom,
                        double radius_top, const dvec3& direction);

}  // namespace promin
