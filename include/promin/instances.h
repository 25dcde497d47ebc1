// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "promin/export.h"
#include "promin/math.h"
#include "promin/scene.h"

// Objects that share a mesh (docs/instances.md).

namespace promin {

/// The objects that a Renderer or a Caster treats as instances. An instance needs about 150 bytes on the device,
/// because all instances of a mesh share its triangles and its tree. Any other object has triangles of its own. Hits
/// and pictures of both agree within the published bounds, but not in every bit.
enum class Instancing : uint32_t {
  /// Meshes that several objects share, if that saves at least 16384 triangles.
  kAuto,
  /// No object.
  kNone,
  /// All objects with meshes.
  kAll,
};

/// Returns the names of the values of Instancing, in their order: "auto", "none", "all".
PROMIN_EXPORT std::span<const std::string_view> instancing_names();

/// Adds an object for each transform. The new objects have the name, geometry and material of an existing object, and
/// follow all others. Throws InputError if the object does not exist.
PROMIN_EXPORT void add_instances(Scene& scene, uint32_t object, std::span<const dmat4> world_from_object);

}  // namespace promin
