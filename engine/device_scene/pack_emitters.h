// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "device_scene/pack_scene.h"
#include "device_scene/pack_shading.h"
#include "promin/materials.h"
#include "promin/textures.h"
#include "textures/emission_map.h"
#include "textures/pack_images.h"

// Surfaces that emit light as sources, and the choice of one of many sources (docs/model.md, "Surfaces that emit
// light").
namespace promin {

/// A part of a primitive whose material may emit light: of a triangle, a sphere, or a face of another shape. With
/// EmissiveSurfaces::are_rectangles, rectangles take the place of triangles.
struct EmissiveSurface {
  /// Index of the primitive on the device; of a rectangle, its first triangle.
  uint32_t primitive = 0;
  /// Hit::part of its points.
  uint32_t part = 0;
  /// The number of the primitive in the scene, in (object, primitive) order.
  uint32_t order = 0;
  uint32_t object = 0;
  uint32_t material = 0;
  /// The number of the first triangle's corner at which two sides of a rectangle meet.
  uint32_t corner = 0;
  /// The area in the world.
  double area = 0.0;
  /// The mean of the emission's texture on the triangle; 1 without a texture.
  vec3 texel{1.0F};
};

/// The maps of the images that textures of emission use, by image; null for all other images.
using EmissionMaps = std::vector<std::unique_ptr<const EmissionMap>>;
EmissionMaps make_emission_maps(const PackedImages& images, std::span<const Texture> textures,
                                std::span<const Material> materials);

/// The geometry in which emissive surfaces are searched, as on the device.
struct EmitterGeometry {
  std::span<const layout::Primitive> primitives;
  std::span<const layout::SurfaceRecord> surfaces;
  /// The records of the instances (UpperLevel::put_records).
  std::span<const layout::Node> records;
  /// Texture coordinates of vertices.
  std::span<const vec4> uvs;
};

/// The textures of emission. A triangle whose image has no map counts as if its texture were white.
struct EmissionTextures {
  std::span<const Texture> textures;
  const EmissionMaps& maps;
};

/// The parts of the geometry and the numbers of its objects.
struct EmitterRanges {
  /// The number of primitives of the tree that belong to no mesh of instances. They come first.
  uint32_t own_count = 0;
  /// In the order of their roots.
  std::vector<MeshRange> meshes;
  uint32_t first_instance = 0;
  uint32_t instance_count = 0;
  /// The number of each object's first primitive; then the number of all primitives.
  std::vector<uint32_t> first_order;

  explicit EmitterRanges(const PackedScene& packed);
};

/// The largest number of emissive triangles of instances that are sources. Each takes about 100 bytes.
inline constexpr uint64_t kMostInstancedEmitters = uint64_t{1} << 22;

/// The primitives whose materials emit light, sorted by order. They do not depend on the tree.
struct EmissiveSurfaces {
  std::vector<EmissiveSurface> surfaces;
  /// True if instances have more than kMostInstancedEmitters emissive triangles. None of these is in `surfaces`.
  bool leaves_out_instances = false;
  /// True if the triangles form rectangles, each of two triangles that follow one another in a mesh. `surfaces` then
  /// has the rectangles instead.
  bool are_rectangles = false;
  /// The middle of each surface that is a rectangle, and two sides that are right-handed with the normal. Shapes have
  /// sides of length 0. Empty without rectangles.
  struct Rectangle {
    dvec3 middle{0.0};
    std::array<dvec3, 2> sides{};
  };
  std::vector<Rectangle> rectangles;
};
EmissiveSurfaces find_emissive_surfaces(const EmitterGeometry& geometry, const EmitterRanges& ranges,
                                        std::span<const Material> materials, const EmissionTextures& textures);

/// The largest number of sources that are asked one by one with Integrator::kDirect. If there are more, each sample
/// asks one of them.
inline constexpr uint32_t kMostAskedSources = 16;

/// The sources of Integrator::kDirect, without the environment.
struct DirectSources {
  /// Records of the kind LIGHT_EMITTERS. position.w of each is set; kind.w is the first texel in `table`.
  std::vector<layout::LightRecord> records;
  std::vector<glm::uvec4> table;
  /// True if the lights are elements of a table; otherwise they are sources of their own.
  bool are_lights_chosen = false;
  /// True if they would be if all lights were on.
  bool may_choose_lights = false;
  bool has_surfaces = false;
  /// True if each object with such surfaces is one rectangle, which its record has instead of a table.
  bool are_rectangles = false;
};

/// Returns the sources for surfaces that emit light. If there are too many sources, all lights become elements of one
/// table. `scene_radius` is the size of the region in which lights without a position shine.
DirectSources pack_direct_sources(std::span<const Light> lights, const EmissiveSurfaces& emissive,
                                  std::span<const Material> materials, float scene_radius);

/// Returns the elements' ranges for these weights, which are positive: the first number in 0...2^32 - 1 of each, and
/// 2^32 at the end. The chances are those of the weights, except that a share of kEvenShare is distributed evenly, so
/// that each of up to 2^26 elements has at least one number.
std::vector<uint64_t> share_numbers(std::span<const double> weights);
inline constexpr double kEvenShare = 1.0 / 64.0;

}  // namespace promin
