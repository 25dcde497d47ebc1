// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "picture_job.h"
#include "promin/ray.h"
#include "promin/scene.h"
#include "scene/world_scene.h"

// How far apart the answers of two devices are to the same piece of a job. Devices of one fingerprint give the same
// bits; of others the published bounds hold against the exact answer, so that two are apart by twice those at most.
// Where a ray passes so near an edge that rounding decides which surface it meets, the answers are of different
// surfaces, and no bound holds but that this is rare.
namespace promin::app {

/// The most that a number of a pixel may differ, of numbers beyond 1 relative to them: what golden pictures are held to
/// on all drivers.
inline constexpr double kMostPixelDifference = 0.004;
/// The most that K of t (docs/glossary.md) may differ: each device has B1 = 8 of it.
inline constexpr double kMostK = 16.0;
/// The most of the pixels, or rays, that an edge may decide: what golden pictures allow.
inline constexpr double kMostOthers = 0.005;

/// How far apart two makings of one piece are.
struct PieceDifference {
  /// Pixels, or rays.
  uint64_t count = 0;
  /// Those whose numbers are farther apart than kMostPixelDifference or kMostK, or that tell of different surfaces.
  uint64_t others = 0;
  /// Of the rest the largest difference of a number, or of K of t.
  double largest = 0.0;

  bool is_within_bounds() const { return static_cast<double>(others) <= kMostOthers * static_cast<double>(count); }
};

/// Colours and channels. Throws InputError, which names the file, where the parts are not of one picture.
PieceDifference compare_parts(const PicturePart& there, const PicturePart& anew, const std::filesystem::path& file);

/// Answers to rays of a scene, with the numbers that its file has for objects.
class HitComparison {
 public:
  explicit HitComparison(const Scene& scene);

  /// As many hits of either as rays, nearest or any. Their t is compared where both are of one primitive; weights and
  /// normals, for which no bound is published, are not.
  void compare(std::span<const Ray> rays, std::span<const Hit> there, std::span<const Hit> anew);
  /// All hits of one ray.
  void compare_lists(const Ray& ray, std::span<const Hit> there, std::span<const Hit> anew);
  /// Counts of hits.
  void compare(std::span<const int32_t> there, std::span<const int32_t> anew);

  const PieceDifference& difference() const { return difference_; }

 private:
  /// By how much K of t differs; infinite where the hits are of different primitives.
  double difference_of(const Ray& ray, const Hit& there, const Hit& anew) const;
  /// S of a primitive that is hit, by the sphere around its box.
  double scale_of(const Ray& ray, const Hit& hit) const;
  void take(double difference);

  world::Scene scene_;
  /// By the file's numbers; of several that have one number each counts.
  std::map<int32_t, std::vector<size_t>> objects_;
  PieceDifference difference_;
};

}  // namespace promin::app
