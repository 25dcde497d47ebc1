// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "device_scene/pack_scene.h"
#include "promin/device.h"
#include "promin/ray.h"
#include "scene/world_scene.h"
#include "trace/kernels/ray_kernel.h"

namespace promin::hard {

/// Returns the origin of a secondary ray of the renderer.
struct Bounce {
  bool is_hit = false;
  PrimitiveId id;
  /// The ray's start, `lift` above the surface on the side that the ray comes from.
  vec3 origin{0.0F};
  float lift = 0.0F;
  vec3 mirrored{0.0F};
};

/// Makes the renderer's secondary rays in a scene, with its own lift and mirror direction (tests/hard/bounce.comp).
class Bouncer {
 public:
  Bouncer(const gpu::Device& device, const world::Scene& scene);

  /// Returns one bounce for each ray.
  std::vector<Bounce> bounce(std::span<const Ray> rays);

 private:
  Bouncer(const gpu::Device& device, PackedScene packed, FeatureMask features);

  PrimitiveNumbers numbers_;
  RayKernel kernel_;
};

}  // namespace promin::hard
