// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "measure/ray_sets.h"
#include "promin/device.h"
#include "scene/features.h"

namespace promin {

class DeviceScene;

namespace measure {

/// The total numbers of steps of a set of rays.
struct StepCounts {
  uint64_t rays = 0;
  uint64_t hits = 0;
  uint64_t node_steps = 0;
  uint64_t primitive_tests = 0;

  bool operator==(const StepCounts&) const = default;
};

/// Counts node steps and primitive tests of rays. Each ray is traced alone and in its order (as `promin cast` does on
/// GPUs; on lavapipe it traces packets). Counts are integers and the device's arithmetic is exact to the bit, so they
/// do not depend on the driver.
class StepCounter {
 public:
  /// Throws UsageError if the builder is unknown, and RunError.
  StepCounter(const gpu::Device& device, const world::Scene& scene, std::string_view builder);

  StepCounts count(const RaySet& set) const;

 private:
  const gpu::Device& device_;
  FeatureMask features_;
  std::shared_ptr<const DeviceScene> scene_;
};

}  // namespace measure
}  // namespace promin
