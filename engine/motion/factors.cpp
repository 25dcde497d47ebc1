// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "motion/factors.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string_view>
#include <variant>

#include "motion/angles.h"
#include "motion/attach.h"
#include "promin/validate.h"
#include "scene/texture_slots.h"

namespace promin {
namespace {

using Value = Pose::Value;

/// The largest field of view in radians, and the smallest angle and ratio of a camera.
constexpr double kMostYfov = 3.1415;
constexpr double kTiny = 1e-9;

/// Sets a factor of one or three components, each clamped to its range.
void set_factor(float& factor, const dvec4& value, double lo, double hi) {
  factor = static_cast<float>(std::clamp(value.x, lo, hi));
}
void set_factor(vec3& factor, const dvec4& value, double lo, double hi) {
  factor = vec3(glm::clamp(dvec3(value), lo, hi));
}

void apply_to_model(const Value& value, MetallicRoughness& model) {
  switch (value.property) {
#define PROMIN_MATERIAL_FACTOR(ENUMERATOR, MEMBER, COMPONENTS, MIN, MAX, POINTER) \
  case AnimatedProperty::ENUMERATOR:                                              \
    return set_factor(model.MEMBER, value.value, MIN, MAX);
#include "promin/kinds/animated.def"
    default:
      return;
  }
}

void apply_base_color(const dvec4& value, Material& material) {
  const dvec4 color = glm::clamp(value, 0.0, 1.0);
  if (auto* model = std::get_if<MetallicRoughness>(&material.model)) model->base_color = vec3(color);
  if (auto* model = std::get_if<Unlit>(&material.model)) model->color = vec3(color);
  material.alpha = static_cast<float>(color.w);
}

void apply_emission(const Value& value, MaterialLink& link, Material& material) {
  if (value.property == AnimatedProperty::kEmissive) link.emissive = dvec3(value.value);
  if (value.property == AnimatedProperty::kEmissiveStrength) link.emissive_strength = value.value.x;
  material.emissive = vec3(glm::clamp(link.emissive_strength * link.emissive, 0.0, kMaxCoordinate));
}

/// Sets the transform of a slot's texture coordinates. The rotation has the direction that the loader gives it.
void put_transform(const TextureLink& link, TextureSlot& slot) {
  constexpr double kRight = 0.5 * std::numbers::pi;
  const double sine = sine_of_any(link.rotation);
  const double cosine = sine_of_any(link.rotation + kRight);
  slot.to_u = vec3(dvec3(cosine * link.scale.x, sine * link.scale.y, link.offset.x));
  slot.to_v = vec3(dvec3(-sine * link.scale.x, cosine * link.scale.y, link.offset.y));
}

void apply_to_texture(const Value& value, MaterialLink& link, Material& material) {
  if (value.element >= link.textures.size()) return;
  TextureLink& texture = link.textures[value.element];
  const dvec4 number = glm::clamp(value.value, -kMaxCoordinate, kMaxCoordinate);
  if (value.property == AnimatedProperty::kTextureOffset) texture.offset = dvec2(number);
  if (value.property == AnimatedProperty::kTextureRotation) texture.rotation = number.x;
  if (value.property == AnimatedProperty::kTextureScale) texture.scale = dvec2(number);
  for_each_slot(material, [&](const TextureSlot& slot, std::string_view name, ImageUse /*use*/) {
    const bool is_unlit_color = name == "color_texture" && texture.slot == "base_color_texture";
    if (name != texture.slot && !is_unlit_color) return;
    // The visitor gets constant slots, because other code only reads them.
    put_transform(texture, const_cast<TextureSlot&>(slot));
  });
}

void apply_to_material(const Value& value, MaterialLink& link, Material& material) {
  switch (value.property) {
    case AnimatedProperty::kBaseColor:
      return apply_base_color(value.value, material);
    case AnimatedProperty::kEmissive:
    case AnimatedProperty::kEmissiveStrength:
      return apply_emission(value, link, material);
    case AnimatedProperty::kTextureOffset:
    case AnimatedProperty::kTextureRotation:
    case AnimatedProperty::kTextureScale:
      return apply_to_texture(value, link, material);
    case AnimatedProperty::kAlphaCutoff:
      return set_factor(material.alpha_cutoff, value.value, 0.0, kMaxCoordinate);
    default:
      if (auto* model = std::get_if<MetallicRoughness>(&material.model)) apply_to_model(value, *model);
  }
}

void apply_to_light(const Value& value, LightLink& link, Light& light) {
  switch (value.property) {
    case AnimatedProperty::kLightColor:
      link.color = dvec3(value.value);
      break;
    case AnimatedProperty::kLightIntensity:
      link.intensity = value.value.x;
      break;
    case AnimatedProperty::kLightRange:
      if (light.attenuation == Attenuation::kInverseSquare) {
        set_factor(light.range, value.value, kMinSize, kMaxCoordinate);
      }
      return;
    case AnimatedProperty::kInnerConeAngle:
      set_cone(std::max(value.value.x, 0.0), static_cast<double>(light.outer_cone_angle), light);
      return;
    case AnimatedProperty::kOuterConeAngle:
      set_cone(static_cast<double>(light.inner_cone_angle), std::max(value.value.x, 0.0), light);
      return;
    default:
      return;
  }
  const vec3 power(glm::clamp(link.intensity * link.color, 0.0, kMaxCoordinate));
  if (link.has_diffuse_power) light.diffuse = power;
  if (link.has_specular_power) light.specular = power;
}

void apply_to_camera(const Value& value, CameraLink& link, Camera& camera) {
  switch (value.property) {
    case AnimatedProperty::kYfov:
      return set_factor(camera.yfov, value.value, kTiny, kMostYfov);
    case AnimatedProperty::kAspectRatio:
      return set_factor(camera.aspect_ratio, value.value, kTiny, 1.0 / kTiny);
    case AnimatedProperty::kNear:
      return set_factor(camera.near, value.value, 0.0, kMaxCoordinate);
    case AnimatedProperty::kXmag:
      link.xmag = std::clamp(value.value.x, kMinSize, kMaxCoordinate);
      break;
    case AnimatedProperty::kYmag:
      set_factor(camera.ymag, value.value, kMinSize, kMaxCoordinate);
      break;
    default:
      return;
  }
  camera.aspect_ratio = static_cast<float>(link.xmag / static_cast<double>(camera.ymag));
}

/// Calls apply(link, part) for each light or camera with this definition.
template <class Link, class Part, class Apply>
void apply_to_all(std::vector<Link>& links, std::vector<Part>& parts, uint32_t definition, const Apply& apply) {
  for (size_t i = 0; i < std::min(links.size(), parts.size()); ++i) {
    if (links[i].definition == definition) apply(links[i], parts[i]);
  }
}

}  // namespace

void apply_values(std::span<const Value> values, Scene& scene) {
  const Motion& motion = *scene.motion;
  std::vector<LightLink> lights = motion.lights;
  std::vector<CameraLink> cameras = motion.cameras;
  std::vector<MaterialLink> materials = motion.materials;
  for (const Value& value : values) {
    switch (target_of(value.property)) {
      case AnimatedTarget::kLight:
        apply_to_all(lights, scene.lights, value.target,
                     [&](LightLink& link, Light& light) { apply_to_light(value, link, light); });
        break;
      case AnimatedTarget::kCamera:
        apply_to_all(cameras, scene.cameras, value.target,
                     [&](CameraLink& link, Camera& camera) { apply_to_camera(value, link, camera); });
        break;
      case AnimatedTarget::kMaterial: {
        const auto link = std::ranges::find(materials, value.target, &MaterialLink::material);
        if (link != materials.end()) apply_to_material(value, *link, scene.materials[value.target]);
        break;
      }
      case AnimatedTarget::kNode:
        break;
    }
  }
}

}  // namespace promin
