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

/// All hits of some consecutive rays, which Caster::list hands out. What the spans show lives as long as the call.
struct HitList {
  /// The first of the rays, counted from the first that was given.
  uint64_t first_ray = 0;
  /// One more than there are rays here: the hits of ray first_ray + i are those from offsets[i] up to offsets[i + 1].
  std::span<const uint64_t> offsets;
  /// Ray by ray; of a ray by t, then by (object, primitive). Both ends of the way through a solid have the same ids, of
  /// which the first enters it.
  std::span<const Hit> hits;
};
/// Takes the lists of all rays, one after the other, on the caller's thread. It does not call the Caster. What it
/// throws ends the call.
using HitListSink = std::function<void(const HitList&)>;

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
  /// rays and hits. `progress` is called between dispatches. Throws UsageError where there are not as many hits as rays
  /// and for HitQuery::kCount and kAll, RunError, Cancelled: then hits are filled as far as it came, by parts of 2^20.
  double cast(std::span<const Ray> rays, std::span<Hit> hits, HitQuery query = HitQuery::kNearest,
              const ProgressCallback& progress = {});

  /// Tells of each ray whether it hits anything, as cast() does with HitQuery::kAny; as many answers as rays, any
  /// number. Returns and throws what cast() does.
  double occluded(std::span<const Ray> rays, std::span<bool> are_occluded, const ProgressCallback& progress = {});

  // Crossings. A ray crosses a triangle where it goes through it, a plane where it meets it, a solid where it enters
  // and where it leaves it, an open cylinder or cone where it goes through its side; of these the ones with tmin < t <
  // tmax count. The rays count as moved aside by an infinitely small step: of the triangles that share an edge or a
  // corner which a ray meets one alone is crossed on the ray's way through their surface, so that the number of
  // crossings of a closed mesh is even from outside and odd from inside, whatever the rays are aimed at. What is only
  // touched is not crossed: a silhouette has 0 or 2. Rays enter where direction . normal < 0 (docs/model.md, "All hits
  // of a ray").
  //
  // So these differ from cast(), whose triangles own their edges and which meets what it touches: there the first hit
  // may be another one, or cast() alone has one.

  /// Counts the crossings of each ray; as many counts as rays, any number. They do not depend on the company, the order
  /// or the tree. Returns milliseconds as cast() does. Throws UsageError where there are not as many counts as rays,
  /// RunError, also where a ray has more crossings than the device can go through, and Cancelled.
  double count(std::span<const Ray> rays, std::span<int32_t> counts, const ProgressCallback& progress = {});

  /// The budget of list() unless it is given.
  static constexpr uint64_t kListBytes = uint64_t{1} << 26;

  /// Lists all crossings of each ray as hits: of any number of rays, in their order, as many at a time as have hits of
  /// `budget_bytes`, or one ray. Whatever the number of rays, memory is some three times that and 200 MB. Throws and
  /// returns what count() does; RunError too for a ray whose hits alone do not fit in a buffer of the device.
  double list(std::span<const Ray> rays, const HitListSink& sink, uint64_t budget_bytes = kListBytes,
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
