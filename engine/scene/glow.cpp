// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/glow.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <variant>

#include "core/luminance.h"
#include "core/rounding.h"
#include "core/srgb.h"
#include "scene/facets.h"
#include "scene/glass.h"
#include "scene/placed_bounds.h"

namespace promin {
namespace {

/// The radiance above which emissive surfaces count.
constexpr float kLeastEmission = 1.0F;

/// The largest number of texels whose mean is computed.
constexpr size_t kMostTexels = 4096;

/// The largest number of triangles of lamps. Renderers leave out instances with more of them (kMostInstancedEmitters).
constexpr uint64_t kMostTriangles = uint64_t{1} << 22;

/// Returns the mean of the light of some texels of a texture; 1 without a texture.
dvec3 mean_texel(const Scene& scene, const TextureSlot& slot) {
  if (slot.texture >= scene.textures.size()) return dvec3(1.0);
  const uint32_t image = scene.textures[slot.texture].image;
  if (image >= scene.images.size() || !scene.images[image]) return dvec3(1.0);
  const std::vector<uint32_t>& texels = scene.images[image]->texels;
  if (texels.empty()) return dvec3(1.0);
  // An odd step does not follow the columns of images whose sides are powers of two.
  const size_t step = std::max<size_t>(texels.size() / kMostTexels, 1) | 1U;
  dvec3 sum(0.0);
  double count = 0.0;
  for (size_t i = 0; i < texels.size(); i += step) {
    for (int channel = 0; channel < 3; ++channel) {
      sum[channel] += srgb_to_linear(static_cast<double>(texels[i] >> (8 * channel) & 0xFF) / 255.0);
    }
    count += 1.0;
  }
  return sum / count;
}

/// The light of a material that counts as a lamp.
struct Emission {
  /// The mean radiance of one side: the mean of the channels, and the luminance. 0 for other materials.
  double radiance = 0.0;
  double luminance = 0.0;
  bool shines_back = false;
};

/// The emissions of a scene's materials.
class Emissions {
 public:
  explicit Emissions(std::vector<Emission> values) : values_(std::move(values)) {}
  Emission of(uint32_t material) const { return material < values_.size() ? values_[material] : Emission(); }
  bool shines(uint32_t material) const { return of(material).radiance > 0.0; }
  bool are_all_dark() const {
    return std::ranges::all_of(values_, [](const Emission& emission) { return emission.radiance == 0.0; });
  }

 private:
  std::vector<Emission> values_;
};

Emissions find_emissions(const Scene& scene) {
  std::vector<Emission> emissions;
  for (const Material& material : scene.materials) {
    const bool counts =
        !std::holds_alternative<Unlit>(material.model) && max_component(material.emissive) > kLeastEmission;
    Emission emission;
    if (counts) {
      const dvec3 light = dvec3(material.emissive) * mean_texel(scene, material.emissive_texture);
      emission = {(light.x + light.y + light.z) / 3.0, luminance_of(light), shows_backs(material)};
    }
    emissions.push_back(emission);
  }
  return Emissions(std::move(emissions));
}

/// Returns whether a condition holds for a material of an object.
template <typename Condition>
bool any_material(const Geometry& geometry, const Object& object, const Condition& condition) {
  const auto* mesh = std::get_if<Mesh>(&geometry);
  if (mesh == nullptr || mesh->triangle_materials.empty()) return condition(object.material);
  return std::ranges::any_of(mesh->triangle_materials, condition);
}

/// Adds a surface of an area to a lamp. `normal` has the length of the area, or is 0 for a closed body.
void add_surface(GlowingObject& lamp, const Emission& emission, double area, const dvec3& normal) {
  lamp.area += area;
  lamp.flux += emission.radiance * area * (emission.shines_back ? 2.0 : 1.0);
  lamp.intensity += emission.luminance * area;
  lamp.facing += emission.luminance * normal;
  lamp.shines_back = lamp.shines_back || emission.shines_back;
}

/// Returns the light that an object emits.
GlowingObject glow_of(const Scene& scene, const Object& object, const Bounds& box, const Emissions& emissions) {
  GlowingObject lamp{.center = middle_of(box)};
  const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
  if (mesh == nullptr) {
    // The box of a shape has about the area of the shape. The box of a plane is empty.
    add_surface(lamp, emissions.of(object.material), 2.0 * box.half_area(), dvec3(0.0));
    return lamp;
  }
  const glm::dmat3 turn(object.world_from_object);
  const double side = glm::determinant(turn) < 0.0 ? -1.0 : 1.0;
  for (size_t i = 0; i < mesh->triangles.size(); ++i) {
    const Emission emission = emissions.of(triangle_material(*mesh, i, object.material));
    if (emission.radiance == 0.0) continue;
    const uvec3& corners = mesh->triangles[i];
    const dvec3 a(mesh->positions[corners.x]);
    const dvec3 b(mesh->positions[corners.y]);
    const dvec3 c(mesh->positions[corners.z]);
    const dvec3 normal = 0.5 * side * glm::cross(turn * (b - a), turn * (c - a));
    add_surface(lamp, emission, glm::length(normal), normal);
  }
  return lamp;
}

}  // namespace

std::optional<Glow> find_glow(const Scene& scene) {
  const Emissions emissions = find_emissions(scene);
  if (emissions.are_all_dark()) return {};
  Glow glow;
  Bounds whole;
  uint64_t triangle_count = 0;
  size_t object_count = 0;
  const std::vector<Bounds> boxes = bounds_of_objects(scene);
  for (size_t i = 0; i < boxes.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.geometry == Object::kNoGeometry) continue;
    ++object_count;
    const Bounds& box = boxes[i];
    // A plane has no box. It emits no light, and it does not change the size of the scene.
    if (box.is_empty()) continue;
    whole.extend(box);
    const Geometry& geometry = scene.geometries[object.geometry];
    if (any_material(geometry, object, [&](uint32_t material) { return !emissions.shines(material); })) {
      glow.receivers.push_back(box);
    }
    if (!any_material(geometry, object, [&](uint32_t material) { return emissions.shines(material); })) continue;
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) triangle_count += mesh->triangles.size();
    if (triangle_count > kMostTriangles) return {};
    glow.lamps.push_back(glow_of(scene, object, box, emissions));
    glow.flux += glow.lamps.back().flux;
  }
  const bool is_alone = object_count == 1 && glow.receivers.empty();
  if (!(glow.flux > 0.0) || is_alone) return {};
  glow.center = middle_of(whole);
  glow.radius = 0.5 * glm::length(dvec3(whole.extent()));
  return glow;
}

double Glow::illuminance() const {
  double sum = 0.0;
  for (const GlowingObject& lamp : lamps) {
    if (!(lamp.area > 0.0)) continue;
    const dvec3 way = center - lamp.center;
    const double distance = glm::length(way);
    const double along = distance > 0.0 ? glm::dot(lamp.facing, way) / distance : 0.0;
    const double ahead = lamp.shines_back ? std::abs(along) : along;
    const double limit = std::max(distance, 0.5 * radius);
    // A convex body shows a quarter of its area in the mean. No lamp fills more than a half space.
    const double arriving = std::max(ahead, 0.25 * lamp.intensity) / (limit * limit);
    sum += std::min(arriving, std::numbers::pi * lamp.intensity / lamp.area);
  }
  return sum;
}

}  // namespace promin
