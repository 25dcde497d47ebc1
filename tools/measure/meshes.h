// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/random.h"
#include "scene/world_scene.h"

namespace promin::measure {

/// A scene of these shapes with one material, without camera or light.
world::Scene scene_of(std::vector<world::Shape> shapes, const std::string& name = "shapes");

/// A triangle of its own, of ordinary shape: about `size` across, turned as it comes.
Mesh make_triangle(const dvec3& center, Random& random, double size = 1.0);

// Meshes of any size to measure with, each a scene of one object without camera or light; the same bits every time.

/// A closed surface around the origin with waves on it, of 4 r^2 triangles for the r that comes nearest to the number
/// asked for.
world::Scene make_wavy_sphere(uint32_t triangle_count);

/// Long thin triangles, a fiftieth as wide as long, strewn in a ball at any angle: boxes that overlap and are mostly
/// empty.
world::Scene make_needles(uint32_t triangle_count);

/// What programs take for a scene: a file, or "wavy:N" and "needles:N" for a generated mesh of about N triangles, which
/// has the word for its file. Throws InputError; UsageError for a number that is none.
world::Scene open_scene(const std::string& word);

/// Whether open_scene has generated this scene and every ray from inside of it hits.
bool is_generated_and_closed(const world::Scene& scene);

}  // namespace promin::measure
