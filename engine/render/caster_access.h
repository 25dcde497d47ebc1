// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "promin/caster.h"
#include "scene/world_scene.h"

// Access to what is behind Caster, for tests and measurements.
namespace promin {

struct TunedCasterOptions : CasterOptions {
  /// SPIR-V of another kernel with the bindings of shaders/cast_bindings.glsl, for cast() alone; empty for promin's
  /// own.
  std::span<const uint32_t> spirv = {};
  /// A BVH file that is to be had in common with others (pack_scene_sharing). Unless `bvh` names one to take.
  std::optional<std::filesystem::path> shared_bvh = std::nullopt;
};

struct CasterAccess {
  /// Does what Caster's constructor does, for a scene that is in the world already and is valid.
  static Caster make(const gpu::Device& device, const world::Scene& scene, const TunedCasterOptions& options);
};

inline Caster make_caster(const gpu::Device& device, const world::Scene& scene, const TunedCasterOptions& options) {
  return CasterAccess::make(device, scene, options);
}
inline Caster make_caster(const gpu::Device& device, const world::Scene& scene, const CasterOptions& options = {}) {
  return CasterAccess::make(device, scene, TunedCasterOptions{options, {}});
}

}  // namespace promin
