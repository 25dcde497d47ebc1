// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "device/buffer.h"
#include "device/pipeline.h"
#include "device_scene/pack_scene.h"
#include "device_scene/pack_shading.h"
#include "device_scene/scene_constants.h"
#include "environment/pack_sky.h"

namespace promin {

/// The parts of a scene that are replaced apart.
struct ShadingParts {
  std::span<const Material> materials;
  /// For good, as images are.
  std::span<const Texture> textures;
  std::span<const Light> lights;
  Environment environment;
  /// For good; none where no view needs them.
  std::shared_ptr<const GlassSolids> glass_solids = nullptr;
};

/// A scene in device memory, in parts that are replaced apart: tree, primitives and surfaces for good; materials,
/// lights and environment as often as they change. Keeps no reference to the PackedScene.
class DeviceScene {
 public:
  /// Scenes for casts need no shading. Throws vk::SystemError, and RunError where a device limit is passed.
  DeviceScene(const gpu::Device& device, const PackedScene& packed, const ShadingParts& shading = {});

  // The setters need that nothing on the device reads the scene meanwhile. Where they need more room than there is, the
  // buffer of shading is replaced: what is bound to it must be bound anew (Film::bind_scene).
  void set_materials(std::span<const Material> materials);
  void set_lights(std::span<const Light> lights);
  void set_environment(const Environment& environment);

  /// What the scene contributes to the constants of pictures and casts.
  const SceneConstants& constants() const { return constants_; }
  /// The index in Scene::lights of each light on the device.
  const std::vector<uint32_t>& light_numbers() const { return tail_.lights.numbers; }
  uint32_t stack_size() const { return stack_size_; }
  /// Whether the tree has more solids than triangles.
  bool is_mostly_solids() const { return is_mostly_solids_; }
  /// The size of all that the scene holds in device memory.
  uint64_t size_bytes() const;

  /// The buffers that traversal reads: nodes and primitives, as storage buffers and as texels.
  std::vector<gpu::BoundBuffer> geometry() const;
  /// Whether all of it is read as texels (DeviceProfile::most_texel_bytes): CONSTANT_FETCHES_TEXELS.
  bool fetches_texels() const { return fetches_texels_; }
  /// The buffers that shading reads, as storage buffers and as texels.
  std::vector<gpu::BoundBuffer> shading() const;

  /// The number of bytes copied to the device so far: geometry and surfaces, and all else. Tests count by it what a
  /// change uploads.
  struct Uploads {
    uint64_t geometry = 0;
    uint64_t shading = 0;
  };
  const Uploads& uploads() const { return uploads_; }

 private:
  /// Takes over what an environment is without its sky, and whether that is seen.
  void take_colors(const Environment& environment);
  gpu::Buffer make_shading_buffer(uint64_t tail_end) const;
  void take_shading_buffer(gpu::Buffer buffer);
  /// What is replaced apart, behind the surfaces.
  struct Tail {
    // All but the lights are shared by the tails that do not change them.
    std::shared_ptr<const PackedMaterials> materials = std::make_shared<const PackedMaterials>();
    /// That of lobes and that of sheens, each only where a material looks it up.
    std::shared_ptr<const std::vector<uvec4>> lobe_tables = std::make_shared<const std::vector<uvec4>>();
    std::shared_ptr<const PackedSky> sky = std::make_shared<const PackedSky>();
    PackedLights lights;
  };
  /// Where the parts of a tail lie.
  struct PlacedTail;
  PlacedTail place_tail(const Tail& tail) const;
  PackedMaterials pack_materials(std::span<const Material> materials) const;
  std::shared_ptr<const std::vector<uvec4>> lobe_tables_for(std::span<const Material> materials) const;
  /// Copies what of the tail is new, or all of it into a larger buffer where it needs one. Where that cannot be made
  /// nothing changes.
  void write_tail(Tail tail);

  const gpu::Device* device_;
  gpu::Buffer nodes_;
  gpu::Buffer primitives_;
  vk::raii::BufferView node_texels_;
  vk::raii::BufferView primitive_texels_;
  /// The size of surfaces and vertices, at the head of the buffer of shading.
  uint64_t head_bytes_ = 0;
  std::optional<gpu::Buffer> shading_;
  vk::raii::BufferView shading_texels_{nullptr};
  /// The words of images in it, and a view of them.
  vk::DeviceSize image_words_offset_ = 0;
  vk::DeviceSize image_words_bytes_ = 0;
  vk::raii::BufferView image_texels_{nullptr};
  std::vector<Texture> textures_;
  std::vector<PlacedImage> images_;
  Tail tail_;
  /// The last that was set.
  Environment environment_;
  SceneConstants constants_;
  uint32_t stack_size_;
  bool is_mostly_solids_;
  bool fetches_texels_ = false;
  Uploads uploads_;
};

/// Copies a packed scene to the device. Throws RunError where memory does not suffice or a device limit is passed.
std::shared_ptr<DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed,
                                          const ShadingParts& shading = {});

}  // namespace promin
