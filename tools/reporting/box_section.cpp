// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// The box test alone: each ray against the boxes of every node (tools/plain/every_box).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bvh/pack_tree.h"
#include "cancelling_boxes.spv.h"
#include "device/device.h"
#include "full_boxes.spv.h"
#include "full_unpadded_boxes.spv.h"
#include "measure/samples.h"
#include "promin_boxes.spv.h"
#include "reporting/accuracy.h"
#include "reporting/aimed_rays.h"
#include "reporting/full_boxes.h"
#include "trace/ray_kernel.h"
#include "unpadded_boxes.spv.h"

namespace promin::report {
namespace {

constexpr size_t kChildren = layout::NODE_WIDTH;
using Boxes = std::array<Bounds, kChildren>;

struct Method {
  std::string name;
  std::string what;
  std::span<const uint32_t> spirv;
  bool has_full_boxes = false;
};

const std::vector<Method>& methods() {
  static const std::vector<Method> kMethods = {
      {"promin", "boxes in bytes, grown by a bound on all rounding", k_promin_boxes_spirv},
      {"unpadded", "boxes in bytes, as they are", k_unpadded_boxes_spirv},
      {"full", "boxes in fp32, grown by a bound on all rounding", k_full_boxes_spirv, true},
      {"full unpadded", "boxes in fp32, as they are", k_full_unpadded_boxes_spirv, true},
      {"full cancelling", "boxes in fp32, b * inv - o * inv", k_cancelling_boxes_spirv, true}};
  return kMethods;
}

/// Four boxes beside each other, every other one flat along an axis.
Boxes make_boxes(const dvec3& center, Random& random) {
  Boxes boxes;
  for (size_t i = 0; i < kChildren; ++i) {
    const dvec3 middle = center + 2.0 * random.direction();
    dvec3 half(0.1 + random.uniform(), 0.1 + random.uniform(), 0.1 + random.uniform());
    if (i % 2 == 1) half[static_cast<int>(3.0 * random.uniform())] = 0.0;
    boxes[i].extend(vec3(middle - half));
    boxes[i].extend(vec3(middle + half));
  }
  return boxes;
}

/// What of a scene the box test takes: its nodes and its extent.
PackedScene pack_boxes(std::span<const Boxes> nodes, bool is_full) {
  PackedScene packed;
  Bounds all;
  const uvec4 leaves(layout::CHILD_IS_LEAF);
  for (const Boxes& boxes : nodes) {
    for (const Bounds& box : boxes) all.extend(box);
    if (is_full) {
      for (const layout::Node& node : pack_full_node(boxes, leaves)) packed.nodes.push_back(node);
      continue;
    }
    // The binary tree of four leaves, which becomes one node.
    Bvh bvh;
    bvh.nodes.resize(7);
    bvh.references.resize(kChildren);
    for (uint32_t i = 0; i < kChildren; ++i) {
      bvh.nodes[3 + i] = {boxes[i], i, 1};
      bvh.references[i] = i;
    }
    const auto join = [&](uint32_t node, uint32_t first) {
      bvh.nodes[node] = {bvh.nodes[first].bounds, first, 0};
      bvh.nodes[node].bounds.extend(bvh.nodes[first + 1].bounds);
    };
    join(1, 3);
    join(2, 5);
    join(0, 1);
    packed.nodes.push_back(pack_tree(bvh).nodes[0]);
  }
  packed.primitives.resize(1);
  packed.primitives[0] = {vec4(0.0F, 0.0F, 0.0F, 1.0F), vec4(0.0F), uvec4(0, 0, layout::KIND_SPHERE, 0)};
  // Where the kernel takes the boxes to end.
  packed.references.resize(nodes.size());
  packed.surfaces.surfaces.resize(1);
  const dvec3 reach = glm::max(dvec3(all.hi) - dvec3(all.center()), dvec3(all.center()) - dvec3(all.lo));
  packed.tree_bounds =
      vec4(all.center(), std::nextafter(static_cast<float>(glm::max(reach.x, glm::max(reach.y, reach.z))), HUGE_VALF));
  return packed;
}

RayKernel make_kernel(const gpu::Device& device, const Method& method, std::span<const Boxes> nodes) {
  RayKernelOptions options;
  options.spirv = method.spirv;
  options.features = layout::FEATURE_SPHERES;
  return RayKernel(device, upload_scene(device, pack_boxes(nodes, method.has_full_boxes)), options);
}

/// A corner, a point of an edge or of a face, of a random one of the boxes.
dvec3 point_of(const Boxes& boxes, Random& random) {
  const Bounds& box = boxes[static_cast<size_t>(static_cast<double>(kChildren) * random.uniform())];
  dvec3 share(random.uniform() < 0.5 ? 0.0 : 1.0, random.uniform() < 0.5 ? 0.0 : 1.0,
              random.uniform() < 0.5 ? 0.0 : 1.0);
  const auto free_axes = static_cast<int>(3.0 * random.uniform());
  for (int i = 0; i < free_axes; ++i) share[static_cast<int>(3.0 * random.uniform())] = random.uniform();
  return dvec3(box.lo) + share * (dvec3(box.hi) - dvec3(box.lo));
}

/// Whether the exact ray meets the exact box, its sides included; by slabs in long double, without a division by 0.
bool meets(const Ray& ray, const Bounds& box) {
  long double entry = 0.0L;
  long double exit = HUGE_VALL;
  for (int axis = 0; axis < 3; ++axis) {
    const long double o = ray.origin[axis];
    const long double d = ray.direction[axis];
    const long double lo = static_cast<long double>(box.lo[axis]) - o;
    const long double hi = static_cast<long double>(box.hi[axis]) - o;
    if (d == 0.0L) {
      if (lo > 0.0L || hi < 0.0L) return false;
      continue;
    }
    entry = std::max(entry, std::min(lo / d, hi / d));
    exit = std::min(exit, std::max(lo / d, hi / d));
  }
  return entry <= exit;
}

struct Counts {
  uint64_t tests = 0;
  uint64_t met = 0;
  uint64_t missed = 0;
  uint64_t needless = 0;
};

class BoxBench {
 public:
  explicit BoxBench(const Session& session) : session_(session), device_(session.device()) {}

  Json run() const {
    session_.say("kernels: boxes");
    const std::vector<Counts> counts = count_errors();
    const std::vector<std::vector<double>> times = measure_speed();
    Json rows = Json::array();
    for (size_t i = 0; i < methods().size(); ++i) {
      const Method& method = methods()[i];
      const auto tests = static_cast<double>(counts[i].tests);
      rows.push_back({{"id", "box/" + method.name},
                      {"scene", "generated, seeds 5 and 6"},
                      {"primitive", "box"},
                      {"method", method.name},
                      {"what", method.what},
                      {"is_shipped", method.name == "promin"},
                      {"bytes_per_node", (method.has_full_boxes ? 2 : 1) * sizeof(layout::Node)},
                      {"ns_per_test", times[i]},
                      {"time_ratio", measure::ratios_of(times[i], times[0])},
                      {"rays", counts[i].tests / kChildren},
                      {"misclassified_per_million", 1e6 * static_cast<double>(counts[i].missed) / tests},
                      {"opened_needlessly_per_million", 1e6 * static_cast<double>(counts[i].needless) / tests},
                      {"leak_rays", counts[i].met},
                      {"leaks", counts[i].missed}});
    }
    return {{"rows", rows}};
  }

 private:
  std::vector<Counts> count_errors() const {
    constexpr int kScenes = 4;
    std::vector<Counts> counts(methods().size());
    Random random(5);
    const size_t ray_count = session_.pick<size_t>(20000, 2000);
    for (const double offset : {0.0, 1e3, 1e5}) {
      for (int scene = 0; scene < kScenes; ++scene) {
        const dvec3 center = offset * dvec3(0.6, -0.64, 0.48);
        const Boxes boxes = make_boxes(center, random);
        std::vector<Ray> rays;
        while (rays.size() < ray_count) {
          const vec3 origin(center + (3.0 + 20.0 * random.uniform()) * random.direction());
          rays.push_back({origin, 0.0F, vec3(point_of(boxes, random) - dvec3(origin))});
        }
        for (size_t m = 0; m < methods().size(); ++m) compare(methods()[m], boxes, rays, counts[m]);
      }
    }
    return counts;
  }

  void compare(const Method& method, const Boxes& boxes, std::span<const Ray> rays, Counts& counts) const {
    std::vector<layout::HitRecord> records(rays.size());
    make_kernel(device_, method, std::span(&boxes, 1)).run(make_requests(rays), records);
    for (size_t i = 0; i < rays.size(); ++i) {
      for (uint32_t child = 0; child < kChildren; ++child) {
        const bool is_met = meets(rays[i], boxes[child]);
        const bool is_said = ((records[i].a.z >> child) & 1U) != 0;
        ++counts.tests;
        counts.met += is_met ? 1 : 0;
        counts.missed += is_met && !is_said ? 1 : 0;
        counts.needless += is_said && !is_met ? 1 : 0;
      }
    }
  }

  /// Nanoseconds a box, run by run.
  std::vector<std::vector<double>> measure_speed() const {
    constexpr size_t kNodes = 64;
    Random random(6);
    std::vector<Boxes> nodes;
    for (size_t i = 0; i < kNodes; ++i) nodes.push_back(make_boxes(4.0 * random.direction(), random));
    const size_t count = device_.profile().measured_rays;
    const std::vector<layout::RayRecord> requests = make_requests(make_chords(count, random));
    std::vector<layout::HitRecord> records(count);
    std::vector<RayKernel> kernels;
    for (const Method& method : methods()) kernels.push_back(make_kernel(device_, method, nodes));
    std::vector<std::function<double()>> contestants;
    for (RayKernel& kernel : kernels) contestants.emplace_back([&] { return kernel.run(requests, records); });
    std::vector<std::vector<double>> times = measure::time_in_turns(contestants, session_.runs());
    for (std::vector<double>& of_method : times) {
      for (double& time : of_method) time *= 1e6 / static_cast<double>(count * kNodes * kChildren);
    }
    return times;
  }

  const Session& session_;
  const gpu::Device& device_;
};

}  // namespace

Json measure_boxes(const Session& session) {
  return BoxBench(session).run();
}

}  // namespace promin::report
