// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "device/profile.h"
#include "device_scene/device_scene.h"
#include "layout.h"
#include "promin/progress.h"
#include "promin/ray.h"
#include "scene/features.h"

namespace promin {

namespace gpu {
class Device;
}

/// SPIR-V of shaders/cast.comp, for the nearest hit and any.
std::span<const uint32_t> cast_spirv();
/// SPIR-V of shaders/crossings.comp, for counts and lists.
std::span<const uint32_t> crossings_spirv();

struct RayKernelOptions {
  /// Another kernel with the bindings of shaders/cast_bindings.glsl, for tests and measurements; its workgroups take
  /// the work that shaders/group_rows.glsl gives them. Empty: promin's own for the query.
  std::span<const uint32_t> spirv = {};
  FeatureMask features = all_features();
  HitQuery query = HitQuery::kNearest;
  /// Rays in a row that a lane traces together. It changes no answer, but step counts are then of the packet.
  uint32_t packet_size = 1;
  /// Read nodes and primitives as storage buffers even where texel buffers hold them, for tests and measurements.
  bool avoids_texels = false;
  /// Where empty, as suits the device.
  std::optional<gpu::TraversalForm> traversal = std::nullopt;
  /// A single dispatch is not meant to take longer. Where empty, as suits the device.
  std::optional<double> target_dispatch_ms = std::nullopt;
  /// Fixed number of rays a dispatch, for tests; 0 adapts.
  uint32_t rays_per_dispatch = 0;
};

/// A kernel that takes rays and gives a record for each; under Caster, and the bare device for tests.
class RayKernel {
 public:
  /// Compiles; throws RunError.
  RayKernel(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, const RayKernelOptions& options);
  ~RayKernel();
  RayKernel(RayKernel&&) noexcept;
  RayKernel& operator=(RayKernel&&) noexcept;

  /// Most rays that one call of run takes.
  static constexpr size_t kMaxRays = size_t{1} << 20;

  /// Fills as many records as there are rays, at most kMaxRays; what layout.h says is not told of any hit stays as it
  /// was before. Of kCount a.x of each record is the ray's number of crossings. Returns device milliseconds. Not for
  /// kAll. `progress` is called between dispatches; throws Cancelled, and then no record is filled.
  double run(std::span<const layout::RayRecord> rays, std::span<layout::HitRecord> records,
             const ProgressCallback& progress = {});
  /// The same without copies between: `fill` writes `count` rays, and `take` is shown as many records, both where the
  /// device has them if the host can map that.
  double run(size_t count, const std::function<void(std::span<layout::RayRecord>)>& fill,
             const std::function<void(std::span<const layout::HitRecord>)>& take,
             const ProgressCallback& progress = {});

  /// For kAll: fills the crossings of the rays, of which each has `counts` at the same place, as kCount told; ray by
  /// ray, a ray's in whatever order the tree has them. At most most_listed(rays.size()) of them. Throws RunError where
  /// a ray has another number. `progress` as in run().
  double list(std::span<const layout::RayRecord> rays, std::span<const uint32_t> counts,
              std::span<layout::HitRecord> crossings, const ProgressCallback& progress = {});
  /// How many crossings of so many rays a buffer of the device can hold.
  uint64_t most_listed(size_t ray_count) const;

  /// Time that compiling took.
  double pipeline_ms() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
