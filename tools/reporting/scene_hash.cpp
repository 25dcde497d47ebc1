// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/scene_hash.h"

#include <fmt/format.h>

#include <bit>
#include <span>

#include "core/hash.h"
#include "scene/texture_slots.h"

namespace promin::report {
namespace {

/// Member by member: padding has no value.
class ContentHash {
 public:
  void add(uint64_t word) { hash_.add(word); }
  void add(float value) { hash_.add(std::bit_cast<uint32_t>(value)); }
  void add(const vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  template <typename Value>
  void add(const std::vector<Value>& values) {
    hash_.add(values.size());
    hash_.add(std::as_bytes(std::span(values)));
  }

  void add(const world::NotDrawn& /*shape*/) {}
  void add(const Mesh& mesh) {
    add(mesh.positions);
    add(mesh.normals);
    add(mesh.colors);
    add(mesh.uvs);
    add(mesh.tangents);
    add(mesh.triangles);
    add(mesh.triangle_materials);
  }
  void add(const world::Sphere& sphere) {
    add(sphere.center);
    add(sphere.radius);
  }
  void add(const world::Plane& plane) {
    add(plane.point);
    add(plane.normal);
  }
  void add(const world::Cylinder& cylinder) {
    add(cylinder.center);
    add(cylinder.axis);
    add(cylinder.half_height);
    add(cylinder.radius);
    // What is closed keeps the hash that it had before there were open ones.
    if (cylinder.is_open) add(uint64_t{1});
  }
  void add(const world::Cone& cone) {
    add(cone.center);
    add(cone.axis);
    add(cone.half_height);
    add(cone.radius_bottom);
    add(cone.radius_top);
    if (cone.is_open) add(uint64_t{1});
  }
  void add(const world::Capsule& capsule) {
    add(capsule.center);
    add(capsule.axis);
    add(capsule.half_height);
    add(capsule.radius_bottom);
    add(capsule.radius_top);
  }
  void add(const world::Box& box) {
    add(box.center);
    add(box.half_size);
    add(box.turn);
  }
  void add(const Phong& phong) {
    for (const vec3& factor : {phong.ambient, phong.diffuse, phong.specular, phong.reflection, phong.transmission}) {
      add(factor);
    }
    add(phong.shininess);
    add(phong.ior);
    add(uint64_t{phong.fresnel});
    for (const TextureSlot& slot : {phong.diffuse_texture, phong.specular_texture, phong.normal_texture}) add(slot);
  }
  void add(const MetallicRoughness& material) {
    add(material.base_color);
    for (const float value : {material.metallic, material.roughness, material.ior, material.specular}) add(value);
    add(material.specular_color);
    add(material.normal_scale);
    add(material.occlusion_strength);
    for (const float value : {material.clearcoat, material.clearcoat_roughness, material.clearcoat_normal_scale}) {
      add(value);
    }
    add(material.sheen_color);
    add(material.sheen_roughness);
    for (const float value :
         {material.transmission, material.thickness, material.attenuation_distance, material.dispersion}) {
      add(value);
    }
    add(material.attenuation_color);
    add(material.diffuse_transmission);
    add(material.diffuse_transmission_color);
    for (const float value : {material.iridescence, material.iridescence_ior, material.iridescence_thickness_minimum,
                              material.iridescence_thickness_maximum, material.anisotropy, material.anisotropy_rotation}) {
      add(value);
    }
  }
  void add(const Unlit& unlit) { add(unlit.color); }
  void add(const TextureSlot& slot) {
    add(uint64_t{slot.texture} << 32 | slot.uv_set);
    add(slot.to_u);
    add(slot.to_v);
  }
  void add(const Texture& texture) {
    for (const uint64_t word :
         {uint64_t{texture.image}, static_cast<uint64_t>(texture.wrap_u), static_cast<uint64_t>(texture.wrap_v),
          uint64_t{texture.is_magnified_linearly}, uint64_t{texture.is_minified_linearly}, uint64_t{texture.has_levels},
          uint64_t{texture.are_levels_linear}}) {
      add(word);
    }
  }
  void add(const TextureImage& image) {
    add(uint64_t{image.size.x} << 32 | image.size.y);
    add(static_cast<uint64_t>(image.use));
    add(image.texels);
  }
  void add(const Material& material) {
    std::visit([&](const auto& model) { add(model); }, material.model);
    add(material.emissive);
    add(static_cast<uint64_t>(material.alpha_mode) << 1 | uint64_t{material.is_double_sided});
    add(material.alpha);
    add(material.alpha_cutoff);
    for_each_slot(material, [this](const TextureSlot& slot, const char* /*name*/, ImageUse /*use*/) { add(slot); });
  }
  void add(const Light& light) {
    add(static_cast<uint64_t>(light.kind));
    add(static_cast<uint64_t>(light.attenuation));
    for (const vec3& v : {light.position, light.direction, light.diffuse, light.specular}) add(v);
    for (const float value : {light.range, light.inner_cone_angle, light.outer_cone_angle}) add(value);
  }
  void add(const Camera& camera) {
    add(static_cast<uint64_t>(camera.projection));
    for (const vec3& v : {camera.eye, camera.look, camera.up}) add(v);
    for (const float value : {camera.yfov, camera.ymag, camera.aspect_ratio, camera.near}) add(value);
  }

  uint64_t value() const { return hash_.value(); }

 private:
  Hash64 hash_;
};

}  // namespace

std::string hash_of(const world::Scene& scene) {
  ContentHash hash;
  hash.add(scene.objects.size());
  for (const world::Object& object : scene.objects) {
    hash.add(object.shape.index());
    std::visit([&](const auto& shape) { hash.add(shape); }, object.shape);
    hash.add(uint64_t{object.material});
  }
  hash.add(scene.materials.size());
  for (const Material& material : scene.materials) hash.add(material);
  hash.add(scene.textures.size());
  for (const Texture& texture : scene.textures) hash.add(texture);
  for (const auto& image : scene.images) hash.add(*image);
  hash.add(scene.lights.size());
  for (const Light& light : scene.lights) hash.add(light);
  hash.add(scene.cameras.size());
  for (const Camera& camera : scene.cameras) hash.add(camera);
  hash.add(scene.environment.ambient);
  hash.add(scene.environment.background);
  return fmt::format("{:016x}", hash.value());
}

}  // namespace promin::report
