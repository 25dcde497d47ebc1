// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "device/buffer.h"
#include "device/pipeline.h"
#include "device_scene/pack_emitters.h"
#include "device_scene/pack_instances.h"
#include "device_scene/pack_scene.h"
#include "device_scene/pack_shading.h"
#include "device_scene/scene_constants.h"
#include "environment/pack_sky.h"

namespace promin {

/// The parts of a scene that can be replaced separately.
struct ShadingParts {
  std::span<const Material> materials;
  /// Textures, which are never replaced. Their images are not replaced either.
  std::span<const Texture> textures;
  std::span<const Light> lights;
  Environment environment;
  /// Solids of glass; null if no view needs this data.
  std::shared_ptr<const GlassSolids> glass_solids = nullptr;
};

/// A scene in device memory. Tree, primitives and surfaces are permanent, except for the upper level of a tree with
/// instances; it, materials, lights and environment can be replaced. The object keeps no reference to the PackedScene.
class DeviceScene {
 public:
  /// Uploads the scene. Scenes for casts need no shading data. Throws vk::SystemError, and RunError if a device limit
  /// is exceeded.
  DeviceScene(const gpu::Device& device, const PackedScene& packed, const ShadingParts& shading = {});

  // The device must not read the scene while a setter runs. If a setter needs more space, it replaces the buffer of
  // shading data, which the caller must then bind again (Film::bind_scene).
  void set_materials(std::span<const Material> materials);
  void set_lights(std::span<const Light> lights);
  void set_environment(const Environment& environment);
  /// Returns whether set_geometry() can replace the geometry by that of another pose: it has as many primitives, no
  /// instances, and at most as many vertices as there is space for.
  bool has_space_for(const PackedScene& packed) const;
  /// Replaces the geometry, for which there is space, and the shading. Images and textures stay. The packed scene gets
  /// vertices that nothing uses, so that it has as many as there is space for.
  void set_geometry(PackedScene& packed, const ShadingParts& shading);
  /// Returns the records of the instances (UpperLevel::put_records).
  UnsetVector<layout::Node> read_records() const;
  /// Replaces the upper level after instances have moved, and the shading; null keeps it. Textures stay.
  void set_upper_level(const UpperLevel& level, const UpperNodes& upper, const ShadingParts* shading = nullptr);
  void set_glass_solids(std::shared_ptr<const GlassSolids> solids) { constants_.glass_solids = std::move(solids); }

  /// Returns the constants of pictures and casts that depend on the scene.
  const SceneConstants& constants() const { return constants_; }
  /// Returns the index in Scene::lights, or the constant of ExplainedSource, of each source of light of an integrator.
  std::span<const uint32_t> source_numbers(Integrator integrator) const;
  /// Returns the features that the sources of Integrator::kDirect need, without those of lights and sky.
  FeatureMask source_features() const { return source_features_; }
  /// Returns whether a light that is on has a size.
  bool has_light_with_size() const;
  /// Returns whether each sample of Integrator::kDirect asks one of many sources (kMostAskedSources).
  bool are_lights_chosen() const { return are_lights_chosen_; }
  /// Returns whether instances have too many emissive triangles to be sources (EmissiveSurfaces).
  bool leaves_out_emitters() const { return emissive_.leaves_out_instances; }
  uint32_t stack_size() const { return stack_size_; }
  /// Returns a number that changes whenever kernels must be bound to the scene again: because a buffer is another one,
  /// the stack has grown, or there are more or fewer sources of light.
  uint64_t version() const { return version_; }
  /// Returns whether the tree has more solids than triangles.
  bool is_mostly_solids() const { return is_mostly_solids_; }
  /// Returns the size of the scene in device memory.
  uint64_t size_bytes() const;

  /// Returns the buffers that traversal reads: nodes and primitives, each as a storage buffer and as texels.
  std::vector<gpu::BoundBuffer> geometry() const;
  /// Returns whether shaders read the whole scene as texels (DeviceProfile::most_texel_bytes); it is the value of
  /// CONSTANT_FETCHES_TEXELS.
  bool fetches_texels() const { return fetches_texels_; }
  /// Returns the buffers that shading reads, each as a storage buffer and as texels.
  std::vector<gpu::BoundBuffer> shading() const;

  /// The number of bytes copied to the device so far: for geometry and surfaces, for the upper level after moves, and
  /// for everything else. Tests use it to check the cost of a change.
  struct Uploads {
    uint64_t geometry = 0;
    uint64_t moves = 0;
    uint64_t shading = 0;

    Uploads operator+(const Uploads& other) const {
      return {geometry + other.geometry, moves + other.moves, shading + other.shading};
    }
  };
  const Uploads& uploads() const { return uploads_; }

 private:
  /// Stores the environment's colours without its sky, and whether the sky is visible.
  void take_colors(const Environment& environment);
  /// The records at the head of the buffer of shading data, which belong to the geometry.
  struct PlacedHead;
  static PlacedHead place_head(const PackedSurfaces& surfaces);
  /// Takes the constants of a tree and of the primitives beside it.
  void take_tree(const PackedScene& packed);
  /// Sets whether shaders read the whole scene as texels.
  void choose_texels();
  /// Ensures that the buffer of nodes has this number of nodes, of which the first `kept` stay.
  void reserve_nodes(uint64_t count, uint64_t kept);
  /// Ensures that kernels have a stack of this number of entries.
  void reserve_stack(uint32_t entries);
  gpu::Buffer make_shading_buffer(uint64_t tail_end) const;
  void take_shading_buffer(gpu::Buffer buffer);
  /// The replaceable parts, which lie behind the surfaces.
  struct Tail {
    // All parts except the lights are shared with earlier tails until they change.
    std::shared_ptr<const PackedMaterials> materials = std::make_shared<const PackedMaterials>();
    /// The tables of lobes and of sheens, each only if a material uses it.
    std::shared_ptr<const std::vector<uvec4>> lobe_tables = std::make_shared<const std::vector<uvec4>>();
    std::shared_ptr<const PackedSky> sky = std::make_shared<const PackedSky>();
    PackedLights lights;
  };
  /// The positions of a tail's parts in the buffer.
  struct PlacedTail;
  PlacedTail place_tail(const Tail& tail) const;
  PackedMaterials pack_materials(std::span<const Material> materials) const;
  /// Replaces the sources of Integrator::kDirect that are no lights.
  void put_direct_sources(Tail& tail, const Environment& environment);
  /// Finds the emissive surfaces of the current materials.
  void find_emissive(const EmitterGeometry& geometry);
  /// Does the same in the geometry on the device.
  void find_emissive_again();
  /// The parts to replace; absent parts stay.
  struct NewParts {
    std::optional<std::span<const Material>> materials = std::nullopt;
    std::optional<std::span<const Light>> lights = std::nullopt;
    const Environment* environment = nullptr;
    /// The geometry if it is another one.
    const EmitterGeometry* geometry = nullptr;
    bool have_instances_moved = false;
  };
  static NewParts parts_of(const ShadingParts& shading);
  /// Replaces parts, finds the sources of light again, and writes the tail once.
  void replace(const NewParts& parts);
  std::shared_ptr<const std::vector<uvec4>> lobe_tables_for(std::span<const Material> materials) const;
  /// Copies the changed parts of the tail to the device, or the whole tail to a larger buffer if needed. If this buffer
  /// cannot be created, nothing changes.
  void write_tail(Tail tail);

  const gpu::Device* device_;
  gpu::Buffer nodes_;
  gpu::Buffer primitives_;
  vk::raii::BufferView node_texels_;
  vk::raii::BufferView primitive_texels_;
  /// Size in bytes of surfaces and vertices, which are at the head of the buffer of shading data.
  uint64_t head_bytes_ = 0;
  /// The sizes in bytes of the records at the head.
  std::array<uint64_t, 5> head_sizes_{};
  std::optional<gpu::Buffer> shading_;
  vk::raii::BufferView shading_texels_{nullptr};
  /// The offset of the images' words in the buffer, and a view of these words.
  vk::DeviceSize image_words_offset_ = 0;
  vk::DeviceSize image_words_bytes_ = 0;
  vk::raii::BufferView image_texels_{nullptr};
  std::vector<Texture> textures_;
  std::vector<PlacedImage> images_;
  Tail tail_;
  /// The current environment, lights and materials.
  Environment environment_;
  std::vector<Light> lights_;
  std::vector<Material> materials_;
  EmitterRanges emitter_ranges_;
  EmissionMaps emission_maps_;
  /// The number of vertices with texture coordinates.
  size_t uv_count_ = 0;
  EmissiveSurfaces emissive_;
  FeatureMask source_features_;
  bool are_lights_chosen_ = false;
  SceneConstants constants_;
  uint32_t stack_size_;
  uint64_t version_ = 0;
  bool is_mostly_solids_;
  bool fetches_texels_ = false;
  Uploads uploads_;
};

/// Copies a packed scene to the device. Throws RunError if memory runs out or a device limit is exceeded.
std::shared_ptr<DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed,
                                          const ShadingParts& shading = {});

}  // namespace promin
