// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/far_scene.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "core/parallel.h"
#include "scene/framing.h"
#include "scene/placed_bounds.h"
#include "shapes/placement.h"

namespace promin {
namespace {

double greatest_of(const dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

/// Returns the distance from a finite number to the next larger one in fp32.
double step_at(double magnitude) {
  const auto rounded = static_cast<float>(magnitude);
  return static_cast<double>(std::nextafter(rounded, std::numeric_limits<float>::infinity())) - double{rounded};
}

double greatest_magnitude(const Bounds& bounds, const dvec3& moved_by = dvec3(0.0)) {
  return greatest_of(glm::max(glm::abs(dvec3(bounds.lo) + moved_by), glm::abs(dvec3(bounds.hi) + moved_by)));
}

double size_of(const Bounds& bounds) {
  return greatest_of(dvec3(bounds.hi) - dvec3(bounds.lo));
}

std::vector<Bounds> bounds_of_meshes(const Scene& scene) {
  std::vector<Bounds> all(scene.geometries.size());
  for (size_t i = 0; i < all.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[i]);
    if (mesh == nullptr) continue;
    for (const vec3& position : mesh->positions) all[i].extend(position);
  }
  return all;
}

/// Returns the largest scale of a transform's axes.
double scale_of(const dmat4& transform) {
  return greatest_of(
      {glm::length(dvec3(transform[0])), glm::length(dvec3(transform[1])), glm::length(dvec3(transform[2]))});
}

Bounds bounds_of_object(const Scene& scene, const Object& object, const std::vector<Bounds>& of_meshes) {
  if (object.geometry == Object::kNoGeometry) return {};
  const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
  if (mesh == nullptr) return bounds_of(scene, object);
  if (Placement(object.world_from_object).is_identity()) return of_meshes[object.geometry];
  Bounds bounds;
  for (const vec3& p : mesh->positions) bounds.extend(vec3(object.world_from_object * dvec4(p, 1.0)));
  return bounds;
}

/// Returns hierarchies over the positions of meshes that many objects show.
std::map<uint32_t, PlacedBounds> find_shared(const Scene& scene) {
  constexpr uint32_t kLeastSharers = 3;
  std::vector<uint32_t> users(scene.geometries.size(), 0);
  for (const Object& object : scene.objects) {
    if (object.geometry != Object::kNoGeometry) ++users[object.geometry];
  }
  std::map<uint32_t, PlacedBounds> shared;
  for (uint32_t i = 0; i < users.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[i]);
    if (mesh != nullptr && users[i] >= kLeastSharers) shared.try_emplace(i, mesh->positions, users[i]);
  }
  return shared;
}

/// Returns the number as text with two digits.
std::string to_text(double number) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof text, number, std::chars_format::general, 2);
  return {text, end.ptr};
}

}  // namespace

VertexBounds bounds_of_vertices(const Scene& scene) {
  VertexBounds bounds{.of_meshes = bounds_of_meshes(scene), .of_objects = {}, .all = {}};
  const std::map<uint32_t, PlacedBounds> shared = find_shared(scene);
  constexpr size_t kObjects = 256;
  bounds.of_objects.resize(scene.objects.size());
  for_each_chunk(scene.objects.size(), kObjects, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Object& object = scene.objects[i];
      const auto found = shared.find(object.geometry);
      bounds.of_objects[i] = found != shared.end() ? found->second.of(object.world_from_object)
                                                   : bounds_of_object(scene, object, bounds.of_meshes);
    }
  });
  for (const Bounds& box : bounds.of_objects) bounds.all.extend(box);
  return bounds;
}

bool is_too_coarse(const Bounds& bounds) {
  if (bounds.is_empty()) return false;
  const double magnitude = greatest_magnitude(bounds);
  return magnitude > 0.0 && step_at(magnitude) > kCoarsestStep * size_of(bounds);
}

dvec3 round_middle(const Bounds& bounds) {
  const dvec3 middle = 0.5 * dvec3(bounds.lo) + 0.5 * dvec3(bounds.hi);
  const double size = size_of(bounds);
  if (size == 0.0) return middle;
  const double step = std::exp2(std::floor(std::log2(size)) - 2.0);
  // The addition of 0 turns -0 into 0.
  return glm::round(middle / step) * step + 0.0;
}

void warn_of_coarse_coordinates(const VertexBounds& bounds, bool is_rounded, Scene& scene) {
  if (bounds.all.is_empty()) return;
  const double size = size_of(bounds.all);
  double step = 0.0;
  for (const Object& object : scene.objects) {
    if (object.geometry == Object::kNoGeometry || bounds.of_meshes[object.geometry].is_empty()) continue;
    const double magnitude =
        greatest_magnitude(bounds.of_meshes[object.geometry], is_rounded ? scene.center : dvec3(0.0));
    step = std::max(step, step_at(magnitude) * scale_of(object.world_from_object));
  }
  if (!(step > kCoarsestStep * size)) return;
  scene.warnings.push_back(
      "the file has coordinates in fp32, whose steps of " + to_text(step) + " are coarse for a scene of size " +
      to_text(size) + ": export the scene nearer to the origin and move it by a node's translation, or export doubles");
}

}  // namespace promin
