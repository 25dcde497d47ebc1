// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "core/stopwatch.h"
#include "device/device.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

PackedScene pack(const world::Scene& scene, const TunedRendererOptions& options) {
  PackedScene packed = pack_scene_by(options, scene, options.texture_bytes);
  return options.repack ? options.repack(std::move(packed)) : std::move(packed);
}

}  // namespace

SceneOnDevice::SceneOnDevice(const gpu::Device& device, const world::Scene& scene, const TunedRendererOptions& options,
                             SetupStats& stats)
    : more_features_(options.more_features) {
  for (const world::Object& object : scene.objects) object_materials_.push_back(object.material);
  PackedScene packed = pack(scene, options);
  is_tree_built_ = packed.file == nullptr;
  stats.bvh = packed.bvh;
  stats.bvh_ms = packed.bvh_ms;
  stats.degenerate_triangles = packed.degenerate_count;
  stats.warnings = packed.warnings;
  if (packed.surfaces.images.warning) stats.warnings.push_back(*packed.surfaces.images.warning);
  geometry_features_ = packed.features;
  shown_materials_ = packed.shown_materials;
  primitive_count_ = packed.primitive_count();
  material_features_ = promin::material_features(scene.materials, shown_materials_);
  light_features_ = promin::light_features(scene.lights);
  environment_features_ = promin::environment_features(scene.environment);
  const Stopwatch uploading;
  device_scene_ = upload_scene(
      device, packed,
      {scene.materials, scene.textures, scene.lights, scene.environment, std::make_shared<const GlassSolids>(scene)});
  stats.upload_ms = uploading.ms();
  stats.device_bytes = device_scene_->size_bytes();
  numbers_ = std::move(packed.numbers);
  copied_materials_ = std::move(packed.copies.materials);
}

FeatureMask SceneOnDevice::features_with(FeatureMask lights, FeatureMask environment, const RenderMode& mode) const {
  FeatureMask features =
      more_features_ | picture_features(geometry_features_, material_features_, lights, environment, primitive_count_);
  if (mode.integrator != Integrator::kWhitted && mode.debug_view == DebugView::kNone) {
    if (mode.integrator == Integrator::kPath) features |= layout::FEATURE_SCATTERING;
    features |= layout::FEATURE_SKY_LIGHT | layout::FEATURE_SAMPLED_LIGHT;
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
