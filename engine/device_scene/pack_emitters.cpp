// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/pack_emitters.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>
#include <tuple>
#include <variant>

#include "core/rounding.h"
#include "scene/glass.h"
#include "scene/layers.h"
#include "scene/light_kinds.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

using namespace layout;

double mean_of(const vec3& color) {
  return (static_cast<double>(color.x) + static_cast<double>(color.y) + static_cast<double>(color.z)) / 3.0;
}

vec3 vector_of(const uvec4& words) {
  return std::bit_cast<vec3>(std::array{words.x, words.y, words.z});
}

std::array<dvec3, 3> corners_of_record(const Primitive& p) {
  return {dvec3(p.a), dvec3(p.a.w, p.b.x, p.b.y), dvec3(p.b.z, p.b.w, std::bit_cast<float>(p.c.x))};
}

double area_of_triangle(const std::array<dvec3, 3>& corners) {
  return 0.5 * glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
}

/// The areas of the parts of a primitive, by Hit::part; 0 for a missing part.
using PartAreas = std::array<double, 6>;

constexpr double kPiOfAreas = std::numbers::pi;

PartAreas areas_of(const world::Sphere& sphere) {
  const double radius = sphere.radius;
  return {4.0 * kPiOfAreas * radius * radius};
}
PartAreas areas_of(const world::Box& box) {
  const dvec3 h(box.half_size);
  return {4.0 * h.y * h.z, 4.0 * h.y * h.z, 4.0 * h.x * h.z, 4.0 * h.x * h.z, 4.0 * h.x * h.y, 4.0 * h.x * h.y};
}
/// Returns the areas of the side and of both ends.
PartAreas areas_of_frustum(double bottom, double top, double height, bool is_open) {
  const double ends = is_open ? 0.0 : kPiOfAreas;
  return {kPiOfAreas * (bottom + top) * std::hypot(height, bottom - top), ends * bottom * bottom, ends * top * top};
}
PartAreas areas_of(const world::Cylinder& cylinder) {
  const double radius = cylinder.radius;
  return areas_of_frustum(radius, radius, 2.0 * static_cast<double>(cylinder.half_height), cylinder.is_open);
}
PartAreas areas_of(const world::Cone& cone) {
  return areas_of_frustum(cone.radius_bottom, cone.radius_top, 2.0 * static_cast<double>(cone.half_height),
                          cone.is_open);
}
PartAreas areas_of(const world::Capsule& capsule) {
  const double bottom = capsule.radius_bottom;
  const double top = capsule.radius_top;
  const double height = 2.0 * static_cast<double>(capsule.half_height);
  if (!(height > std::abs(bottom - top))) {
    return bottom >= top ? PartAreas{0.0, 4.0 * kPiOfAreas * bottom * bottom}
                         : PartAreas{0.0, 0.0, 4.0 * kPiOfAreas * top * top};
  }
  // The side touches the spheres where their normals have this sine to the plane across the axis.
  const double sine = (bottom - top) / height;
  const double cosine2 = (1.0 - sine) * (1.0 + sine);
  return {kPiOfAreas * (bottom + top) * cosine2 * height, 2.0 * kPiOfAreas * bottom * bottom * (1.0 + sine),
          2.0 * kPiOfAreas * top * top * (1.0 - sine)};
}
/// A plane has no finite area.
PartAreas areas_of(const world::Plane& /*plane*/) {
  return {};
}

PartAreas areas_of(const Primitive& p) {
  switch (p.c.z) {
    case KIND_TRIANGLE:
      return {area_of_triangle(corners_of_record(p))};
#define PROMIN_SHAPE(KIND, TYPE, PREFIX, NUMBER, FEATURE, BIT, NAME) \
  case KIND_##KIND:                                                  \
    return areas_of(unpack<world::TYPE>(p));
#include "promin/kinds/primitives.def"
  }
  return {};
}

/// The largest cosine of the angle between the sides of a rectangle, and the largest distance of its last corner from
/// that of the parallelogram: in its longer side, or in 16 times the shorter one if that is less.
constexpr double kRectangleDoubt = 0x1p-20;

/// Returns whether all points of a material's surfaces emit the same light.
bool emits_evenly(const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  const bool has_even_coat = model == nullptr || !model->clearcoat_texture.exists();
  return !material.emissive_texture.exists() && material.alpha_mode == AlphaMode::kOpaque && has_even_coat;
}

/// Collects the emissive surfaces of a scene.
class EmissiveFinder {
 public:
  EmissiveFinder(const EmitterGeometry& geometry, const EmitterRanges& ranges, std::span<const Material> materials,
                 const EmissionTextures& textures)
      : geometry_(geometry), ranges_(ranges), materials_(materials), textures_(textures) {
    for (const Material& material : materials) emits_.push_back(emits_light(material));
    for (uint32_t i = 0; i < ranges.own_count; ++i) {
      if (!emits_[material_of(i)]) continue;
      const PartAreas areas = areas_of(geometry.primitives[i]);
      for (uint32_t part = 0; part < areas.size(); ++part) {
        add(i, part, geometry.primitives[i].c.y, areas[part], material_of(i));
      }
    }
    leaves_out_instances_ = count_of_instances() > kMostInstancedEmitters;
    if (!leaves_out_instances_) {
      for (uint32_t i = 0; i < ranges.instance_count; ++i) add_instance(INSTANCE_RECORDS * i);
    }
    // The tree determines the order of primitives, and it may refer to a primitive several times.
    const auto key = [](const EmissiveSurface& s) { return std::tuple(s.order, s.part, s.primitive); };
    std::ranges::sort(found_, {}, key);
    const auto copies = std::ranges::unique(found_, [](const EmissiveSurface& a, const EmissiveSurface& b) {
      return a.order == b.order && a.part == b.part;
    });
    found_.erase(copies.begin(), copies.end());
    for (EmissiveSurface& surface : found_) {
      const auto next = std::ranges::upper_bound(ranges.first_order, surface.order);
      surface.object = static_cast<uint32_t>(next - ranges.first_order.begin()) - 1;
    }
    join_rectangles();
  }
  EmissiveSurfaces take() {
    return {std::move(found_), leaves_out_instances_, !rectangles_.empty(), std::move(rectangles_)};
  }

 private:
  uint32_t material_of(uint32_t primitive) const {
    return geometry_.surfaces[primitive].corners_material.w & SURFACE_MATERIAL_MASK;
  }

  void add(uint32_t primitive, uint32_t part, uint32_t order, double area, uint32_t material) {
    if (!(area > 0.0)) return;
    const vec3 texel = texel_on(primitive, materials_[material].emissive_texture);
    if (max_component(texel) == 0.0F) return;
    found_.push_back(
        {.primitive = primitive, .part = part, .order = order, .material = material, .area = area, .texel = texel});
  }

  /// Returns the mean of a texture on a triangle.
  vec3 texel_on(uint32_t primitive, const TextureSlot& slot) const {
    const uvec4& corners = geometry_.surfaces[primitive].corners_material;
    if (!slot.exists() || (corners.w & SURFACE_HAS_UVS) == 0 || slot.texture >= textures_.textures.size()) {
      return vec3(1.0F);
    }
    const Texture& texture = textures_.textures[slot.texture];
    if (texture.image >= textures_.maps.size() || !textures_.maps[texture.image]) return vec3(1.0F);
    std::array<dvec2, 3> places;
    for (int i = 0; i < 3; ++i) {
      const vec4& uvs = geometry_.uvs[corners[i]];
      const dvec3 st(slot.uv_set == 0 ? dvec2(uvs.x, uvs.y) : dvec2(uvs.z, uvs.w), 1.0);
      places[static_cast<size_t>(i)] = dvec2(glm::dot(dvec3(slot.to_u), st), glm::dot(dvec3(slot.to_v), st));
    }
    return textures_.maps[texture.image]->mean_on(places, texture);
  }

  /// Returns the index of the mesh of an instance, whose first record has this index.
  size_t mesh_of(uint32_t record) const {
    const uint32_t root = geometry_.records[record].children.y;
    const auto mesh = std::ranges::lower_bound(ranges_.meshes, root, {}, &MeshRange::root);
    return static_cast<size_t>(mesh - ranges_.meshes.begin());
  }

  /// Returns the number of emissive triangles of all instances.
  uint64_t count_of_instances() const {
    // For each mesh, the number of triangles that emit light by their own materials.
    std::vector<uint64_t> own_counts(ranges_.meshes.size(), 0);
    for (size_t i = 0; i < ranges_.meshes.size(); ++i) {
      for (uint32_t k = ranges_.meshes[i].first; k < ranges_.meshes[i].end; ++k) {
        own_counts[i] += emits_[material_of(k)] ? 1 : 0;
      }
    }
    uint64_t count = 0;
    for (uint32_t i = 0; i < ranges_.instance_count; ++i) {
      const uint32_t record = INSTANCE_RECORDS * i;
      const uint32_t material = geometry_.records[record + 1].frame.w;
      const size_t mesh = mesh_of(record);
      if (material == NO_INSTANCE_MATERIAL) {
        count += own_counts[mesh];
      } else if (emits_[material]) {
        count += ranges_.meshes[mesh].end - ranges_.meshes[mesh].first;
      }
    }
    return count;
  }

  void add_instance(uint32_t record) {
    const Node& map = geometry_.records[record];
    const Node& look = geometry_.records[record + 1];
    const uint32_t material = look.frame.w;
    if (material != NO_INSTANCE_MATERIAL && !emits_[material]) return;
    const std::array<dvec3, 3> rows = {vector_of(look.frame), vector_of(look.lo), vector_of(look.hi)};
    const MeshRange& mesh = ranges_.meshes[mesh_of(record)];
    for (uint32_t i = mesh.first; i < mesh.end; ++i) {
      const uint32_t used = material == NO_INSTANCE_MATERIAL ? material_of(i) : material;
      if (!emits_[used]) continue;
      std::array<dvec3, 3> corners = corners_of_record(geometry_.primitives[i]);
      for (dvec3& corner : corners) {
        corner = dvec3(glm::dot(rows[0], corner), glm::dot(rows[1], corner), glm::dot(rows[2], corner));
      }
      const uint32_t order = map.children.z + geometry_.primitives[i].c.y;
      add(i, ranges_.first_instance + record + FIRST_INSTANCE_PART, order, area_of_triangle(corners), used);
    }
  }

  /// Replaces triangles by rectangles if each is one half of a rectangle whose other half is next to it.
  void join_rectangles() {
    std::vector<EmissiveSurface> joined;
    std::vector<EmissiveSurfaces::Rectangle> rectangles;
    for (size_t i = 0; i < found_.size(); ++i) {
      joined.push_back(found_[i]);
      rectangles.emplace_back();
      if (geometry_.primitives[found_[i].primitive].c.z != KIND_TRIANGLE) continue;
      const std::optional<uint32_t> corner =
          i + 1 < found_.size() ? corner_of_rectangle(found_[i], found_[i + 1]) : std::nullopt;
      if (!corner) return;
      const std::array<dvec3, 3> places = corners_of_record(geometry_.primitives[found_[i].primitive]);
      const dvec3& next = places[(*corner + 1) % 3];
      const dvec3& last = places[(*corner + 2) % 3];
      rectangles.back() = {0.5 * (next + last), {next - places[*corner], last - places[*corner]}};
      joined.back().corner = *corner;
      joined.back().area += found_[++i].area;
    }
    if (joined.size() == found_.size()) return;
    found_ = std::move(joined);
    rectangles_ = std::move(rectangles);
  }

  /// Returns the number of the first triangle's corner at a right angle if two triangles form a rectangle that emits
  /// the same light everywhere.
  std::optional<uint32_t> corner_of_rectangle(const EmissiveSurface& first, const EmissiveSurface& second) const {
    const bool is_pair = first.object == second.object && first.order + 1 == second.order &&
                         first.material == second.material && first.part == 0 && second.part == 0;
    if (!is_pair || !emits_evenly(materials_[first.material])) return std::nullopt;
    const std::array<dvec3, 3> a = corners_of_record(geometry_.primitives[first.primitive]);
    const std::array<dvec3, 3> b = corners_of_record(geometry_.primitives[second.primitive]);
    for (size_t i = 0; i < 3; ++i) {
      const dvec3& next = a[(i + 1) % 3];
      const dvec3& last = a[(i + 2) % 3];
      const dvec3 side1 = next - a[i];
      const dvec3 side2 = last - a[i];
      const double length1 = glm::length(side1);
      const double length2 = glm::length(side2);
      if (std::abs(glm::dot(side1, side2)) > kRectangleDoubt * length1 * length2) continue;
      const dvec3 opposite = next + side2;
      const double doubt = kRectangleDoubt * std::min(std::max(length1, length2), 16.0 * std::min(length1, length2));
      for (size_t j = 0; j < 3; ++j) {
        // The triangles share the diagonal, and run through it in opposite directions.
        if (b[(j + 1) % 3] == last && b[(j + 2) % 3] == next && glm::distance(b[j], opposite) <= doubt) {
          return static_cast<uint32_t>(i);
        }
      }
    }
    return std::nullopt;
  }

  const EmitterGeometry& geometry_;
  const EmitterRanges& ranges_;
  std::span<const Material> materials_;
  const EmissionTextures& textures_;
  std::vector<bool> emits_;
  std::vector<EmissiveSurface> found_;
  bool leaves_out_instances_ = false;
  std::vector<EmissiveSurfaces::Rectangle> rectangles_;
};

/// An element of a table before it is packed.
struct TableEntry {
  double weight = 0.0;
  uvec4 words{0};
};

/// Returns the flux of a light, divided by pi. A light whose power does not decrease shines on the whole scene.
double flux_of(const Light& light, double scene_radius) {
  const double power = 0.5 * (mean_of(light.diffuse) + mean_of(light.specular));
  const auto [width, height] = std::array{static_cast<double>(light.size.x), static_cast<double>(light.size.y)};
  if (light.kind == LightKind::kRect) return power * width * height;
  if (light.kind == LightKind::kDisk) return power * 0.25 * std::numbers::pi * width * height;
  if (!falls_off(light)) return power * scene_radius * scene_radius;
  if (light.kind == LightKind::kSpot) {
    return power * 2.0 * (1.0 - std::cos(static_cast<double>(light.outer_cone_angle)));
  }
  return power * 4.0;
}

double flux_of(const EmissiveSurface& surface, const Material& material) {
  return mean_of(material.emissive * surface.texel) * surface.area * (shows_backs(material) ? 2.0 : 1.0);
}

bool has_coat(const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  return model != nullptr && model->clearcoat > 0.0F;
}

/// Returns the record of a source that is one rectangle.
LightRecord record_of_rectangle(const EmissiveSurfaces::Rectangle& rectangle, const Material& material,
                                float radiance_factor) {
  const auto [side1, side2] = rectangle.sides;
  const vec3 right(glm::normalize(side1));
  const vec3 radiance = radiance_factor * material.emissive;
  LightRecord record{};
  record.position = vec4(vec3(rectangle.middle), 0.5 * glm::length(side2));
  record.direction = vec4(vec3(glm::normalize(glm::cross(side1, side2))), 0.5 * glm::length(side1));
  record.diffuse = vec4(radiance, right.x);
  record.specular = vec4(radiance, right.y);
  record.kind = uvec4(LIGHT_EMITTERS, shows_backs(material) ? 0 : 1, std::bit_cast<uint32_t>(right.z), 0);
  return record;
}

/// Appends a table to `sources`, with a source that chooses from it.
void add_table(std::span<const TableEntry> elements, float radiance_factor, DirectSources& sources) {
  const auto count = static_cast<uint32_t>(elements.size());
  std::vector<double> weights;
  for (const TableEntry& element : elements) weights.push_back(element.weight);
  const std::vector<uint64_t> begins = share_numbers(weights);
  LightRecord record{};
  record.position.w = radiance_factor;
  record.kind = uvec4(LIGHT_EMITTERS, count, 0, sources.table.size());
  uint32_t of_cell = 0;
  for (uint32_t i = 0; i < count; ++i) {
    // The first number of the cell, of which there are as many as elements.
    const uint64_t first = ((uint64_t{i} << 32) + count - 1) / count;
    while (begins[of_cell + 1] <= first) ++of_cell;
    const double chance = std::ldexp(static_cast<double>(begins[i + 1] - begins[i]), -32);
    sources.table.emplace_back(static_cast<uint32_t>(begins[i]), std::bit_cast<uint32_t>(static_cast<float>(chance)),
                               of_cell, 0);
    sources.table.push_back(elements[i].words);
  }
  sources.records.push_back(record);
}

}  // namespace

EmitterRanges::EmitterRanges(const PackedScene& packed)
    : own_count(packed.own_primitive_count()),
      meshes(packed.mesh_ranges),
      first_instance(packed.first_instance),
      instance_count(static_cast<uint32_t>(packed.instance_count)),
      first_order(packed.numbers.first_order) {}

EmissiveSurfaces find_emissive_surfaces(const EmitterGeometry& geometry, const EmitterRanges& ranges,
                                        std::span<const Material> materials, const EmissionTextures& textures) {
  if (std::ranges::none_of(materials, emits_light)) return {};
  return EmissiveFinder(geometry, ranges, materials, textures).take();
}

EmissionMaps make_emission_maps(const PackedImages& images, std::span<const Texture> textures,
                                std::span<const Material> materials) {
  EmissionMaps maps(images.images.size());
  for (const Material& material : materials) {
    const TextureSlot& slot = material.emissive_texture;
    if (!emits_light(material) || slot.texture >= textures.size()) continue;
    const uint32_t number = textures[slot.texture].image;
    const PlacedImage& image = images.images[number];
    if (image.levels == 0 || maps[number]) continue;
    const size_t first = image.first + images.words[image.first] + image.place;
    std::vector<uint32_t> texels(size_t{image.size.x} * image.size.y);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = images.words[first + i * image.stride];
    maps[number] = std::make_unique<const EmissionMap>(texels, image.size);
  }
  return maps;
}

std::vector<uint64_t> share_numbers(std::span<const double> weights) {
  double total = 0.0;
  for (const double weight : weights) total += weight;
  const auto count = static_cast<double>(weights.size());
  std::vector<uint64_t> begins = {0};
  double sum = 0.0;
  for (size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i];
    const double share = (1.0 - kEvenShare) * (sum / total) + kEvenShare * (static_cast<double>(i + 1) / count);
    begins.push_back(static_cast<uint64_t>(std::ldexp(share, 32)));
  }
  begins.back() = uint64_t{1} << 32;
  return begins;
}

DirectSources pack_direct_sources(std::span<const Light> lights, const EmissiveSurfaces& emissive,
                                  std::span<const Material> materials, float scene_radius) {
  DirectSources sources;
  // In scenes of Phong materials alone, the power of lights contains the factor pi.
  const bool is_of_phong = has_phong_alone(materials);
  const float radiance_factor = is_of_phong ? static_cast<float>(1.0 / std::numbers::pi) : 1.0F;
  const double light_factor = is_of_phong ? std::numbers::pi : 1.0;
  std::vector<TableEntry> elements;
  uint32_t records = 0;
  const double radius = scene_radius > 0.0F ? static_cast<double>(scene_radius) : 1.0;
  for (const Light& light : lights) {
    if (!light.is_on) continue;
    elements.push_back({light_factor * flux_of(light, radius), uvec4(records++, EMITTER_IS_LIGHT, 0, 0)});
  }
  // For each object, the end of its elements.
  std::vector<size_t> ends;
  std::vector<LightRecord> rectangles;
  sources.are_rectangles = emissive.are_rectangles;
  uint32_t object = ~0U;
  for (size_t i = 0; i < emissive.surfaces.size(); ++i) {
    const EmissiveSurface& surface = emissive.surfaces[i];
    const Material& material = materials[surface.material];
    const double flux = emits_light(material) ? flux_of(surface, material) : 0.0;
    if (!(flux > 0.0)) continue;
    // Records have no shapes. Light from below a coat depends on the angle.
    sources.are_rectangles =
        sources.are_rectangles && emissive.rectangles[i].sides[0] != dvec3(0.0) && !has_coat(material);
    if (sources.are_rectangles) {
      rectangles.push_back(record_of_rectangle(emissive.rectangles[i], material, radiance_factor));
    }
    elements.push_back({flux, uvec4(surface.primitive, surface.part, surface.corner,
                                    std::bit_cast<uint32_t>(static_cast<float>(surface.area)))});
    if (ends.empty() || surface.object != object) ends.emplace_back();
    object = surface.object;
    ends.back() = elements.size();
  }
  sources.has_surfaces = !ends.empty();
  sources.are_lights_chosen = records + ends.size() > kMostAskedSources;
  sources.may_choose_lights = lights.size() + ends.size() > kMostAskedSources;
  if (sources.are_lights_chosen) {
    sources.are_rectangles = false;
    // A light of no power is never chosen.
    std::erase_if(elements, [](const TableEntry& element) { return !(element.weight > 0.0); });
    if (!elements.empty()) add_table(elements, radiance_factor, sources);
    return sources;
  }
  sources.are_rectangles = sources.are_rectangles && rectangles.size() == ends.size();
  if (sources.are_rectangles) {
    sources.records = std::move(rectangles);
    return sources;
  }
  size_t first = records;
  for (const size_t end : ends) {
    add_table(std::span(elements).subspan(first, end - first), radiance_factor, sources);
    first = end;
  }
  return sources;
}

}  // namespace promin
