// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "measure/random.h"
#include "scene/world_scene.h"

namespace promin::hard {

/// Returns a shape around `center` of size 0.05 to 2, with any proportions and orientation. Each shape of
/// promin/kinds/primitives.def needs its own definition; without it the suite over all shapes does not link.
template <class Shape>
Shape random_shape(const vec3& center, measure::Random& random);

#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  template <>                                                        \
  world::TYPE random_shape(const vec3& center, measure::Random& random);
#include "promin/kinds/primitives.def"

/// Calls the visitor with one of each shape that lies in the tree.
template <class Visitor>
void for_each_solid(const vec3& center, measure::Random& random, const Visitor& visit) {
#define PROMIN_SOLID(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) visit(random_shape<world::TYPE>(center, random));
#include "promin/kinds/primitives.def"
}

}  // namespace promin::hard
