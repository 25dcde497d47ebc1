// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bvh/builder.h"
#include "core/rounding.h"
#include "hard/hard_case.h"

namespace promin::hard {
namespace {

/// Adds an axis-aligned rectangle as two triangles. It is perpendicular to `axis`, at `low`, or at `low` + 2 size along
/// the axis if `is_high`.
void add_quad(Mesh& mesh, const dvec3& low, double size, int axis, bool is_high) {
  dvec3 right(0.0);
  dvec3 up(0.0);
  right[(axis + 1) % 3] = size;
  up[(axis + 2) % 3] = size;
  dvec3 corner = low;
  if (is_high) corner[axis] += size;
  const auto first = static_cast<uint32_t>(mesh.positions.size());
  for (const dvec3& p : {corner, corner + right, corner + right + up, corner + up}) mesh.positions.emplace_back(p);
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.triangles.emplace_back(first, first + 2, first + 3);
}

/// The lowest corner of an axis-aligned box, and the length of its edge.
struct Block {
  dvec3 low;
  double size;
};

/// Blocks on a lattice that begins at `offset`, so that sides lie in common planes. The blocks are hollow cubes of
/// quads, single quads in flat boxes, and spheres that touch the sides.
struct BlockScene {
  world::Scene scene;
  std::vector<Block> blocks;
};

BlockScene make_blocks(double offset, Random& random) {
  BlockScene result;
  std::vector<world::Shape> shapes;
  for (int i = 0; i < 48; ++i) {
    const dvec3 cell(i % 4, (i / 4) % 4, i / 16);
    // fp32 cannot represent these fractions exactly.
    const Block block{dvec3(offset, -offset, offset) + 1.7 * cell + 0.3 * random.uniform(),
                      1.0 + 0.3 * random.uniform()};
    if (i % 3 == 2) {
      // Sphere and block are computed in fp32, so that they really touch.
      const float radius = 0.5F * static_cast<float>(block.size);
      shapes.emplace_back(world::Sphere{vec3(block.low + 0.5 * block.size), radius});
    } else {
      Mesh mesh;
      for (int axis = 0; axis < 3; ++axis) {
        if (i % 3 == 1 && axis != i % 2) continue;
        add_quad(mesh, block.low, block.size, axis, false);
        if (i % 3 == 0) add_quad(mesh, block.low, block.size, axis, true);
      }
      shapes.emplace_back(std::move(mesh));
    }
    result.blocks.push_back(block);
  }
  result.scene = scene_of(std::move(shapes));
  return result;
}

/// Returns a ray towards a corner, an edge or the middle of a side, exactly or a few units in the last place beside it.
/// Every fourth ray is parallel to an edge.
Ray ray_at_block(const Block& block, double distance, Random& random, size_t index) {
  dvec3 target = block.low;
  for (int axis = 0; axis < 3; ++axis) target[axis] += block.size * std::floor(3.0 * random.uniform()) * 0.5;
  const int axis = static_cast<int>(3.0 * random.uniform()) % 3;
  if (index % 2 == 0) target[axis] = block.low[axis] + block.size * random.uniform();
  target = dvec3(vec3(target));
  if (index % 4 == 3) {
    Ray ray{vec3(target), 0.0F, vec3(0.0F), std::numeric_limits<float>::infinity()};
    const bool is_backward = random.uniform() < 0.5;
    ray.direction[axis] = is_backward ? -1.0F : 1.0F;
    ray.origin[axis] = static_cast<float>(target[axis] + (is_backward ? distance : -distance));
    return ray;
  }
  const vec3 origin(target + distance * random.direction());
  Ray ray = ray_towards(dvec3(origin), target);
  const double reach = glm::length(target - dvec3(origin)) + block.size;
  if (index % 4 == 2) {
    const double beside = 4.0 * random.uniform() * kUnitRoundoff * reach;
    ray = ray_towards(dvec3(origin), target + beside * random.direction());
  }
  return ray;
}

void run_box_edges(Lab& lab) {
  Random random(28);
  for (const double offset : {0.0, 1e3, 1e5}) {
    for (const double distance : {0.02, 1.0, 1e3}) {
      const BlockScene blocks = make_blocks(offset, random);
      std::vector<Ray> rays;
      for (size_t i = 0; i < some_of(40000); ++i) {
        rays.push_back(ray_at_block(blocks.blocks[i % blocks.blocks.size()], distance, random, i));
      }
      const PackedScene packed = pack_scene(blocks.scene, builder_names().front());
      const FeatureMask features = features_of(blocks.scene);
      const auto in_boxes = lab.cast_packed(packed, features, rays);
      const auto unboxed = lab.cast_packed(with_infinite_boxes(packed), features, rays);
      const std::string where = label(", offset", offset) + label(", distance", distance);
      const uint64_t differences = count_differences(in_boxes, unboxed);
      lab.expect_at_most("hits hidden by a box" + where, 0.0, static_cast<double>(differences));
      const auto is_hit = [](const layout::HitRecord& record) { return record.a.y != layout::NO_ORDER; };
      lab.note("share of rays that hit" + where,
               static_cast<double>(std::count_if(unboxed.begin(), unboxed.end(), is_hit)) /
                   static_cast<double>(rays.size()));
    }
  }
}

void run_axis_parallel(Lab& lab) {
  Random random(29);
  for (const double offset : {0.0, 1e3}) {
    const BlockScene blocks = make_blocks(offset, random);
    std::vector<Ray> rays;
    for (size_t i = 0; i < some_of(3000); ++i) {
      const Block& block = blocks.blocks[i % blocks.blocks.size()];
      Ray ray{vec3(0.0F), 0.0F, vec3(0.0F), std::numeric_limits<float>::infinity()};
      for (int axis = 0; axis < 3; ++axis) {
        // The plane contains a side, lies halfway between two sides, or lies elsewhere.
        const double place = i % 2 == 0 ? std::floor(3.0 * random.uniform()) * 0.5 : random.uniform(-0.5, 1.5);
        ray.origin[axis] = static_cast<float>(block.low[axis] + block.size * place);
        constexpr std::array kSteps{0.0F, 1e-39F, 1e-30F, 1.0F};
        const float step = kSteps[static_cast<size_t>(4.0 * random.uniform())];
        ray.direction[axis] = random.uniform() < 0.5 ? -step : step;
      }
      const int main_axis = static_cast<int>(i % 3);
      ray.direction[main_axis] = random.uniform() < 0.5 ? -1.0F : 1.0F;
      if (i % 4 < 2) ray.origin[main_axis] -= 5.0F * ray.direction[main_axis];
      rays.push_back(ray);
    }
    const Tally tally = lab.cast_and_judge(blocks.scene, rays);
    const std::string where = label(", offset", offset);
    lab.expect_at_most("margin of other answers / uS (B2)" + where, 2.0, tally.max_margin);
    lab.expect_at_most("K of t (B1)" + where, 8.0 * lab.rounding_factor(), tally.max_t_error);
    lab.expect_at_most("malformed hits" + where, 0.0, static_cast<double>(tally.malformed));
    lab.note("share of rays that hit" + where, static_cast<double>(tally.hits) / static_cast<double>(tally.rays));
  }
}

constexpr std::array kBoxCases{HardCase{28, "BoxEdgesAndCorners", run_box_edges},
                               HardCase{29, "AxisParallelRays", run_axis_parallel}};

}  // namespace

std::span<const HardCase> box_cases() {
  return kBoxCases;
}

}  // namespace promin::hard
