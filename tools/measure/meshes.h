// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/random.h"
#include "scene/world_scene.h"

namespace promin::measure {

/// Returns a scene of these shapes with one material, without camera or light.
world::Scene scene_of(std::vector<world::Shape> shapes, const std::string& name = "shapes");

/// Returns a mesh of one random, well-shaped triangle. Its size is about `size`, and its direction is random.
Mesh make_triangle(const dvec3& center, Random& random, double size = 1.0);

// The next functions make meshes of any size to measure with. Each returns a scene of one object without camera or
// light, with the same bits every time.

/// Returns a closed surface around the origin with waves on it. It has 4 r^2 triangles. The function chooses r so that
/// this number is nearest to the requested number.
world::Scene make_wavy_sphere(uint32_t triangle_count);

/// Returns long thin triangles at random angles that fill a ball. Their width is a fiftieth of their length. Their
/// boxes overlap and are mostly empty.
world::Scene make_needles(uint32_t triangle_count);

/// Opens a scene that a program's argument names: a file, or "wavy:N" and "needles:N" for a generated mesh of about N
/// triangles. The generated scene's file name is the word. Throws InputError, and UsageError if N is not a number.
world::Scene open_scene(const std::string& word);

/// Returns whether open_scene() has generated this scene and every ray from inside it hits.
bool is_generated_and_closed(const world::Scene& scene);

}  // namespace promin::measure
