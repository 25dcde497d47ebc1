// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/random_shapes.h"

#include <cmath>

namespace promin::hard {
namespace {

using measure::Random;

/// Returns a size; small ones are as likely as large ones.
float random_size(Random& random) {
  return static_cast<float>(0.05 * std::pow(40.0, random.uniform()));
}

/// Returns an axis; every third one is an axis of space.
vec3 random_axis(Random& random) {
  const dvec3 axis = random.direction();
  if (random.uniform() > 1.0 / 3.0) return vec3(axis);
  return std::abs(axis.x) > 0.6 ? vec3(1, 0, 0) : std::abs(axis.y) > 0.6 ? vec3(0, -1, 0) : vec3(0, 0, 1);
}

}  // namespace

template <>
world::Sphere random_shape(const vec3& center, Random& random) {
  return {center, random_size(random)};
}

template <>
world::Plane random_shape(const vec3& center, Random& random) {
  return {center, random_axis(random)};
}

template <>
world::Cylinder random_shape(const vec3& center, Random& random) {
  return {center, random_axis(random), random_size(random), random_size(random)};
}

template <>
world::Cone random_shape(const vec3& center, Random& random) {
  const float top = random.uniform() < 0.5 ? 0.0F : random_size(random);
  return {center, random_axis(random), random_size(random), random_size(random), top};
}

template <>
world::Capsule random_shape(const vec3& center, Random& random) {
  const float height = random.uniform() < 0.1 ? 0.0F : random_size(random);
  const float bottom = random_size(random);
  // A radius of 0 is as likely as two equal radii.
  const double kind = random.uniform();
  return {center, random_axis(random), height, bottom, kind < 0.2 ? 0.0F : kind < 0.4 ? bottom : random_size(random)};
}

template <>
world::Box random_shape(const vec3& center, Random& random) {
  const vec3 half_size(random_size(random), random_size(random), random_size(random));
  // The angle may be as large as orientations allow; every third box lies along the axes of space.
  const double sine = random.uniform() < 1.0 / 3.0 ? 0.0 : random.uniform(0.0, 0.52);
  return {center, half_size, vec3(sine * random.direction())};
}

}  // namespace promin::hard
