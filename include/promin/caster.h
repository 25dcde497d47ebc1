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
#include <utility>

#include "promin/export.h"
#include "promin/instances.h"
#include "promin/math.h"
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
  /// the simplest, "spatial" takes longest and helps with long, thin triangles. The hits do not depend on the builder.
  std::string builder = "sah";
  /// A BVH file to read the tree from. Without one the tree is built.
  std::optional<std::filesystem::path> bvh = std::nullopt;
  /// The objects that share the triangles of their meshes. The trees of a BVH file belong to one choice.
  Instancing instances = Instancing::kAuto;
  /// Receives the progress of building the tree. If it returns false, the constructor throws Cancelled.
  ProgressCallback progress = {};
};

/// All hits of some consecutive rays. Caster::list passes such lists to its sink. The spans are valid only during the
/// call.
struct HitList {
  /// Index of the first of these rays among all rays of the call to Caster::list.
  uint64_t first_ray = 0;
  /// One entry more than the list has rays. The hits of ray first_ray + i are hits[offsets[i]] to hits[offsets[i + 1] -
  /// 1].
  std::span<const uint64_t> offsets;
  /// The hits, sorted by ray. The hits of one ray are sorted by t, then by (object, primitive). If a ray passes through
  /// a solid, it has two hits with the same ids: first the hit where it enters, then the hit where it leaves.
  std::span<const Hit> hits;
};
/// Receives the lists of all rays, in the order of the rays, on the caller's thread. The sink must not call the Caster.
/// An exception that the sink throws ends the call.
using HitListSink = std::function<void(const HitList&)>;

/// Casts rays at a scene and returns their hits. A Caster holds the scene in device memory and uses the same traversal
/// and intersection tests as pictures.
///
/// Lifetimes: the Device must outlive the Caster. The Caster keeps no reference to the Scene, which may change or be
/// destroyed. After a move the old Caster may only be destroyed or assigned to. Threads: only one thread at a time may
/// use a Caster. Several Casters and Renderers may share a Device on several threads. Failures: after an exception the
/// Caster stays usable, unless the device was lost.
class PROMIN_EXPORT Caster {
 public:
  /// Builds the tree (a bounding volume hierarchy) and uploads the scene. Throws UsageError for an unknown builder,
  /// InputError for an invalid scene (see validate) or a BVH file that is damaged or belongs to another scene, RunError
  /// if memory runs out or a device limit is exceeded, and Cancelled.
  Caster(const gpu::Device& device, const Scene& scene, const CasterOptions& options = {});
  ~Caster();
  /// Moves the contents of another Caster into a new Caster.
  Caster(Caster&&) noexcept;
  /// Frees the contents of this Caster and moves the contents of the other one here.
  Caster& operator=(Caster&&) noexcept;

  /// Compiles the kernels that cast these rays. Without this call, the first cast of such rays compiles the kernels.
  /// setup_stats() includes the time. Throws RunError.
  void prepare(HitQuery query, std::span<const Ray> rays);

  /// Casts the rays and writes the hit of ray i to hits[i]. Both spans have the same size; any size is allowed. The
  /// hits do not depend on the number of rays in a call or on their order. The Caster traces rays in packets, or sorts
  /// them first, if that is faster. Returns the time of the traversal dispatches and of sorting rays in milliseconds,
  /// measured by the device's clock. It does not include the time for copying rays and hits. Calls `progress` between
  /// dispatches. Throws UsageError if the sizes differ or `query` is HitQuery::kCount or kAll; throws RunError and
  /// Cancelled. After Cancelled, the hits of the finished parts are valid; each part has 2^20 rays.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query = HitQuery::kNearest,
              const ProgressCallback& progress = {});

  /// Writes true or false for each ray: whether the ray hits anything, as cast() with HitQuery::kAny decides it. Both
  /// spans have the same size; any size is allowed. Returns and throws the same as cast().
  double occluded(std::span<const Ray> rays, std::span<bool> are_occluded, const ProgressCallback& progress = {});

  // Crossings. A ray has one crossing with a triangle that it passes through and with a plane that it hits. It has two
  // crossings with a solid: where it enters and where it leaves. It has a crossing with an open cylinder or cone
  // wherever it passes through the side. Only crossings with tmin < t < tmax count. Each ray is treated as if it were
  // shifted sideways by an infinitely small step. If a ray passes exactly through an edge or a corner that several
  // triangles share, it therefore crosses only one of them. The number of crossings of a closed mesh is even if the ray
  // starts outside and odd if it starts inside, for every direction. A ray that only touches a surface does not cross
  // it: at a silhouette there are 0 or 2 crossings. A ray enters where direction . normal < 0 (docs/model.md, "All hits
  // of a ray").
  //
  // cast() has other rules: a ray hits a triangle if it passes through its edge, and it hits surfaces that it only
  // touches. The hit of cast() may therefore differ from the first crossing, or exist if there is no crossing.

  /// Counts the crossings of each ray. Both spans have the same size; any size is allowed. The counts do not depend on
  /// the other rays, their order or the tree. Returns the same time as cast(). Throws UsageError if the sizes differ,
  /// RunError (also if a ray has more crossings than the device can process), and Cancelled.
  double count(std::span<const Ray> rays, std::span<int32_t> counts, const ProgressCallback& progress = {});

  /// The default of `budget_bytes` of list().
  static constexpr uint64_t kListBytes = uint64_t{1} << 26;

  /// Lists all crossings of each ray as hits, in the order of the rays. The number of rays has no limit. Each call of
  /// `sink` receives as many rays as fit into `budget_bytes` with all their hits, but at least one ray. The memory use
  /// is about three times the budget plus 200 MB; it does not depend on the number of rays. Returns the same as count()
  /// and throws the same errors. Also throws RunError if the hits of a single ray do not fit into a buffer of the
  /// device.
  double list(std::span<const Ray> rays, const HitListSink& sink, uint64_t budget_bytes = kListBytes,
              const ProgressCallback& progress = {});

  /// Casts later rays at the scene in another pose, like Renderer::set_pose. Throws the same errors.
  void set_pose(const Scene& posed);
  /// Gives objects other transforms, like Renderer::set_transforms. Later hits have the same bits as those of a new
  /// Caster of the moved scene. Throws the same errors.
  void set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object);

  /// Returns the cost of construction and of compilation so far. The reference is valid as long as the Caster exists.
  const SetupStats& setup_stats() const;

 private:
  struct Impl;
  friend struct CasterAccess;
  explicit Caster(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace promin
