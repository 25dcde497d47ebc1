// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "bvh/primitive_numbers.h"
#include "device_scene/device_scene.h"
#include "promin/math.h"

namespace promin {

/// Throws InputError if a scene does not have these numbers of objects and of materials, so it is not another pose.
void check_same_scene(const Scene& posed, size_t objects, size_t materials);

/// Gives instances of a scene on a device other transforms: builds the upper level of its tree again and uploads it. If
/// an object occurs several times, its last transform counts. Throws InputError if an object does not exist, is not an
/// instance, or gets a transform that an instance cannot have; throws RunError and vk::SystemError. Then nothing
/// changes.
void move_instances(std::span<const std::pair<uint32_t, dmat4>> world_from_object, const PrimitiveNumbers& numbers,
                    std::shared_ptr<const UpperLevel>& level, DeviceScene& scene);

/// Gives all instances the transforms that they have in another pose of the scene, and replaces its shading, if no
/// other geometry differs and if `may_move`. `hash` is the hash_instanced() of the last pose, if it is known, and
/// becomes that of this pose. Returns false if other geometry differs; then only the hash changes.
bool move_to_pose(const world::Scene& posed, bool may_move, std::optional<uint64_t>& hash,
                  const PrimitiveNumbers& numbers, std::shared_ptr<const UpperLevel>& level, DeviceScene& scene,
                  const ShadingParts& shading);

}  // namespace promin
