// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <set>

#include "device_scene/device_scene.h"
#include "promin/renderer.h"
#include "scene/features.h"
#include "trace/film/film.h"
#include "trace/render/make_renderer.h"
#include "trace/render/move_instances.h"

// Access to the implementation of Renderer. The window needs it, because it records its own frames; tests and
// measurements need it too.
namespace promin {

/// A scene on a device and the features that its parts use, which determine the pipeline of a picture.
class SceneOnDevice {
 public:
  SceneOnDevice(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options,
                SetupStats& stats);

  const std::shared_ptr<DeviceScene>& device_scene() const { return device_scene_; }
  /// Returns the bytes copied to the device so far, also to earlier scenes.
  DeviceScene::Uploads uploads() const { return earlier_uploads_ + device_scene_->uploads(); }
  const PrimitiveNumbers& numbers() const { return numbers_; }
  /// Returns the number of trees that were built in this process and not read from a file.
  uint64_t trees_built() const { return trees_built_; }
  size_t material_count() const { return shown_materials_.size(); }
  /// Returns the materials of copies that are not in the tree (device_scene/drop_copies.h).
  const std::set<uint32_t>& copied_materials() const { return copied_materials_; }
  /// Returns the material of each object.
  std::span<const uint32_t> object_materials() const { return object_materials_; }

  /// Returns the features of a picture in a mode. The lights and the environment are the scene's, or those given.
  FeatureMask features(const RenderMode& mode) const {
    return features_with(light_features_, environment_features_, mode);
  }
  FeatureMask features_with(FeatureMask lights, FeatureMask environment, const RenderMode& mode) const;

  void set_lights(std::span<const Light> lights);
  void set_materials(std::span<const Material> materials);
  void set_environment(const Environment& environment);
  /// Replaces everything but images and textures by that of the scene in another pose, for pictures of a renderer with
  /// these options. The number of objects and of materials stays the same. The device may then have another scene.
  void set_pose(const gpu::Device& device, const world::Scene& posed, const TunedRendererOptions& options,
                TreeOfPose tree, SetupStats& stats);
  /// Calls move_instances() for this scene.
  void set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
    move_instances(world_from_object, numbers_, upper_, *device_scene_);
  }

 private:
  /// Uploads a packed scene. The tree of the scene may have been read from a file.
  void upload(const gpu::Device& device, const world::Scene& scene, const PackedScene& packed,
              const ShadingParts& shading, SetupStats& stats);
  void take_objects(const world::Scene& scene);
  /// Takes the host's data of a packed scene, and the cost of its tree.
  void take(PackedScene& packed, SetupStats& stats);
  /// Takes the features of materials, lights and environment.
  void take_shading(const world::Scene& scene);
  /// Sets the pose if only instances have moved. Returns false if anything else differs.
  bool move_only(const world::Scene& posed, const ShadingParts& shading);
  /// Returns whether images have the same levels. `mask_cutoffs` is the result of find_mask_cutoffs().
  bool has_images_of(const world::Scene& posed, const std::vector<float>& mask_cutoffs) const;

  FeatureMask more_features_;
  uint64_t trees_built_ = 0;
  /// The bytes copied to scenes that this one has replaced.
  DeviceScene::Uploads earlier_uploads_;
  FeatureMask geometry_features_;
  FeatureMask material_features_;
  FeatureMask light_features_;
  FeatureMask environment_features_;
  uint64_t primitive_count_ = 0;
  std::vector<bool> shown_materials_;
  std::set<uint32_t> copied_materials_;
  std::vector<uint32_t> object_materials_;
  PrimitiveNumbers numbers_;
  std::shared_ptr<const UpperLevel> upper_;
  /// The hash of everything but the transforms of a scene with instances (hash_instanced), if it is known.
  std::optional<uint64_t> instanced_hash_;
  /// The tree for other poses.
  KeptTree kept_tree_;
  std::vector<std::shared_ptr<const TextureImage>> images_;
  std::vector<Texture> textures_;
  std::vector<float> mask_cutoffs_;
  std::shared_ptr<DeviceScene> device_scene_;
};

}  // namespace promin
