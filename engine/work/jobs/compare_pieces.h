// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "promin/ray.h"
#include "promin/scene.h"
#include "scene/world_scene.h"
#include "work/jobs/picture_part.h"

// Compares the results of two devices for the same piece of a job. Devices with the same fingerprint give the same
// bits. The results of other devices are within the published bounds of the exact result, so two results differ by at
// most twice the bounds. If a ray passes so close to an edge that rounding decides which surface it hits, the results
// may belong to different surfaces. The only guarantee is that this is rare.
namespace promin::work {

/// The largest allowed difference of a pixel's number, relative for numbers beyond 1: the limit of golden pictures on
/// all drivers.
inline constexpr double kMostPixelDifference = 0.004;
/// The largest allowed difference of t in units of K (docs/glossary.md): twice the bound B1 = 8 of one device.
inline constexpr double kMostK = 16.0;
/// The largest allowed fraction of pixels or rays that differ because of an edge. Tests of golden pictures use the same
/// limit.
inline constexpr double kMostMismatches = 0.005;

/// The difference between two results of the same piece.
struct PieceDifference {
  /// Number of pixels or rays.
  uint64_t count = 0;
  /// Number of mismatches: pixels or rays whose numbers differ by more than kMostPixelDifference or kMostK, or that
  /// show different surfaces.
  uint64_t mismatches = 0;
  /// The largest difference among all pixels or rays that are not mismatches: the difference of a number, or of t in
  /// units of K.
  double largest = 0.0;

  bool is_within_bounds() const {
    return static_cast<double>(mismatches) <= kMostMismatches * static_cast<double>(count);
  }
};

/// Compares colours and channels. Throws InputError with the file's name if the parts do not belong to the same
/// picture.
PieceDifference compare_parts(const PicturePart& there, const PicturePart& anew, const std::filesystem::path& file);

/// Compares the results of rays that were cast at a scene. Objects have the numbers of the scene's file.
class HitComparison {
 public:
  explicit HitComparison(const Scene& scene);

  /// Compares one hit per ray, the nearest or any. The values of t are compared if both hits are on the same primitive.
  /// Weights and normals are not compared, because no bound is published for them.
  void compare(std::span<const Ray> rays, std::span<const Hit> there, std::span<const Hit> anew);
  /// Compares all hits of one ray.
  void compare_lists(const Ray& ray, std::span<const Hit> there, std::span<const Hit> anew);
  /// Compares numbers of crossings.
  void compare(std::span<const int32_t> there, std::span<const int32_t> anew);

  const PieceDifference& difference() const { return difference_; }

 private:
  /// Returns the difference of t in units of K; infinite if the hits are on different primitives.
  double difference_of(const Ray& ray, const Hit& there, const Hit& anew) const;
  /// Returns S for the primitive that was hit, computed from the sphere around its box.
  double scale_of(const Ray& ray, const Hit& hit) const;
  void take(double difference);

  world::Scene scene_;
  PieceDifference difference_;
};

}  // namespace promin::work
