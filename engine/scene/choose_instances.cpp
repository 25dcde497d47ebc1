// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/choose_instances.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <variant>

#include "core/parallel.h"
#include "core/rounding.h"
#include "promin/error.h"
#include "promin/motion.h"

namespace promin {
namespace {

constexpr uint64_t kLeastTriangles = 64;
constexpr uint64_t kLeastSaved = 16384;
/// The largest scale and the smallest inverse of a scale: factors of t stay normal numbers.
constexpr double kMostScale = 0x1p40;
constexpr float kMostOriginRadii = 8.0F;
constexpr size_t kObjectChunk = 1024;

dmat3 absolute(const dmat3& m) {
  return {glm::abs(m[0]), glm::abs(m[1]), glm::abs(m[2])};
}

double frobenius_norm(const dmat3& m) {
  return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
}

/// Returns whether a mesh has triangles and lies near its own origin.
bool lies_near_its_origin(const Mesh& mesh) {
  Bounds bounds;
  for (const uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) bounds.extend(mesh.positions[triangle[i]]);
  }
  if (bounds.is_empty()) return false;
  const dvec3 center = 0.5 * (dvec3(bounds.lo) + dvec3(bounds.hi));
  const double radius = 0.5 * glm::distance(dvec3(bounds.lo), dvec3(bounds.hi));
  return glm::length(center) <= double{kMostOriginRadii} * radius;
}

/// Returns the number of objects that show each geometry at any time.
std::vector<uint64_t> count_users(const Scene& scene) {
  std::vector<uint64_t> users(scene.geometries.size(), 0);
  const size_t linked = scene.motion == nullptr ? 0 : scene.motion->objects.size();
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    uint32_t geometry = scene.objects[i].geometry;
    if (i < linked && scene.motion->objects[i].geometry != kNoIndex) geometry = scene.motion->objects[i].geometry;
    if (geometry < users.size()) ++users[geometry];
  }
  return users;
}

}  // namespace

double skeel_condition(const dmat4& world_from_object) {
  const dmat3 turn(world_from_object);
  const dmat3 product = absolute(turn) * absolute(glm::inverse(turn));
  const dvec3 sums = product[0] + product[1] + product[2];
  return std::max({sums.x, sums.y, sums.z});
}

bool is_fit_for_instance(const dmat4& world_from_object) {
  const dmat3 turn(world_from_object);
  if (!(frobenius_norm(turn) <= kMostScale && frobenius_norm(glm::inverse(turn)) <= kMostScale)) return false;
  return skeel_condition(world_from_object) <= kMostInstanceCondition;
}

std::vector<bool> choose_instances(const Scene& scene, Instancing instancing) {
  if (instancing == Instancing::kNone) return std::vector<bool>(scene.objects.size(), false);
  const std::vector<uint64_t> users = count_users(scene);
  std::vector<bool> is_shared(scene.geometries.size(), false);
  for (size_t i = 0; i < scene.geometries.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[i]);
    if (mesh == nullptr || users[i] == 0) continue;
    const uint64_t triangles = mesh->triangles.size();
    const bool saves = triangles >= kLeastTriangles && (users[i] - 1) * triangles >= kLeastSaved;
    is_shared[i] = (saves || instancing == Instancing::kAll) && lies_near_its_origin(*mesh);
  }
  // Bits of std::vector<bool> cannot be set by several threads.
  std::vector<uint8_t> is_instance(scene.objects.size(), 0);
  for_each_chunk(scene.objects.size(), kObjectChunk, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const Object& object = scene.objects[i];
      if (object.geometry == Object::kNoGeometry || !is_shared[object.geometry]) continue;
      is_instance[i] = is_fit_for_instance(object.world_from_object) ? 1 : 0;
    }
  });
  return {is_instance.begin(), is_instance.end()};
}

std::span<const std::string_view> instancing_names() {
  static constexpr std::array<std::string_view, 3> kNames = {"auto", "none", "all"};
  return kNames;
}

void add_instances(Scene& scene, uint32_t object, std::span<const dmat4> world_from_object) {
  if (object >= scene.objects.size()) {
    throw InputError({"scene.reference.range", "the object does not exist", "objects[" + std::to_string(object) + "]",
                      "use one that exists"});
  }
  scene.objects.reserve(scene.objects.size() + world_from_object.size());
  for (const dmat4& transform : world_from_object) {
    scene.objects.push_back(scene.objects[object]);
    scene.objects.back().world_from_object = transform;
  }
}

}  // namespace promin
