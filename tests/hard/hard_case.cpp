// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "hard/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <ostream>

#include "bounce.spv.h"
#include "core/parallel.h"
#include "core/rounding.h"
#include "hard/figures.h"
#include "promin/caster.h"
#include "support/read_spirv.h"
#include "support/thorough.h"
#include "trace/render/caster_access.h"

namespace promin::hard {
namespace {

/// Returns the kernel `name`.spv in the folder that PROMIN_TEST_KERNELS names, for tests that check these tests. If the
/// variable is not set, returns promin's own kernel.
std::vector<uint32_t> load_kernel(const char* name, std::span<const uint32_t> own) {
  const char* folder = std::getenv("PROMIN_TEST_KERNELS");
  if (folder == nullptr) return {own.begin(), own.end()};
  return read_spirv(std::filesystem::path(folder) / name);
}

bool is_well_formed(const Hit& hit) {
  return std::isfinite(hit.t) && std::isfinite(hit.u) && std::isfinite(hit.v) &&
         std::abs(glm::length(dvec3(hit.normal)) - 1.0) <= 4.0 * static_cast<double>(kUnitRoundoff);
}

void judge_one(const world::Scene& scene, const Ray& ray, const Hit& hit, Tally& tally) {
  const oracle::Ray exact{oracle::Vector(ray.origin), oracle::Vector(ray.direction), ray.tmin, ray.tmax};
  const oracle::Verdict verdict = oracle::judge(scene, exact, {hit.t, hit.object, hit.primitive});
  ++tally.rays;
  ++tally.judged;
  if (hit.object >= 0) {
    if (!is_well_formed(hit)) ++tally.malformed;
    tally.max_surface_error = std::max(tally.max_surface_error, static_cast<double>(verdict.surface_error));
  } else if (verdict.exact.exists()) {
    ++tally.misses;
  }
  if (!verdict.is_same) {
    ++tally.misclassified;
    tally.max_margin = std::max(tally.max_margin, static_cast<double>(verdict.margin));
  } else if (hit.object >= 0) {
    const auto t_error = static_cast<double>(verdict.t_error);
    ++tally.hits;
    tally.max_t_error = std::max(tally.max_t_error, t_error);
    tally.sum_t_error2 += t_error * t_error;
  }
}

}  // namespace

size_t some_of(size_t rays) {
  return test::is_thorough() ? rays : rays / 8;
}

double Tally::rms_t_error() const {
  return hits > 0 ? std::sqrt(sum_t_error2 / static_cast<double>(hits)) : 0.0;
}

void Tally::add(const Tally& other) {
  rays += other.rays;
  judged += other.judged;
  hits += other.hits;
  misses += other.misses;
  max_t_error = std::max(max_t_error, other.max_t_error);
  sum_t_error2 += other.sum_t_error2;
  max_surface_error = std::max(max_surface_error, other.max_surface_error);
  misclassified += other.misclassified;
  max_margin = std::max(max_margin, other.max_margin);
  malformed += other.malformed;
}

Tally Tally::without_t_errors() const {
  Tally rest = *this;
  rest.hits = 0;
  rest.max_t_error = rest.sum_t_error2 = 0.0;
  return rest;
}

double Lab::rounding_factor() const {
  // A CPU device uses the divisions and roots of the processor.
  return gpu::info_of(device_).type == "CPU" ? 1.0 : 2.0;
}

std::vector<Hit> Lab::cast(const world::Scene& scene, std::span<const Ray> rays, HitQuery query) const {
  TunedCasterOptions options;
  options.spirv = cast_kernel();
  std::vector<Hit> hits(rays.size());
  make_caster(device_, scene, options).cast(rays, hits, query);
  return hits;
}

Tally Lab::judge(const world::Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits) {
  constexpr size_t kChunk = 4096;
  std::vector<Tally> tallies((rays.size() + kChunk - 1) / kChunk);
  for_each_index(tallies.size(), 0, [&](size_t chunk) {
    const size_t end = std::min(rays.size(), (chunk + 1) * kChunk);
    for (size_t i = chunk * kChunk; i < end; ++i) judge_one(scene, rays[i], hits[i], tallies[chunk]);
  });
  Tally total;
  for (const Tally& tally : tallies) total.add(tally);
  return total;
}

Tally Lab::cast_and_judge(const world::Scene& scene, std::span<const Ray> rays) const {
  return judge(scene, rays, cast(scene, rays));
}

void Lab::expect_at_most(const std::string& what, double bound, double figure) const {
  std::printf("row %02d | %-58s | bound %-9.4g | %.4g\n", row_, what.c_str(), bound, figure);
  figures().rows.push_back({row_, what, bound, figure});
  // This form of the comparison fails for NaN.
  EXPECT_TRUE(figure <= bound) << "row " << row_ << ", " << what << ": " << figure << " is beyond " << bound;
}

void Lab::note(const std::string& what, double figure) const {
  std::printf("row %02d | %-58s |                 | %.4g\n", row_, what.c_str(), figure);
  figures().rows.push_back({row_, what, std::nullopt, figure});
}

void Lab::credit(const std::string& primitive, const Tally& tally, uint64_t leaks) {
  PrimitiveFigures& entry = figures().primitives[primitive];
  entry.tally.add(tally);
  entry.leaks += leaks;
}

std::vector<layout::HitRecord> Lab::cast_packed(const PackedScene& packed, FeatureMask features,
                                                std::span<const Ray> rays, double* time_ms) const {
  RayKernelOptions options;
  options.spirv = cast_kernel();
  options.features = features;
  // Without boxes a ray takes so long that a dispatch of the usual length would hold few rays and mostly wait.
  options.target_dispatch_ms = 250.0;
  RayKernel kernel(device_, upload_scene(device_, packed), options);
  std::vector<layout::RayRecord> requests;
  requests.reserve(rays.size());
  for (const Ray& ray : rays) requests.push_back({vec4(ray.origin, ray.tmin), vec4(ray.direction, ray.tmax)});
  std::vector<layout::HitRecord> records(rays.size());
  const double elapsed = kernel.run(requests, records);
  if (time_ms != nullptr) *time_ms = elapsed;
  return records;
}

std::span<const uint32_t> Lab::cast_kernel() {
  static const std::vector<uint32_t> kKernel = load_kernel("cast.spv", cast_spirv());
  return kKernel;
}

std::span<const uint32_t> Lab::bounce_kernel() {
  static const std::vector<uint32_t> kKernel = load_kernel("bounce.spv", k_bounce_spirv);
  return kKernel;
}

std::ostream& operator<<(std::ostream& out, const HardCase& hard_case) {
  return out << "row " << hard_case.row << ", " << hard_case.name;
}

std::string label(const char* what, double value) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%s %.4g", what, value);
  return text.data();
}

PackedScene with_infinite_boxes(PackedScene packed) {
  // The boxes start at -2^127 and have 255 steps of 2^120 on every axis.
  const uint32_t origin = std::bit_cast<uint32_t>(-0x1p127F);
  for (layout::Node& node : packed.nodes) {
    node.frame = uvec4(origin, origin, origin, (node.frame.w & 0xFF000000) | 0xF7F7F7);
    node.lo = uvec4(0, 0, 0, 0xFFFFFFFF);
    node.hi = uvec4(0xFFFFFFFF, 0xFFFFFFFF, 0, 0);
  }
  return packed;
}

uint64_t count_differences(std::span<const layout::HitRecord> a, std::span<const layout::HitRecord> b) {
  uint64_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += a[i].a.x != b[i].a.x || a[i].a.y != b[i].a.y ? 1 : 0;
  return count;
}

Ray ray_grazing(const Mesh& mesh, const uvec3& triangle, Random& random) {
  const dvec3 a(mesh.positions[triangle.x]);
  const dvec3 b(mesh.positions[triangle.y]);
  const dvec3 c(mesh.positions[triangle.z]);
  const dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
  const dvec3 target = random.inside(a, b, c);
  const dvec3 along = glm::normalize(random.inside(a, b, c) - target);
  const double side = random.uniform() < 0.5 ? 1.0 : -1.0;
  const double cosine = side * std::pow(10.0, random.uniform(-9.0, -5.5));
  const double distance = std::pow(10.0, random.uniform(-0.3, 1.5));
  return ray_towards(target - distance * glm::normalize(along + cosine * normal), target);
}

}  // namespace promin::hard
