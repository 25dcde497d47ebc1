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
#include "promin/progress.h"
#include "promin/ray.h"
#include "scene/features.h"
#include "shared/layout.h"

namespace promin {

namespace gpu {
class Device;
}

/// Returns the SPIR-V of shaders/cast/cast.comp, which finds the nearest hit or any hit.
std::span<const uint32_t> cast_spirv();
/// Returns the SPIR-V of shaders/cast/crossings.comp, which makes counts and lists.
std::span<const uint32_t> crossings_spirv();

/// Returns whether the query counts or lists all intersections of a ray.
inline bool asks_for_crossings(HitQuery query) {
  return query == HitQuery::kCount || query == HitQuery::kAll;
}

struct RayKernelOptions {
  /// SPIR-V of another kernel with the bindings of shaders/cast/cast_bindings.glsl, for tests and measurements. Its
  /// workgroups must take their work from shaders/shared/group_rows.glsl. Empty for promin's own kernel of the query.
  std::span<const uint32_t> spirv = {};
  FeatureMask features = all_features();
  HitQuery query = HitQuery::kNearest;
  /// Number of consecutive rays that a lane traces together. It does not change the results, but step counts are then
  /// those of the whole packet.
  uint32_t packet_size = 1;
  /// If true, the kernel reads nodes and primitives from storage buffers even if texel buffers can hold them. For tests
  /// and measurements.
  bool avoids_texels = false;
  /// The form of traversal; if empty, the device profile decides.
  std::optional<gpu::TraversalForm> traversal = std::nullopt;
  /// Target for the longest time of a dispatch. If empty, the device profile decides.
  std::optional<double> target_dispatch_ms = std::nullopt;
  /// Fixed number of rays per dispatch, for tests; if 0, the number is adapted.
  uint32_t rays_per_dispatch = 0;
};

/// A kernel that traces rays and writes a record for each. Caster uses it; tests use it directly.
class RayKernel {
 public:
  /// Compiles the kernel. Throws RunError.
  RayKernel(const gpu::Device& device, std::shared_ptr<const DeviceScene> scene, const RayKernelOptions& options);
  ~RayKernel();
  RayKernel(RayKernel&&) noexcept;
  RayKernel& operator=(RayKernel&&) noexcept;

  /// The largest number of rays in one call of run().
  static constexpr size_t kMaxRays = size_t{1} << 20;

  /// Fills one record for each ray; there may be at most kMaxRays rays. Members that layout.h does not define for
  /// any-hit rays keep their values. For kCount, a.x of each record is the ray's number of crossings. This function is
  /// not for kAll. Calls `progress` between dispatches. Returns device milliseconds. Throws Cancelled; in that case it
  /// fills no record.
  double run(std::span<const layout::RayRecord> rays, std::span<layout::HitRecord> records,
             const ProgressCallback& progress = {});
  /// Traces rays without extra copies: `fill` writes `count` rays and `take` reads the same number of records, both
  /// directly in the device's memory if the host can map it.
  double run(size_t count, const std::function<void(std::span<layout::RayRecord>)>& fill,
             const std::function<void(std::span<const layout::HitRecord>)>& take,
             const ProgressCallback& progress = {});

  /// For kAll: writes the crossings of all rays, ray by ray. The crossings of a ray are in the order of the tree.
  /// `counts` has the number of crossings of each ray, as kCount returned it. There may be at most
  /// most_listed(rays.size()) crossings in all. Throws RunError if a ray has another number. `progress` is called as in
  /// run().
  double list(std::span<const layout::RayRecord> rays, std::span<const uint32_t> counts,
              std::span<layout::HitRecord> crossings, const ProgressCallback& progress = {});
  /// Returns the largest number of crossings of this number of rays that a buffer of the device can hold.
  uint64_t most_listed(size_t ray_count) const;

  /// Uses the constants of the scene again after they have changed. The kernel's buffers must still be the scene's.
  void take_constants();

  /// Returns the time of compilation in milliseconds.
  double pipeline_ms() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
