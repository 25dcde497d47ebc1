// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "bvh/builder.h"

#include <algorithm>
#include <array>
#include <limits>

#include "bvh/builders.h"
#include "core/suggest.h"
#include "promin/error.h"

namespace promin {
namespace {

struct Builder {
  std::string_view name;
  Bvh (*build)(const BuildInput&, const BuildOptions&);
};

// The builders. A new builder is a new row; the first row is the default.
constexpr std::array kBuilders = {Builder{"sah", build_sah}, Builder{"median", build_median},
                                  Builder{"spatial", build_spatial}};

constexpr auto kNames = [] {
  std::array<std::string_view, kBuilders.size()> names;
  std::transform(kBuilders.begin(), kBuilders.end(), names.begin(), [](const Builder& entry) { return entry.name; });
  return names;
}();

}  // namespace

std::span<const std::string_view> builder_names() {
  return kNames;
}

Bvh build_bvh(std::string_view builder, const BuildInput& input, const BuildOptions& options) {
  const auto found = std::find_if(kBuilders.begin(), kBuilders.end(),
                                  [builder](const Builder& entry) { return entry.name == builder; });
  if (found == kBuilders.end()) {
    throw UsageError({"bvh.builder.unknown", "there is no BVH builder \"" + std::string(builder) + "\"", "",
                      suggest_name(builder, kNames)});
  }
  if (input.boxes.size() > std::numeric_limits<uint32_t>::max() / kMaxReferencesPerPrimitive) {
    throw InputError({"bvh.primitives.many",
                      "the scene has too many primitives for one BVH: " + std::to_string(input.boxes.size()), "",
                      "split the scene"});
  }
  if (input.boxes.empty()) return {};
  return found->build(input, options);
}

BvhStats measure_bvh(std::string_view builder, const Bvh& bvh) {
  BvhStats stats{.builder = std::string(builder), .nodes = bvh.nodes.size()};
  if (bvh.nodes.empty()) return stats;
  // If the root has no area (points, a line), a ray that hits the root hits all nodes.
  const double root_area = bvh.nodes.front().bounds.half_area();
  std::vector<uint32_t> depths(bvh.nodes.size(), 1);
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const BvhNode& node = bvh.nodes[i];
    const double probability = root_area > 0.0 ? node.bounds.half_area() / root_area : 1.0;
    stats.depth = std::max(stats.depth, depths[i]);
    if (node.count > 0) {
      stats.leaves += 1;
      stats.max_leaf_size = std::max(stats.max_leaf_size, node.count);
      stats.sah_cost += probability * kTestCost * node.count;
    } else {
      depths[node.first] = depths[node.first + 1] = depths[i] + 1;
      stats.sah_cost += probability * kNodeCost;
    }
  }
  return stats;
}

}  // namespace promin
