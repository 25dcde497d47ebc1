// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "device_scene/pack_scene.h"
#include "promin/caster.h"
#include "scene/world_scene.h"

// Access to the implementation of Caster, for tests and measurements.
namespace promin {

struct TunedCasterOptions : CasterOptions {
  /// SPIR-V of another kernel with the bindings of shaders/cast/cast_bindings.glsl, only for cast(). Empty for promin's
  /// own kernel.
  std::span<const uint32_t> spirv = {};
  /// A BVH file that is shared with other processes (pack_scene_sharing). It is not used if `bvh` names a file.
  std::optional<std::filesystem::path> shared_bvh = std::nullopt;
};

struct CasterAccess {
  /// Makes a Caster like its constructor, for a valid scene in world space.
  static Caster make(const gpu::Device& device, const SceneToPack& scene, const TunedCasterOptions& options);
};

inline Caster make_caster(const gpu::Device& device, const SceneToPack& scene, const TunedCasterOptions& options) {
  return CasterAccess::make(device, scene, options);
}
inline Caster make_caster(const gpu::Device& device, const SceneToPack& scene, const CasterOptions& options = {}) {
  return CasterAccess::make(device, scene, TunedCasterOptions{options, {}});
}

}  // namespace promin
