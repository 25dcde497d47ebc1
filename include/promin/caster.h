// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "promin/export.h"
#include "promin/progress.h"
#include "promin/ray.h"
#include "promin/scene.h"
#include "promin/setup_stats.h"

namespace promin {

namespace gpu {
class Device;
}

/// How a Caster is made. The defaults suit most scenes.
struct CasterOptions {
  /// How the tree is built, one of builder_names() (promin/setup_stats.h): "sah" is built fast and is good, "median" is
  /// the simplest, "spatial" takes longest to build and helps where triangles are long and thin. Hits are the same.
  std::string builder = "sah";
  /// A BVH file to take the tree from instead of building one.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// Told how far building the tree is; where it returns false the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// Rays in, hits out: a scene in device memory and the traversal and intersections that pictures are made with.
///
/// Lifetimes: the Device must outlive the Caster; of the Scene it keeps nothing, so the scene may change or end. After
/// a move the old Caster may only be destroyed or assigned to. Threads: one Caster serves one thread at a time; several
/// Casters and Renderers may share a Device on several threads. Failures: what a call threw leaves the Caster as usable
/// as before, unless the device was lost.
class PROMIN_EXPORT Caster {
 public:
  /// Builds the tree, a bounding volume hierarchy, and uploads the scene. Throws UsageError for an unknown builder,
  /// InputError for a scene that is not valid (see validate) and for a BVH file that is bad or not the scene's,
  /// RunError where memory does not suffice or a device limit is passed, Cancelled.
  Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options = {});
  ~Caster();
  /// Takes all that the other has.
  Caster(Caster&&) noexcept;
  /// Takes all that the other has, and frees its own.
  Caster& operator=(Caster&&) noexcept;

  /// Compiles what casting rays like these takes; otherwise their first cast does. The time is in setup_stats(). Throws
  /// RunError.
  void prepare(HitQuery query, std::span<const Ray> rays);

  /// Answers each ray in the hit at the same place; as many hits as rays, any number. The answers do not depend on how
  /// many rays are cast together, nor on their order: where that is faster they are traced in packets or sorted first.
  /// Returns milliseconds of the traversal dispatches, by the device's clock, and of ordering the rays; not of copying
  /// rays and hits. Throws UsageError where there are not as many hits as rays, RunError, Cancelled: then hits are
  /// filled as far as it came.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query = HitQuery::kNearest,
              const ProgressCallback& progress = {});

  /// What making this and compiling so far has cost. Valid while the Caster is.
  const SetupStats& setup_stats() const;

 private:
  struct Impl;
  friend struct CasterAccess;
  explicit Caster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
