// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// Options of a Caster. The defaults suit most scenes.
struct CasterOptions {
  /// The builder of the tree, one of builder_names() (promin/setup_stats.h): "sah" builds a good tree fast, "median" is
  /// the simplest, "spatial" takes longest and helps with long, thin triangles. The hits are the same.
  std::string builder = "sah";
  /// A BVH file to read the tree from. Without one the tree is built.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// Receives the progress of building the tree. If it returns false, the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// All hits of some consecutive rays, as Caster::list passes them on. The spans are valid only during the call.
struct HitList {
  /// Index of the first of these rays among all rays of the call.
  uint64_t first_ray = 0;
  /// One more entry than there are rays here. The hits of ray first_ray + i are hits[offsets[i]] up to, but without,
  /// hits[offsets[i + 1]].
  std::span<const uint64_t> offsets;
  /// The hits, ray by ray; those of one ray are sorted by t, then by (object, primitive). Where a ray passes through a
  /// solid, the hit that enters it and the hit that leaves it have the same ids; the first one enters.
  std::span<const Hit> hits;
};
/// Receives the lists of all rays, one after the other, on the caller's thread. It must not call the Caster. An
/// exception that it throws ends the call.
using HitListSink = std::function<void(const HitList&)>;

/// Casts rays at a scene and returns their hits. It holds the scene in device memory and uses the same traversal and
/// intersection tests as pictures.
///
/// Lifetimes: the Device must outlive the Caster. The Caster keeps no reference to the Scene, which may change or be
/// destroyed. After a move the old Caster may only be destroyed or assigned to. Threads: only one thread at a time may
/// use a Caster. Several Casters and Renderers may share a Device on several threads. Failures: after an exception the
/// Caster stays usable, unless the device was lost.
class PROMIN_EXPORT Caster {
 public:
  /// Builds the tree (a bounding volume hierarchy) and uploads the scene. Throws UsageError for an unknown builder,
  /// InputError for an invalid scene (see validate) and for a BVH file that is damaged or belongs to another scene,
  /// RunError if memory runs out or a device limit is exceeded, and Cancelled.
  Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options = {});
  ~Caster();
  /// Moves the other Caster's contents here.
  Caster(Caster&&) noexcept;
  /// Frees its own contents and moves the other Caster's here.
  Caster& operator=(Caster&&) noexcept;

  /// Compiles the kernels for casting rays like these. Without this call their first cast compiles them. setup_stats()
  /// includes the time. Throws RunError.
  void prepare(HitQuery query, std::span<const Ray> rays);

  /// Casts the rays and writes the hit of ray i to hits[i]. Both spans have the same size, which may be any. The hits
  /// do not depend on the number of rays in a call or on their order. Rays are traced in packets or sorted first where
  /// that is faster. Returns the milliseconds of the traversal dispatches, by the device's clock, plus those of sorting
  /// rays, without copying rays and hits. Calls `progress` between dispatches. Throws UsageError if the sizes differ
  /// and for HitQuery::kCount and kAll, RunError, and Cancelled. After Cancelled the hits of the finished parts, of
  /// 2^20 rays each, are valid.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query = HitQuery::kNearest,
              const ProgressCallback& progress = {});

  /// Writes for each ray whether it hits anything, as cast() does with HitQuery::kAny. Both spans have the same size,
  /// which may be any. Returns and throws what cast() does.
  double occluded(std::span<const Ray> rays, std::span<bool> are_occluded, const ProgressCallback& progress = {});

  // Crossings. A ray crosses a triangle where it passes through it, a plane where it hits it, a solid where it enters
  // and where it leaves it, and an open cylinder or cone where it passes through its side. Only crossings with tmin < t
  // < tmax count. Each ray is treated as if it were shifted sideways by an infinitely small step. If a ray passes
  // exactly through an edge or a corner that several triangles share, it therefore crosses only one of them. The number
  // of crossings of a closed mesh is even from outside and odd from inside, wherever the ray is aimed. A surface that a
  // ray only touches is not crossed: at a silhouette there are 0 or 2 crossings. A ray enters where direction . normal
  // < 0 (docs/model.md, "All hits of a ray").
  //
  // cast() differs: its triangles own their edges, and it hits surfaces that a ray only touches. Its hit may therefore
  // differ from the first crossing, or exist where there is no crossing.

  /// Counts the crossings of each ray. Both spans have the same size, which may be any. The counts do not depend on the
  /// other rays, their order or the tree. Returns milliseconds as cast() does. Throws UsageError if the sizes differ,
  /// RunError (also if a ray has more crossings than the device can process), and Cancelled.
  double count(std::span<const Ray> rays, std::span<int32_t> counts, const ProgressCallback& progress = {});

  /// The default budget of list().
  static constexpr uint64_t kListBytes = uint64_t{1} << 26;

  /// Lists all crossings of each ray as hits, for any number of rays and in their order. Each call of `sink` receives
  /// as many rays as fit with all their hits into `budget_bytes`, but at least one. Memory use is about three times the
  /// budget plus 200 MB, whatever the number of rays. Returns the same as count() and throws the same errors, and
  /// RunError also if the hits of a single ray do not fit into a buffer of the device.
  double list(std::span<const Ray> rays, const HitListSink& sink, uint64_t budget_bytes = kListBytes,
              const ProgressCallback& progress = {});

  /// Returns the cost of construction and of compilation so far. The reference is valid as long as the Caster.
  const SetupStats& setup_stats() const;

 private:
  struct Impl;
  friend struct CasterAccess;
  explicit Caster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
