// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bvh/builder.h"
#include "bvh/bvh_file.h"
#include "core/unset_vector.h"
#include "layout.h"
#include "promin/scene.h"

namespace promin {

/// One of the parts that a triangle is packed as (device_scene/cut_triangles.h).
struct PackedPart {
  uint32_t order = 0;
  /// Parts up to this one, of all triangles, that are not their triangle's first.
  uint32_t further_parts = 0;
  /// The weights of the triangle's second and third corner at the part's three.
  std::array<vec2, 3> weights{};
};

/// What the numbers in Primitive::c.y stand for: they count primitives in (object, primitive) order.
struct PrimitiveNumbers {
  /// Of each object the number of its first primitive; then the number of all.
  std::vector<uint32_t> first_order;
  /// Of all triangles in more than one part, by their order.
  std::vector<PackedPart> parts;
};

/// A scene in the layout of shaders/layout.h, ready to be copied to the device. Vulkan-free.
struct PackedScene {
  /// At least one; none where a file has them.
  UnsetVector<layout::Node> nodes;
  /// Null where the tree was built.
  std::shared_ptr<const BvhFile> file;
  /// As TreeView::references.
  UnsetVector<uint32_t> references;
  /// Those of the tree in leaf order, then the planes; at least one.
  UnsetVector<layout::Primitive> primitives;
  /// Surfaces, materials, lights, vertex normals and vertex colours.
  std::vector<std::byte> shading;
  /// What a picture's constants take from the scene; the camera's and the picture's parts are left at zero.
  layout::Frame frame{};
  layout::Dispatch dispatch{};
  PrimitiveNumbers numbers;
  /// Entries that the traversal stack needs.
  uint32_t stack_size = 1;
  /// What the tree is over: everything but planes and degenerate triangles.
  uint32_t solid_count = 0;
  /// Of the solids' shapes in their order, all that the tree depends on.
  uint64_t geometry_hash = 0;
  BvhStats bvh;
  /// Time of the builder alone, or of reading and checking the file.
  double bvh_ms = 0.0;

  /// The tree, wherever its nodes lie; lives as long as this.
  TreeView tree() const;
  uint64_t size_bytes() const {
    return tree().nodes.size_bytes() + std::as_bytes(std::span(primitives)).size() + shading.size();
  }
};

/// Packs a checked scene. Throws UsageError for an unknown builder and RunError where counts pass what the layout can
/// hold (2^27 primitives, 2^24 - 1 nodes).
PackedScene pack_scene(const Scene& scene, std::string_view builder, const BuildOptions& options = {});

/// Packs a checked scene with the tree of a file. Throws InputError for a file that is bad or not the scene's, and
/// RunError as above.
PackedScene pack_scene_with(const std::filesystem::path& bvh_file, const Scene& scene);

/// What a primitive's number stands for.
struct PrimitiveId {
  uint32_t object = 0;
  uint32_t primitive = 0;
};
PrimitiveId primitive_of_order(const PrimitiveNumbers& numbers, uint32_t order);

/// From the weights of what was packed under a number to those of the triangle.
vec2 weights_of_triangle(const PrimitiveNumbers& numbers, uint32_t order, const vec2& weights);

/// The device's form of a binary tree: nodes of up to four children whose boxes, in bytes, hold those of the binary
/// tree; and the entries that the stack of a traversal takes at most.
struct PackedTree {
  UnsetVector<layout::Node> nodes;
  uint32_t stack_size = 1;
};
PackedTree pack_tree(const Bvh& bvh);

}  // namespace promin
