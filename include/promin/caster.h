// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "promin/ray.h"
#include "promin/scene.h"
#include "promin/setup_stats.h"

namespace promin {

namespace gpu {
class Device;
}

struct CasterOptions {
  std::string builder = "sah";
  /// A BVH file (bvh/bvh_file.h) to take the tree from instead of building one.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// SPIR-V of another kernel with the bindings of shaders/cast_bindings.glsl, for tests and measurements; empty for
  /// promin's own.
  std::span<const uint32_t> spirv = {};
};

/// Rays in, hits out: a scene in device memory and the traversal and intersections that pictures are made with. Keeps
/// no reference to the Scene. One Caster serves one thread.
class Caster {
 public:
  /// Builds the BVH and uploads. Throws UsageError for an unknown builder, InputError for a BVH file that is bad or not
  /// the scene's, RunError where memory does not suffice or a device limit is passed.
  Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options = {});
  ~Caster();
  Caster(Caster&&) noexcept;
  Caster& operator=(Caster&&) noexcept;

  /// Compiles what casting rays like these takes; otherwise their first cast does. The time is in setup_stats().
  void prepare(HitQuery query, std::span<const Ray> rays);

  /// Answers each ray in the hit at the same place; as many hits as rays, any number. The answers do not depend on how
  /// many rays are cast together, nor on their order: on lavapipe rays that run side by side are traced in packets,
  /// those of rows tile by tile, and on every CPU device others are sorted first. `progress` is called with the
  /// fraction done, 0...1. Returns milliseconds of the traversal dispatches, by the device's clock, and of ordering the
  /// rays; not of copying rays and hits.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query = HitQuery::kNearest,
              const std::function<void(double)>& progress = {});

  const SetupStats& setup_stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
