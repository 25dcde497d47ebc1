// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/pictures/usual_integrator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/rounding.h"
#include "core/srgb.h"
#include "scene/framing.h"
#include "scene/glass.h"
#include "scene/placed_bounds.h"

namespace promin::work {
namespace {

/// The radiance that emissive surfaces must give a white surface, and the radiance above which they count.
constexpr double kLeastRadiance = 1.0 / 256.0;
constexpr float kLeastEmission = 1.0F;

/// The radiance that emissive surfaces must give a white surface so that the scene needs no other light.
constexpr double kStrongRadiance = 1.0 / 32.0;

/// The largest number of texels whose mean is computed.
constexpr size_t kMostTexels = 4096;

/// The largest number of lamps that are compared with each object. The brightest are.
constexpr size_t kMostLamps = 64;

/// The largest number of triangles of lamps. Renderers leave out instances with more of them (kMostInstancedEmitters).
constexpr uint64_t kMostTriangles = uint64_t{1} << 22;

/// An object whose surfaces emit light.
struct GlowingObject {
  /// The sum of area times mean radiance.
  double flux = 0.0;
  dvec3 center{0.0};
};

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

/// The mean radiance of each material, twice if both sides shine; 0 for materials that do not count.
class Emissions {
 public:
  explicit Emissions(std::vector<double> values) : values_(std::move(values)) {}
  double at(uint32_t material) const { return material < values_.size() ? values_[material] : 0.0; }
  bool are_all_dark() const {
    return std::ranges::all_of(values_, [](double emission) { return emission == 0.0; });
  }

 private:
  std::vector<double> values_;
};

Emissions find_emissions(const Scene& scene) {
  std::vector<double> emissions;
  for (const Material& material : scene.materials) {
    const bool counts =
        !std::holds_alternative<Unlit>(material.model) && max_component(material.emissive) > kLeastEmission;
    double emission = 0.0;
    if (counts) {
      const dvec3 light = dvec3(material.emissive) * mean_texel(scene, material.emissive_texture);
      emission = (light.x + light.y + light.z) / 3.0 * (shows_backs(material) ? 2.0 : 1.0);
    }
    emissions.push_back(emission);
  }
  return Emissions(std::move(emissions));
}

/// Returns the material of a triangle of an object's mesh.
uint32_t material_of(const Mesh& mesh, size_t triangle, const Object& object) {
  return mesh.triangle_materials.empty() ? object.material : mesh.triangle_materials[triangle];
}

/// Returns whether a condition holds for a material of an object.
template <typename Condition>
bool any_material(const Geometry& geometry, const Object& object, const Condition& condition) {
  const auto* mesh = std::get_if<Mesh>(&geometry);
  if (mesh == nullptr || mesh->triangle_materials.empty()) return condition(object.material);
  return std::ranges::any_of(mesh->triangle_materials, condition);
}

/// Returns the sum of area times emission of an object.
double flux_of(const Scene& scene, const Object& object, const Bounds& box, const Emissions& emissions) {
  const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
  // The box of a shape has about the area of the shape. The box of a plane is empty.
  if (mesh == nullptr) return emissions.at(object.material) * 2.0 * box.half_area();
  const glm::dmat3 turn(object.world_from_object);
  double sum = 0.0;
  for (size_t i = 0; i < mesh->triangles.size(); ++i) {
    const double emission = emissions.at(material_of(*mesh, i, object));
    if (emission == 0.0) continue;
    const uvec3& corners = mesh->triangles[i];
    const dvec3 a(mesh->positions[corners.x]);
    const dvec3 b(mesh->positions[corners.y]);
    const dvec3 c(mesh->positions[corners.z]);
    sum += emission * 0.5 * glm::length(glm::cross(turn * (b - a), turn * (c - a)));
  }
  return sum;
}

/// Returns whether a flux gives white surfaces on a sphere of this radius a radiance. The sphere receives pi times the
/// flux, and a white surface reflects 1 / pi of its irradiance.
bool lights_sphere(double flux, double radius, double radiance = kLeastRadiance) {
  return flux >= radiance * 4.0 * std::numbers::pi * radius * radius;
}

/// Returns the distance of a point to the farthest point of a box.
double farthest_distance(const dvec3& point, const Bounds& box) {
  return glm::length(glm::max(glm::abs(dvec3(box.lo) - point), glm::abs(dvec3(box.hi) - point)));
}

/// The lamps of a scene, and the boxes of what they could light.
struct Glow {
  std::vector<GlowingObject> lamps;
  std::vector<Bounds> receivers;
  double flux = 0.0;
  /// Half of the diagonal of the scene's box.
  double radius = 0.0;
};

/// Returns the lamps of a scene; nullopt if they light nothing.
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
    if (any_material(geometry, object, [&](uint32_t material) { return emissions.at(material) == 0.0; })) {
      glow.receivers.push_back(box);
    }
    if (!any_material(geometry, object, [&](uint32_t material) { return emissions.at(material) > 0.0; })) continue;
    if (const auto* mesh = std::get_if<Mesh>(&geometry)) triangle_count += mesh->triangles.size();
    if (triangle_count > kMostTriangles) return {};
    glow.lamps.push_back({flux_of(scene, object, box, emissions), middle_of(box)});
    glow.flux += glow.lamps.back().flux;
  }
  const bool is_alone = object_count == 1 && glow.receivers.empty();
  if (!(glow.flux > 0.0) || is_alone) return {};
  glow.radius = 0.5 * glm::length(dvec3(whole.extent()));
  return glow;
}

}  // namespace

bool lights_itself(const Scene& scene) {
  std::optional<Glow> glow = find_glow(scene);
  if (!glow) return false;
  if (lights_sphere(glow->flux, glow->radius)) return true;
  // A large floor does not hide that a lamp lights the objects on it.
  std::vector<GlowingObject>& lamps = glow->lamps;
  const size_t count = std::min(lamps.size(), kMostLamps);
  const auto end = lamps.begin() + static_cast<std::ptrdiff_t>(count);
  std::ranges::partial_sort(lamps, end, std::ranges::greater(), &GlowingObject::flux);
  return std::any_of(lamps.begin(), end, [&](const GlowingObject& lamp) {
    return std::ranges::any_of(glow->receivers, [&](const Bounds& box) {
      return lights_sphere(lamp.flux, farthest_distance(lamp.center, box));
    });
  });
}

LightChoice choose_light(const Scene& scene, LightChoice choice, Integrator integrator) {
  const bool has_light = !scene.lights.empty() || scene.environment.has_sky();
  if (choice != LightChoice::kAuto || scene.is_classic || has_light) return choice;
  const std::optional<Glow> glow = find_glow(scene);
  if (!glow || !lights_sphere(glow->flux, glow->radius, kStrongRadiance)) return choice;
  return integrator == Integrator::kWhitted ? LightChoice::kStudio : LightChoice::kFill;
}

Integrator usual_integrator(const Scene& scene, LightChoice light) {
  return light == LightChoice::kSoft || lights_itself(scene) ? Integrator::kDirect : Integrator::kWhitted;
}

}  // namespace promin::work
