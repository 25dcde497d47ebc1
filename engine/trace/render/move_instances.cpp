// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "trace/render/move_instances.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "device_scene/pack_instances.h"
#include "promin/error.h"
#include "scene/choose_instances.h"
#include "scene/limits.h"

namespace promin {
namespace {

using Transform = std::pair<uint32_t, dmat4>;

/// Returns the problem of a transform, whatever the size of the mesh; nullopt without one.
std::optional<Problem> find_problem(const Transform& transform, const std::string& where,
                                    const PrimitiveNumbers& numbers) {
  const auto& [object, matrix] = transform;
  const size_t count = numbers.first_order.size() - 1;
  if (object >= count) {
    return Problem{
        "scene.reference.range",
        "the object " + std::to_string(object) + " does not exist, because the scene has only " + std::to_string(count),
        where, "use one that exists"};
  }
  if (std::optional<Problem> problem = find_transform_problem(matrix)) {
    problem->where = where;
    return problem;
  }
  if (numbers.mesh_of_object.empty() || numbers.mesh_of_object[object] == PrimitiveNumbers::kNoMesh) {
    return Problem{
        "scene.move.copied",
        "object " + std::to_string(object) + " is not an instance, so its triangles cannot move without a new tree",
        where, "create a renderer or caster of the moved scene, or one that draws all objects as instances",
        Setting::kInstances};
  }
  if (!is_fit_for_instance(matrix)) {
    return Problem{"scene.move.sheared", "the transform shears or scales an instance too strongly", where,
                   "create a renderer or caster of the moved scene"};
  }
  return std::nullopt;
}

/// Returns the problem of a transform of an instance that moves its mesh too far; nullopt if it does not.
std::optional<Problem> find_far_mesh(const Transform& transform, const std::string& where, const UpperLevel& level) {
  const Bounds box = level.mesh_box(transform.first);
  if (box.is_empty() || is_in_range(box, transform.second)) return std::nullopt;
  return Problem{"scene.position.far", "the mesh extends beyond 1e15 in the world", where,
                 "use a smaller translation or scale"};
}

/// Throws InputError with all problems that `find` returns for a transform and its name.
template <typename Find>
void refuse_problems(std::span<const Transform> transforms, const Find& find) {
  std::vector<Problem> problems;
  for (size_t i = 0; i < transforms.size(); ++i) {
    std::optional<Problem> problem = find(transforms[i], "transforms[" + std::to_string(i) + "]");
    if (problem) problems.push_back(std::move(*problem));
  }
  if (!problems.empty()) throw InputError(problems);
}

/// Returns the transforms sorted by object. Only the last one of each object remains.
std::vector<Transform> sort_by_object(std::span<const Transform> transforms) {
  std::vector<Transform> sorted(transforms.rbegin(), transforms.rend());
  std::ranges::stable_sort(sorted, {}, &Transform::first);
  const auto repeated = std::ranges::unique(sorted, {}, &Transform::first);
  sorted.erase(repeated.begin(), repeated.end());
  return sorted;
}

/// Returns a copy of an upper level that has the data of its instances.
std::shared_ptr<UpperLevel> copy_level(const UpperLevel& level, const PrimitiveNumbers& numbers,
                                       const DeviceScene& scene) {
  auto copy = std::make_shared<UpperLevel>(level);
  if (copy->is_forgotten()) copy->restore(scene.read_records(), numbers.first_order);
  return copy;
}

}  // namespace

void check_same_scene(const Scene& posed, size_t objects, size_t materials) {
  const auto check = [](const char* what, size_t given, size_t wanted) {
    if (given == wanted) return;
    throw InputError({"scene.pose.other",
                      "the scene has " + std::to_string(given) + " " + what + ", but that of the constructor has " +
                          std::to_string(wanted),
                      "set_pose", "give the same scene in another pose, as scene_at() returns it"});
  };
  check("objects", posed.objects.size(), objects);
  check("materials", posed.materials.size(), materials);
}

bool move_to_pose(const world::Scene& posed, bool may_move, std::optional<uint64_t>& hash,
                  const PrimitiveNumbers& numbers, std::shared_ptr<const UpperLevel>& level, DeviceScene& scene,
                  const ShadingParts& shading) {
  const std::optional<uint64_t> before = std::exchange(hash, hash_instanced(posed));
  if (!may_move || level == nullptr || before != hash) return false;
  std::shared_ptr<UpperLevel> moved = copy_level(*level, numbers, scene);
  moved->move(posed.instances);
  scene.set_upper_level(*moved, moved->build(), &shading);
  level = std::move(moved);
  return true;
}

void move_instances(std::span<const Transform> world_from_object, const PrimitiveNumbers& numbers,
                    std::shared_ptr<const UpperLevel>& level, DeviceScene& scene) {
  if (world_from_object.empty()) return;
  refuse_problems(world_from_object, [&](const Transform& transform, const std::string& where) {
    return find_problem(transform, where, numbers);
  });
  std::shared_ptr<UpperLevel> moved = copy_level(*level, numbers, scene);
  refuse_problems(world_from_object, [&](const Transform& transform, const std::string& where) {
    return find_far_mesh(transform, where, *moved);
  });
  const std::vector<Transform> sorted = sort_by_object(world_from_object);
  moved->move(sorted);
  std::shared_ptr<const GlassSolids> solids = GlassSolids::moved(scene.constants().glass_solids, sorted);
  scene.set_upper_level(*moved, moved->build());
  scene.set_glass_solids(std::move(solids));
  level = std::move(moved);
}

}  // namespace promin
