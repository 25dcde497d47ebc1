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
  /// Uses rtcIntersect1 and rtcOccluded1.
  kSingle,
  /// Uses rtcIntersect8 and rtcOccluded8.
  kPackets,
};

/// Casts rays with Embree on all cores over the triangles of a scene, in its default settings: build quality medium, no
/// scene flag. Instances share the trees of their meshes.
class EmbreeCaster {
 public:
  virtual ~EmbreeCaster() = default;

  /// Writes the answer to each ray to the same index of `hits`, as Caster does. Returns the time in milliseconds.
  virtual double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query, EmbreeCall call) = 0;

  /// Returns the milliseconds of rtcCommitScene for another scene of the same triangles. If there are instances, this
  /// includes the scenes of their meshes.
  virtual double time_build() = 0;
  /// Returns the number of bytes that Embree has allocated, including copies of the triangles.
  virtual int64_t size_bytes() const = 0;
};

/// Returns "Embree 3.13.5" and the instructions it uses, for example; returns an empty text if promin was built without
/// Embree.
std::string embree_version();

/// Returns null if promin was built without Embree or the scene has other shapes than meshes.
std::unique_ptr<EmbreeCaster> make_embree_caster(const world::Scene& scene);

}  // namespace promin::measure
