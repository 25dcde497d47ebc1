// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The intersections alone: no tree, no boxes, each ray against every primitive (tools/plain/every_primitive).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "device/device.h"
#include "fp64_tests.spv.h"
#include "measure/samples.h"
#include "promin_tests.spv.h"
#include "recentred_tests.spv.h"
#include "reporting/accuracy.h"
#include "reporting/aimed_rays.h"
#include "textbook_tests.spv.h"
#include "trace/ray_kernel.h"

namespace promin::report {
namespace {

struct Method {
  std::string name;
  /// What it does, for people, where it differs between triangles, boxes and the rest.
  std::string of_quadrics;
  std::string of_triangles;
  std::string of_boxes;
  std::span<const uint32_t> spirv;
  bool is_shipped = false;
};

std::vector<Method> methods_for(const gpu::Device& device) {
  // The shipped one first: times are told over its own.
  std::vector<Method> methods = {
      {"promin", "around the closest approach, corrected once", "Woop, Benthin, Wald",
       "three slabs in the box's frame, from the closest approach", k_promin_tests_spirv, true},
      {"textbook", "quadratic of the textbook", "Möller and Trumbore", "three slabs in the box's frame",
       k_textbook_tests_spirv},
      {"recentred", "the same from the closest approach", "Möller and Trumbore from the closest approach",
       "the textbook's slabs from the closest approach", k_recentred_tests_spirv}};
  if (device.has_enabled(gpu::OptionalFeature::kFloat64)) {
    methods.push_back({"fp64", "quadratic of the textbook in double", "Möller and Trumbore in double",
                       "the textbook's slabs in double", k_fp64_tests_spirv});
  }
  return methods;
}

/// A method's kernel over one scene.
RayKernel make_kernel(const gpu::Device& device, const world::Scene& scene, const Method& method) {
  RayKernelOptions options;
  options.spirv = method.spirv;
  options.features = features_of(scene).without(layout::FEATURE_SMOOTH_NORMALS | layout::FEATURE_VERTEX_COLORS);
  return RayKernel(device, upload_scene(device, pack_scene(scene, "median")), options);
}

/// Where rays come from, and how far from the world's origin all lies.
struct Place {
  std::string variable;
  double value = 0.0;
  double distance = 10.0;
  double offset = 0.0;
};

std::vector<Place> list_places(const Session& session) {
  const double step = session.pick(1.0, 2.0);
  std::vector<Place> places;
  for (double exponent = 0.5; exponent <= 6.0; exponent += 0.5 * step) {
    const double distance = std::pow(10.0, exponent);
    places.push_back({"distance", distance, distance, 0.0});
  }
  places.push_back({"offset", 0.0, 10.0, 0.0});
  for (double exponent = 1.0; exponent <= 7.0; exponent += step) {
    const double offset = std::pow(10.0, exponent);
    places.push_back({"offset", offset, 10.0, offset});
  }
  return places;
}

class KernelBench {
 public:
  explicit KernelBench(const Session& session)
      : session_(session), device_(session.device()), methods_(methods_for(device_)) {}

  Json run() {
    for (const std::string& name : primitive_names()) {
      session_.say("kernels: " + name);
      const std::vector<Accuracy> totals = measure_range(name);
      const std::vector<std::vector<double>> times = measure_speed(name);
      const std::vector<uint64_t> leaks = count_leaks(name);
      for (size_t i = 0; i < methods_.size(); ++i) {
        const Method& method = methods_[i];
        Json row = {{"id", name + "/" + method.name},
                    {"scene", "generated, seeds 1 to 3"},
                    {"primitive", name},
                    {"method", method.name},
                    {"what", name == "triangle" ? method.of_triangles
                             : name == "plane"  ? plane_method(method.name)
                             : name == "box"    ? method.of_boxes
                                                : method.of_quadrics},
                    {"is_shipped", method.is_shipped},
                    {"ns_per_test", times[i]},
                    {"time_ratio", measure::ratios_of(times[i], times[0])}};
        put_accuracy(row, totals[i]);
        if (leak_rays_ > 0) {
          row["leak_rays"] = leak_rays_;
          row["leaks"] = leaks[i];
        }
        rows_.push_back(std::move(row));
      }
    }
    return {{"distance_of_offsets", 10.0}, {"rows", std::move(rows_)}, {"range", std::move(range_)}};
  }

 private:
  static std::string plane_method(const std::string& method) {
    if (method == "promin") return "n.(q - o) / (n.d)";
    if (method == "recentred") return "the same from the closest approach";
    return method == "fp64" ? "(D - n.o) / (n.d) in double" : "(D - n.o) / (n.d)";
  }

  /// K over distance and offset; returns each method's over all of it.
  std::vector<Accuracy> measure_range(const std::string& name) {
    constexpr int kScenes = 4;
    const size_t ray_count = session_.pick<size_t>(5000, 500);
    std::vector<Accuracy> totals(methods_.size());
    Random random(1);
    for (const Place& place : list_places(session_)) {
      std::vector<Accuracy> here(methods_.size());
      for (int i = 0; i < kScenes; ++i) {
        const dvec3 center = place.offset * dvec3(0.6, -0.64, 0.48);
        const world::Scene scene = make_primitive(name, center, random);
        const std::vector<Ray> rays = aim_rays(scene, dvec3(vec3(center)), place.distance, ray_count, random);
        const std::vector<layout::RayRecord> requests = make_requests(rays);
        std::vector<layout::HitRecord> records(rays.size());
        for (size_t m = 0; m < methods_.size(); ++m) {
          make_kernel(device_, scene, methods_[m]).run(requests, records);
          here[m].add(judge_records(scene, rays, records));
        }
      }
      for (size_t m = 0; m < methods_.size(); ++m) {
        totals[m].add(here[m]);
        Json row = {{"id", fmt::format("{}/{}/{}/{:.3g}", name, methods_[m].name, place.variable, place.value)},
                    {"primitive", name},
                    {"method", methods_[m].name},
                    {"is_shipped", methods_[m].is_shipped},
                    {"variable", place.variable},
                    {"value", place.value}};
        put_accuracy(row, here[m]);
        range_.push_back(std::move(row));
      }
    }
    return totals;
  }

  /// Nanoseconds a test of each method, run by run.
  std::vector<std::vector<double>> measure_speed(const std::string& name) const {
    constexpr size_t kPrimitives = 64;
    /// Long beside the start of a dispatch.
    constexpr double kLeastMs = 20.0;
    Random random(2);
    const world::Scene scene = make_primitives(name, kPrimitives, random);
    std::vector<RayKernel> kernels;
    for (const Method& method : methods_) kernels.push_back(make_kernel(device_, scene, method));
    size_t count = size_t{1} << 14;
    std::vector<layout::RayRecord> requests = make_requests(make_chords(count, random));
    std::vector<layout::HitRecord> records(count);
    while (kernels.front().run(requests, records) < kLeastMs && count < RayKernel::kMaxRays) {
      count *= 2;
      requests = make_requests(make_chords(count, random));
      records.resize(count);
    }
    std::vector<std::function<double()>> contestants;
    for (RayKernel& kernel : kernels) contestants.emplace_back([&] { return kernel.run(requests, records); });
    std::vector<std::vector<double>> times = measure::time_in_turns(contestants, session_.runs());
    for (std::vector<double>& of_method : times) {
      for (double& time : of_method) time *= 1e6 / static_cast<double>(count * kPrimitives);
    }
    return times;
  }

  /// Rays from inside of a closed surface that find no way out, of each method.
  std::vector<uint64_t> count_leaks(const std::string& name) {
    Random random(3);
    const Enclosure enclosure = make_enclosure(name, session_.pick<size_t>(40000, 4000), random);
    leak_rays_ = enclosure.rays.size();
    std::vector<uint64_t> leaks(methods_.size());
    if (leak_rays_ == 0) return leaks;
    const std::vector<layout::RayRecord> requests = make_requests(enclosure.rays);
    std::vector<layout::HitRecord> records(leak_rays_);
    for (size_t m = 0; m < methods_.size(); ++m) {
      make_kernel(device_, enclosure.scene, methods_[m]).run(requests, records);
      leaks[m] = static_cast<uint64_t>(std::count_if(
          records.begin(), records.end(), [](const layout::HitRecord& r) { return r.a.y == layout::NO_ORDER; }));
    }
    return leaks;
  }

  const Session& session_;
  const gpu::Device& device_;
  std::vector<Method> methods_;
  size_t leak_rays_ = 0;
  Json rows_ = Json::array();
  Json range_ = Json::array();
};

}  // namespace

Json measure_kernels(const Session& session) {
  return KernelBench(session).run();
}

}  // namespace promin::report
