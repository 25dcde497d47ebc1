// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "core/stopwatch.h"
#include "device/device.h"
#include "device_scene/pack_emitters.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

PackedScene pack(const SceneToPack& scene, const TunedRendererOptions& options) {
  PackedScene packed = pack_scene_by(options, scene, options.texture_bytes);
  return options.repack ? options.repack(std::move(packed)) : std::move(packed);
}

ShadingParts shading_of(const world::Scene& scene) {
  return {scene.materials, scene.textures, scene.lights, scene.environment, std::make_shared<const GlassSolids>(scene)};
}

/// Adds space for some more vertices. Turned normals take vertices of their own (scene/turned_normals.h), so other
/// poses may have more.
void add_spare_vertices(VertexRecords& vertices) {
  constexpr size_t kShare = 16;
  for (std::vector<vec4>* records : {&vertices.normals, &vertices.colors, &vertices.uvs, &vertices.tangents}) {
    if (!records->empty()) records->resize(records->size() + records->size() / kShare + kShare);
  }
}

}  // namespace

SceneOnDevice::SceneOnDevice(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options,
                             SetupStats& stats)
    : more_features_(options.more_features), images_(scene->images), textures_(scene->textures) {
  const ShadingParts shading = shading_of(*scene);
  take_objects(*scene);
  PackedScene packed = pack(scene, options);
  scene.free_geometry();
  upload(device, *scene, packed, shading, stats);
  take(packed, stats);
  take_shading(*scene);
}

void SceneOnDevice::take_shading(const world::Scene& scene) {
  material_features_ = promin::material_features(scene.materials, shown_materials_);
  light_features_ = promin::light_features(scene.lights);
  environment_features_ = promin::environment_features(scene.environment);
}

void SceneOnDevice::upload(const gpu::Device& device, const world::Scene& scene, const PackedScene& packed,
                           const ShadingParts& shading, SetupStats& stats) {
  const Stopwatch uploading;
  device_scene_ = upload_scene(device, packed, shading);
  stats.upload_ms = uploading.ms();
  stats.warnings = packed.warnings;
  if (packed.surfaces.images.warning) stats.warnings.push_back(*packed.surfaces.images.warning);
  if (device_scene_->leaves_out_emitters()) {
    stats.warnings.push_back(
        {"scene.emitters.many",
         "instances have more than " + std::to_string(kMostInstancedEmitters) + " triangles that emit light",
         scene.file.string(), "they light no other surfaces"});
  }
  mask_cutoffs_ = packed.mask_cutoffs;
}

void SceneOnDevice::take_objects(const world::Scene& scene) {
  object_materials_.resize(scene.objects.size());
  std::ranges::transform(scene.objects, object_materials_.begin(), &world::Object::material);
}

void SceneOnDevice::take(PackedScene& packed, SetupStats& stats) {
  if (packed.is_tree_built) ++trees_built_;
  stats.bvh = packed.bvh;
  stats.bvh_ms = packed.bvh_ms;
  stats.degenerate_triangles = packed.degenerate_count;
  stats.device_bytes = device_scene_->size_bytes();
  // Features stay when a pose hides an object, because other kernels would have to be compiled.
  geometry_features_ |= packed.features;
  shown_materials_.resize(packed.shown_materials.size(), false);
  for (size_t i = 0; i < shown_materials_.size(); ++i) {
    shown_materials_[i] = shown_materials_[i] || packed.shown_materials[i];
  }
  primitive_count_ = std::max(primitive_count_, packed.primitive_count());
  numbers_ = std::move(packed.numbers);
  // The device has the data of instances, of which there may be many. They are restored when they move. A copy of the
  // packed scene still needs them.
  if (packed.upper.use_count() == 1) packed.upper->forget();
  upper_ = std::move(packed.upper);
  copied_materials_ = std::move(packed.copies.materials);
}

bool SceneOnDevice::has_images_of(const world::Scene& posed, const std::vector<float>& mask_cutoffs) const {
  return posed.images == images_ && posed.textures == textures_ && mask_cutoffs == mask_cutoffs_;
}

bool SceneOnDevice::move_only(const world::Scene& posed, const ShadingParts& shading) {
  const bool may_move = copied_materials_.empty() && has_images_of(posed, find_mask_cutoffs(posed));
  return move_to_pose(posed, may_move, instanced_hash_, numbers_, upper_, *device_scene_, shading);
}

void SceneOnDevice::set_pose(const gpu::Device& device, const world::Scene& posed, const TunedRendererOptions& options,
                             TreeOfPose tree, SetupStats& stats) {
  const ShadingParts shading = shading_of(posed);
  if (posed.instances.empty() || !move_only(posed, shading)) {
    PackedScene packed = posed.instances.empty() ? pack_pose(posed, options.builder, tree, kept_tree_)
                                                 : pack_scene(posed, options.builder, {}, options.texture_bytes);
    if (options.repack) packed = options.repack(std::move(packed));
    packed.stack_size = std::max(packed.stack_size, device_scene_->stack_size());
    const Stopwatch uploading;
    if (has_images_of(posed, packed.mask_cutoffs) && device_scene_->has_space_for(packed)) {
      device_scene_->set_geometry(packed, shading);
      stats.upload_ms = uploading.ms();
    } else {
      // With instances, space has no use: every pose with other geometry uploads a new scene.
      if (posed.instances.empty()) {
        add_images(packed, posed, options.texture_bytes);
        add_spare_vertices(packed.surfaces.vertices);
      }
      earlier_uploads_ = uploads();
      upload(device, posed, packed, shading, stats);
      images_ = posed.images;
      textures_ = posed.textures;
    }
    take_objects(posed);
    take(packed, stats);
  }
  take_shading(posed);
}

FeatureMask SceneOnDevice::features_with(FeatureMask lights, FeatureMask environment, const RenderMode& mode) const {
  FeatureMask features =
      more_features_ | picture_features(geometry_features_, material_features_, lights, environment, primitive_count_);
  if (mode.integrator != Integrator::kWhitted && mode.debug_view == DebugView::kNone) {
    if (mode.integrator == Integrator::kPath) features |= layout::FEATURE_SCATTERING;
    features |= layout::FEATURE_SKY_LIGHT | layout::FEATURE_SAMPLED_LIGHT | device_scene_->source_features();
    if (casts_shadows(geometry_features_, primitive_count_)) features |= layout::FEATURE_SHADOWS;
  }
  if (mode.debug_view == DebugView::kOcclusion) {
    features |= layout::FEATURE_SAMPLED_LIGHT;
    if (casts_shadows(geometry_features_, primitive_count_)) features |= layout::FEATURE_SHADOWS;
  }
  if (!mode.has_shadows) features = features.without(layout::FEATURE_SHADOWS);
  return features | features_of(mode.debug_view);
}

void SceneOnDevice::set_lights(std::span<const Light> lights) {
  device_scene_->set_lights(lights);
  light_features_ = promin::light_features(lights);
}

void SceneOnDevice::set_materials(std::span<const Material> materials) {
  device_scene_->set_materials(materials);
  material_features_ = promin::material_features(materials, shown_materials_);
}

void SceneOnDevice::set_environment(const Environment& environment) {
  device_scene_->set_environment(environment);
  environment_features_ = promin::environment_features(environment);
}

}  // namespace promin
