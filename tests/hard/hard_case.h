// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The hard cases of ray tracing in floating point. Each runs on the device and has a bound that it must meet.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <span>
#include <string>
#include <vector>

#include "measure/meshes.h"
#include "measure/random.h"
#include "measure/ray_sets.h"
#include "oracle/verdict.h"
#include "promin/device.h"
#include "promin/ray.h"
#include "scene/world_scene.h"
#include "shared/layout.h"
#include "trace/kernels/ray_kernel.h"

namespace promin::hard {

using measure::make_triangle;
using measure::Random;
using measure::ray_towards;
using measure::scene_of;

class Lab;

/// Returns how many of a row's rays are cast: an eighth of them, or all with tools/test --long and in tools/accuracy.
size_t some_of(size_t rays);

/// One row of the table of hard cases.
struct HardCase {
  int row = 0;
  const char* name = "";
  void (*run)(Lab& lab) = nullptr;
};

std::ostream& operator<<(std::ostream& out, const HardCase& hard_case);

/// The rows of each file.
std::span<const HardCase> sphere_cases();
std::span<const HardCase> plane_cases();
std::span<const HardCase> solid_cases();
std::span<const HardCase> triangle_cases();
std::span<const HardCase> box_cases();
std::span<const HardCase> ray_cases();
std::span<const HardCase> secondary_cases();
std::span<const HardCase> host_cases();
std::span<const HardCase> tree_cases();
std::span<const HardCase> implicit_cases();
std::span<const HardCase> glass_cases();
std::span<const HardCase> instance_cases();
std::span<const HardCase> light_cases();

/// The errors of the answers to many rays, compared with the oracle, in units of u S (docs/glossary.md).
struct Tally {
  uint64_t rays = 0;
  /// The number of rays compared with the oracle. All members below count only these rays, except for rays that slip
  /// through.
  uint64_t judged = 0;
  /// Rays for which the device and the oracle have the same hit.
  uint64_t hits = 0;
  /// Rays that hit in the oracle and miss on the device.
  uint64_t misses = 0;
  /// The largest |dt| |d| cos / (u S) of the hits: B1.
  double max_t_error = 0.0;
  double sum_t_error2 = 0.0;
  /// The largest distance of o + t d from the surface, over u S, of all hits on analytic shapes: BK.
  double max_surface_error = 0.0;
  /// Rays for which device and oracle have different ids, or only one has a hit. The next member is the largest
  /// distance of such a ray from an edge or silhouette: B2.
  uint64_t misclassified = 0;
  double max_margin = 0.0;
  /// Hits whose t, u, v or normal is not finite, or whose normal is not of unit length.
  uint64_t malformed = 0;

  double rms_t_error() const;
  void add(const Tally& other);
  /// Returns the tally without `hits` and their errors of t. The table of primitives takes this if those errors come
  /// from an edge, an apex or a sliver, and not from the primitive.
  Tally without_t_errors() const;
};

/// The tools of a hard case: the device, the oracle, and the collection of figures.
class Lab {
 public:
  Lab(const gpu::Device& device, int row) : device_(device), row_(row) {}

  const gpu::Device& device() const { return device_; }

  /// Returns 1 if the driver computes divisions and roots with correct rounding, else 2. Bounds on K are multiplied by
  /// this factor.
  double rounding_factor() const;

  /// Casts with the public Caster, or with the kernel that PROMIN_TEST_KERNELS names.
  std::vector<Hit> cast(const world::Scene& scene, std::span<const Ray> rays,
                        HitQuery query = HitQuery::kNearest) const;

  /// Compares each answer with the oracle's, on all cores.
  static Tally judge(const world::Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits);
  Tally cast_and_judge(const world::Scene& scene, std::span<const Ray> rays) const;

  /// Prints the figure beside its bound, keeps it for docs/accuracy.md, and fails the test if it exceeds the bound.
  /// `what` names the figure and its unit: "K of t, distance 1e4".
  void expect_at_most(const std::string& what, double bound, double figure) const;
  /// Prints and keeps a figure without a bound.
  void note(const std::string& what, double figure) const;

  /// Adds all rays of a row to the table of primitives if the scene has only this kind of shape.
  static void credit(const std::string& primitive, const Tally& tally, uint64_t leaks = 0);

  /// Returns the device's own records of a packed scene, which a test may have edited. `features` are the scene's;
  /// FEATURE_STEP_COUNTS adds the numbers of steps. There are at most RayKernel::kMaxRays rays. `time_ms` receives the
  /// device's time.
  std::vector<layout::HitRecord> cast_packed(const PackedScene& packed, FeatureMask features, std::span<const Ray> rays,
                                             double* time_ms = nullptr) const;

  /// Returns the SPIR-V of shaders/cast/cast.comp, or of the kernel that PROMIN_TEST_KERNELS names.
  static std::span<const uint32_t> cast_kernel();
  /// Returns the SPIR-V of tests/hard/bounce.comp, or of the kernel that PROMIN_TEST_KERNELS names.
  static std::span<const uint32_t> bounce_kernel();

 private:
  const gpu::Device& device_;
  int row_;
};

/// Returns a label such as "distance 1e+04".
std::string label(const char* what, double value);

/// Returns the same primitives in infinite boxes. Every ray then tests every primitive: if the answers differ, a box
/// has hidden a hit.
PackedScene with_infinite_boxes(PackedScene packed);

/// Returns the number of rays whose records differ in order or in the bits of t.
uint64_t count_differences(std::span<const layout::HitRecord> a, std::span<const layout::HitRecord> b);

/// Returns a ray across a mesh's triangle, from one point near it to another, at a cosine of 1e-9...3e-6 to its plane:
/// only the rounding of origin and direction decides where the ray meets the plane.
Ray ray_grazing(const Mesh& mesh, const uvec3& triangle, Random& random);

}  // namespace promin::hard
