// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "promin/ray.h"
#include "scene/world_scene.h"

namespace promin::measure {

enum class EmbreeCall {
  /// rtcIntersect1, rtcOccluded1.
  kSingle,
  /// rtcIntersect8, rtcOccluded8.
  kPackets,
};

/// Embree on all cores over the triangles of a scene, in its default settings: build quality medium, no scene flag.
class EmbreeCaster {
 public:
  virtual ~EmbreeCaster() = default;

  /// Answers each ray in the hit at the same place, as Caster does. Returns milliseconds.
  virtual double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, EmbreeCall call) = 0;

  /// Milliseconds of rtcCommitScene for another scene of the same triangles.
  virtual double time_build() = 0;
};

/// "Embree 3.13.5" and what it uses; empty where promin was built without it.
std::string embree_version();

/// Null where promin was built without Embree and for a scene of anything but meshes.
std::unique_ptr<EmbreeCaster> make_embree_caster(const world::Scene& scene);

}  // namespace promin::measure
