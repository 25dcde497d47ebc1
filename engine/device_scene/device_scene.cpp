// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "device_scene/device_scene.h"

#include <algorithm>
#include <bit>

#include "core/divide_up.h"
#include "device/device.h"
#include "device_scene/lobe_table.h"
#include "promin/error.h"
#include "promin/explain.h"
#include "scene/layers.h"
#include "scene/light_kinds.h"

namespace promin {
namespace {

constexpr vk::BufferUsageFlags kStorage = vk::BufferUsageFlagBits::eStorageBuffer;
constexpr vk::BufferUsageFlags kStorageOrTexels = kStorage | vk::BufferUsageFlagBits::eUniformTexelBuffer;

gpu::Buffer upload(const gpu::Device& device, std::span<const std::byte> bytes) {
  gpu::Buffer buffer(device, bytes.size(), kStorageOrTexels);
  buffer.write(bytes);
  return buffer;
}

/// Records of one kind and their place in the buffer of shading data.
struct Placed {
  std::span<const std::byte> bytes;
  uint64_t offset = 0;
  /// The index of the first record, in units of the records' stride.
  uint32_t first_index = 0;
  uint64_t end() const { return offset + bytes.size(); }
};

/// Places records at the first multiple of their stride from `offset` on.
template <typename Records>
Placed place(const Records& records, uint64_t offset) {
  constexpr uint64_t kStride = sizeof(typename Records::value_type);
  const uint64_t first = (offset + kStride - 1) / kStride;
  return {std::as_bytes(std::span(records)), first * kStride, static_cast<uint32_t>(first)};
}

/// Returns whether both have the same bytes at the same place in the buffer.
bool is_same(const Placed& a, const Placed& b) {
  if (a.offset != b.offset || a.bytes.size() != b.bytes.size()) return false;
  // Packed data never changes, so the same memory has the same bytes.
  return a.bytes.data() == b.bytes.data() || std::ranges::equal(a.bytes, b.bytes);
}

void write(gpu::Buffer& buffer, const Placed& placed) {
  if (!placed.bytes.empty()) buffer.write(placed.bytes, placed.offset);
}

/// Returns the tables that these materials use.
std::vector<uvec4> make_tables(std::span<const Material> materials) {
  const auto looks_up_lobes = [](const Material& m) { return std::holds_alternative<MetallicRoughness>(m.model); };
  const auto looks_up_sheens = [](const Material& m) {
    const auto* model = std::get_if<MetallicRoughness>(&m.model);
    return model != nullptr && has_sheen(*model);
  };
  std::vector<uvec4> tables;
  if (std::ranges::any_of(materials, looks_up_lobes)) tables = make_lobe_table();
  if (std::ranges::any_of(materials, looks_up_sheens)) {
    const std::vector<uvec4> sheens = make_sheen_table();
    tables.insert(tables.end(), sheens.begin(), sheens.end());
  }
  return tables;
}

bool are_skies_equal(const Environment& a, const Environment& b) {
  return a.sky == b.sky && a.up == b.up && a.rotation == b.rotation && a.intensity == b.intensity;
}

/// Returns whether the environment lights objects.
bool gives_light(const Environment& environment) {
  return environment.has_sky() ? environment.intensity > 0.0F : environment.ambient != vec3(0.0F);
}

/// At least the largest alignment that Vulkan allows a device to require for a texel view, in bytes.
constexpr uint64_t kTexelViewAlignment = 256;

EmitterGeometry geometry_of(const PackedScene& packed, std::span<const layout::Node> records) {
  return {packed.primitives, packed.surfaces.surfaces, records, packed.surfaces.vertices.uvs};
}

/// Writes the records of instances behind the nodes.
void write_records(gpu::Buffer& nodes, const UpperLevel& level, std::span<const uint32_t> order, uint64_t first) {
  if (order.empty()) return;
  nodes.write_by(
      [&](std::span<std::byte> bytes) {
        level.put_records(order, {reinterpret_cast<layout::Node*>(bytes.data()), bytes.size() / sizeof(layout::Node)});
      },
      order.size() * layout::INSTANCE_RECORDS * sizeof(layout::Node), first * sizeof(layout::Node));
}

gpu::Buffer upload_nodes(const gpu::Device& device, const PackedScene& packed) {
  const std::span<const std::byte> nodes = std::as_bytes(packed.tree().nodes);
  gpu::Buffer buffer(device, nodes.size() + packed.record_bytes(), kStorageOrTexels);
  buffer.write(nodes);
  if (packed.upper) write_records(buffer, *packed.upper, packed.instance_order, packed.first_instance);
  return buffer;
}

/// Rounds the size of the stack up, so that scenes of about the same depth share pipelines.
uint32_t round_stack(uint32_t entries) {
  return next_multiple(entries, 8U);
}

template <typename... Parts>
uint64_t total_bytes(const Parts&... parts) {
  return (std::as_bytes(std::span(parts)).size() + ...);
}

}  // namespace

struct DeviceScene::PlacedTail {
  Placed materials;
  Placed texture_slots;
  Placed extensions;
  Placed glasses;
  Placed lobe_tables;
  Placed sky;
  /// Lights and other sources come last, because their number changes most often.
  Placed lights;
  /// They follow the lights without a gap.
  Placed tables;
  uint64_t end() const { return tables.end(); }
};

struct DeviceScene::PlacedHead {
  Placed surfaces;
  Placed normals;
  Placed colors;
  Placed uvs;
  Placed tangents;
  uint64_t end() const { return tangents.end(); }
  std::array<Placed, 5> parts() const { return {surfaces, normals, colors, uvs, tangents}; }
  std::array<uint64_t, 5> sizes() const {
    std::array<uint64_t, 5> sizes;
    std::ranges::transform(parts(), sizes.begin(), [](const Placed& placed) { return placed.bytes.size(); });
    return sizes;
  }
};

DeviceScene::PlacedHead DeviceScene::place_head(const PackedSurfaces& surfaces) {
  const VertexRecords& vertices = surfaces.vertices;
  PlacedHead head;
  head.surfaces = place(surfaces.surfaces, 0);
  head.normals = place(vertices.normals, head.surfaces.end());
  head.colors = place(vertices.colors, head.normals.end());
  head.uvs = place(vertices.uvs, head.colors.end());
  head.tangents = place(vertices.tangents, head.uvs.end());
  return head;
}

DeviceScene::PlacedTail DeviceScene::place_tail(const Tail& tail) const {
  PlacedTail placed;
  placed.materials = place(tail.materials->records, head_bytes_);
  placed.texture_slots = place(tail.materials->slots, placed.materials.end());
  placed.extensions = place(tail.materials->extensions, placed.texture_slots.end());
  placed.glasses = place(tail.materials->glasses, placed.extensions.end());
  placed.lobe_tables = place(*tail.lobe_tables, placed.glasses.end());
  placed.sky = place(tail.sky->texels, placed.lobe_tables.end());
  placed.lights = place(tail.lights.records, placed.sky.end());
  placed.tables = place(tail.lights.tables, placed.lights.end());
  return placed;
}

DeviceScene::DeviceScene(const gpu::Device& device, const PackedScene& packed, const ShadingParts& shading)
    : device_(&device),
      nodes_(upload_nodes(device, packed)),
      primitives_(upload(device, std::as_bytes(std::span(packed.primitives)))),
      node_texels_(nodes_.make_texel_view()),
      primitive_texels_(primitives_.make_texel_view()),
      emitter_ranges_(packed),
      stack_size_(round_stack(packed.stack_size)),
      is_mostly_solids_(packed.solid_count > packed.bounded_count / 2) {
  const PlacedHead head = place_head(packed.surfaces);
  head_sizes_ = head.sizes();
  const Placed image_words = place(packed.surfaces.images.words, next_multiple(head.end(), kTexelViewAlignment));
  constants_.first_index.z = head.normals.first_index;
  constants_.first_index.w = head.colors.first_index;
  constants_.first_texture = uvec4(head.uvs.first_index, head.tangents.first_index, 0, image_words.first_index);
  image_words_offset_ = image_words.offset;
  image_words_bytes_ = image_words.bytes.size();
  textures_.assign(shading.textures.begin(), shading.textures.end());
  images_ = packed.surfaces.images.images;
  head_bytes_ = image_words.end();
  take_tree(packed);
  constants_.glass_solids = shading.glass_solids;
  take_colors(shading.environment);
  Tail tail{std::make_shared<const PackedMaterials>(pack_materials(shading.materials)),
            lobe_tables_for(shading.materials), std::make_shared<const PackedSky>(pack_sky(shading.environment)),
            pack_lights(shading.lights)};
  lights_.assign(shading.lights.begin(), shading.lights.end());
  materials_.assign(shading.materials.begin(), shading.materials.end());
  emission_maps_ = make_emission_maps(packed.surfaces.images, textures_, materials_);
  uv_count_ = packed.surfaces.vertices.uvs.size();
  const bool needs_records = packed.upper != nullptr && std::ranges::any_of(materials_, emits_light);
  const UnsetVector<layout::Node> records =
      needs_records ? packed.upper->make_records(packed.instance_order) : UnsetVector<layout::Node>();
  find_emissive(geometry_of(packed, records));
  put_direct_sources(tail, shading.environment);
  take_shading_buffer(make_shading_buffer(place_tail(tail).end()));
  for (const Placed& placed : head.parts()) write(*shading_, placed);
  write(*shading_, image_words);
  write_tail(std::move(tail));
  uploads_.geometry = nodes_.size_bytes() + primitives_.size_bytes() + head_bytes_;
}

void DeviceScene::set_materials(std::span<const Material> materials) {
  replace({.materials = materials});
}

void DeviceScene::set_lights(std::span<const Light> lights) {
  replace({.lights = lights});
}

void DeviceScene::set_environment(const Environment& environment) {
  const bool has_other_sources =
      !are_skies_equal(environment, environment_) || gives_light(environment) != gives_light(environment_);
  if (has_other_sources) return replace({.environment = &environment});
  take_colors(environment);
}

DeviceScene::NewParts DeviceScene::parts_of(const ShadingParts& shading) {
  return {.materials = shading.materials, .lights = shading.lights, .environment = &shading.environment};
}

void DeviceScene::replace(const NewParts& parts) {
  Tail tail = tail_;
  bool must_find = parts.have_instances_moved && std::ranges::any_of(materials_, emits_light);
  if (parts.materials) {
    const std::span<const Material> materials = *parts.materials;
    tail.materials = std::make_shared<const PackedMaterials>(pack_materials(materials));
    tail.lobe_tables = lobe_tables_for(materials);
    bool is_new = false;
    for (size_t i = 0; i < materials.size(); ++i) {
      is_new = is_new || (emits_light(materials[i]) && !emits_light(materials_[i]));
    }
    materials_.assign(materials.begin(), materials.end());
    must_find = must_find || is_new;
  }
  if (parts.geometry != nullptr) {
    find_emissive(*parts.geometry);
  } else if (must_find) {
    find_emissive_again();
  }
  if (parts.lights) {
    tail.lights = pack_lights(*parts.lights);
    lights_.assign(parts.lights->begin(), parts.lights->end());
  }
  const Environment& environment = parts.environment == nullptr ? environment_ : *parts.environment;
  if (!are_skies_equal(environment, environment_)) tail.sky = std::make_shared<const PackedSky>(pack_sky(environment));
  put_direct_sources(tail, environment);
  write_tail(std::move(tail));
  if (parts.environment != nullptr) take_colors(environment);
}

void DeviceScene::reserve_nodes(uint64_t count, uint64_t kept) {
  const uint64_t bytes = count * sizeof(layout::Node);
  if (bytes <= nodes_.size_bytes()) return;
  gpu::Buffer larger(*device_, bytes, kStorageOrTexels);
  if (kept > 0) larger.copy_from(nodes_, kept * sizeof(layout::Node));
  vk::raii::BufferView texels = larger.make_texel_view();
  node_texels_ = std::move(texels);
  nodes_ = std::move(larger);
  choose_texels();
  ++version_;
}

void DeviceScene::reserve_stack(uint32_t entries) {
  if (entries <= stack_size_) return;
  stack_size_ = round_stack(entries);
  ++version_;
}

void DeviceScene::set_upper_level(const UpperLevel& level, const UpperNodes& upper, const ShadingParts* shading) {
  constexpr uint64_t kNodeBytes = sizeof(layout::Node);
  reserve_nodes(upper.first_record + upper.record_count(), level.first_node());
  reserve_stack(upper.stack_size);
  nodes_.write(std::as_bytes(std::span(&upper.root, 1)));
  if (!upper.nodes.empty()) nodes_.write(std::as_bytes(std::span(upper.nodes)), level.first_node() * kNodeBytes);
  write_records(nodes_, level, upper.order, upper.first_record);
  uploads_.moves += (1 + upper.nodes.size() + upper.record_count()) * kNodeBytes;
  constants_.tree_bounds = center_and_radius(upper.bounds);
  if (shading != nullptr) constants_.glass_solids = shading->glass_solids;
  emitter_ranges_.first_instance = upper.first_record;
  NewParts parts = shading == nullptr ? NewParts() : parts_of(*shading);
  parts.have_instances_moved = true;
  replace(parts);
}

bool DeviceScene::has_space_for(const PackedScene& packed) const {
  const auto fits = [](uint64_t size, uint64_t space) { return size == space || (size > 0 && size < space); };
  return packed.upper == nullptr && std::as_bytes(std::span(packed.primitives)).size() == primitives_.size_bytes() &&
         std::ranges::equal(place_head(packed.surfaces).sizes(), head_sizes_, fits) &&
         (packed.solid_count > packed.bounded_count / 2) == is_mostly_solids_;
}

void DeviceScene::set_geometry(PackedScene& packed, const ShadingParts& shading) {
  VertexRecords& vertices = packed.surfaces.vertices;
  size_t part = 1;  // The first one has no vertices, but the surfaces.
  for (std::vector<vec4>* records : {&vertices.normals, &vertices.colors, &vertices.uvs, &vertices.tangents}) {
    records->resize(head_sizes_[part++] / sizeof(vec4));
  }
  const TreeView tree = packed.tree();
  reserve_nodes(tree.nodes.size(), 0);
  reserve_stack(packed.stack_size);
  const PlacedHead head = place_head(packed.surfaces);
  nodes_.write(std::as_bytes(tree.nodes));
  primitives_.write(std::as_bytes(std::span(packed.primitives)));
  for (const Placed& placed : head.parts()) write(*shading_, placed);
  uploads_.geometry += tree.nodes.size_bytes() + primitives_.size_bytes() + head.end();
  take_tree(packed);
  constants_.glass_solids = shading.glass_solids;
  emitter_ranges_ = EmitterRanges(packed);
  const EmitterGeometry geometry = geometry_of(packed, {});
  NewParts parts = parts_of(shading);
  parts.geometry = &geometry;
  replace(parts);
}

void DeviceScene::take_tree(const PackedScene& packed) {
  constants_.tree_bounds = packed.tree_bounds;
  constants_.first_unbounded = packed.first_unbounded();
  constants_.unbounded_count = packed.unbounded_count;
}

std::shared_ptr<const std::vector<uvec4>> DeviceScene::lobe_tables_for(std::span<const Material> materials) const {
  std::vector<uvec4> tables = make_tables(materials);
  // The tables are the same for all scenes, so existing tables are not written again.
  if (tables == *tail_.lobe_tables) return tail_.lobe_tables;
  return std::make_shared<const std::vector<uvec4>>(std::move(tables));
}

void DeviceScene::put_direct_sources(Tail& tail, const Environment& environment) {
  PackedLights& lights = tail.lights;
  lights.records.resize(lights.light_count);
  lights.numbers.resize(lights.light_count);
  DirectSources direct = pack_direct_sources(lights_, emissive_, materials_, constants_.tree_bounds.w);
  lights.first_direct = direct.are_lights_chosen ? lights.light_count : 0;
  for (const layout::LightRecord& record : direct.records) {
    lights.records.push_back(record);
    lights.numbers.push_back(direct.are_lights_chosen ? ExplainedSource::kChosen : ExplainedSource::kSurfaces);
  }
  if (gives_light(environment)) {
    layout::LightRecord record{};
    record.kind = uvec4(layout::LIGHT_SKY, tail.sky->pyramid_levels, 0, tail.sky->first_of_pyramid);
    lights.records.push_back(record);
    lights.numbers.push_back(ExplainedSource::kSky);
  }
  // The tables follow the records, and elements that are lights are counted from the first source.
  const auto sources = static_cast<uint32_t>(lights.records.size()) - lights.first_direct;
  const uint32_t first_texel = layout::LIGHT_TEXELS * sources;
  for (uint32_t i = 0; i < direct.records.size(); ++i) lights.records[lights.light_count + i].kind.w += first_texel;
  for (size_t i = 1; i < direct.table.size(); i += layout::EMITTER_TEXELS) {
    if (direct.table[i].y == layout::EMITTER_IS_LIGHT) direct.table[i].x -= lights.first_direct;
  }
  lights.tables = std::move(direct.table);
  are_lights_chosen_ = direct.are_lights_chosen;
  source_features_ = {};
  if (direct.has_surfaces && !direct.are_rectangles) source_features_ |= layout::FEATURE_EMITTERS;
  if (direct.has_surfaces && emissive_.are_rectangles) source_features_ |= layout::FEATURE_RECT_EMITTERS;
  // A light that is switched on later needs no other kernel.
  if (direct.may_choose_lights) source_features_ |= layout::FEATURE_CHOSEN_LIGHTS;
}

bool DeviceScene::has_light_with_size() const {
  return std::ranges::any_of(lights_, [](const Light& light) { return light.is_on && has_size(light); });
}

void DeviceScene::find_emissive(const EmitterGeometry& geometry) {
  emissive_ = find_emissive_surfaces(geometry, emitter_ranges_, materials_, {textures_, emission_maps_});
}

UnsetVector<layout::Node> DeviceScene::read_records() const {
  UnsetVector<layout::Node> records;
  records.resize(size_t{emitter_ranges_.instance_count} * layout::INSTANCE_RECORDS);
  if (!records.empty()) {
    nodes_.read(std::as_writable_bytes(std::span(records)), emitter_ranges_.first_instance * sizeof(layout::Node));
  }
  return records;
}

void DeviceScene::find_emissive_again() {
  const UnsetVector<layout::Node> records = read_records();
  std::vector<layout::Primitive> primitives(primitives_.size_bytes() / sizeof(layout::Primitive));
  std::vector<layout::SurfaceRecord> surfaces(primitives.size());
  primitives_.read(std::as_writable_bytes(std::span(primitives)));
  shading_->read(std::as_writable_bytes(std::span(surfaces)));
  std::vector<vec4> uvs(uv_count_);
  if (!uvs.empty()) {
    shading_->read(std::as_writable_bytes(std::span(uvs)), uint64_t{constants_.first_texture.x} * sizeof(vec4));
  }
  find_emissive({primitives, surfaces, records, uvs});
}

std::span<const uint32_t> DeviceScene::source_numbers(Integrator integrator) const {
  const std::span<const uint32_t> numbers = tail_.lights.numbers;
  const uint32_t first = integrator == Integrator::kWhitted ? 0 : tail_.lights.first_direct;
  return numbers.subspan(first);
}

void DeviceScene::take_colors(const Environment& environment) {
  constants_.ambient = environment.ambient;
  constants_.background = environment.background;
  constants_.shows_sky = environment.shows_sky && environment.has_sky();
  constants_.backdrop = environment.shows_backdrop() ? environment.backdrop : std::nullopt;
  environment_ = environment;
}

uint64_t DeviceScene::size_bytes() const {
  const uint64_t tail_bytes = total_bytes(tail_.materials->records, tail_.materials->slots, tail_.materials->extensions,
                                          tail_.materials->glasses, *tail_.lobe_tables, tail_.sky->texels,
                                          tail_.lights.records, tail_.lights.tables);
  return nodes_.size_bytes() + primitives_.size_bytes() + head_bytes_ + tail_bytes;
}

std::vector<gpu::BoundBuffer> DeviceScene::geometry() const {
  return {
      {layout::BINDING_NODES, vk::DescriptorType::eStorageBuffer, &nodes_},
      {layout::BINDING_PRIMITIVES, vk::DescriptorType::eStorageBuffer, &primitives_},
      {layout::BINDING_NODE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &nodes_, &node_texels_},
      {layout::BINDING_PRIMITIVE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &primitives_, &primitive_texels_}};
}

std::vector<gpu::BoundBuffer> DeviceScene::shading() const {
  return {{layout::BINDING_SHADING, vk::DescriptorType::eStorageBuffer, &*shading_},
          {layout::BINDING_SHADING_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &*shading_, &shading_texels_},
          {layout::BINDING_TEXTURE_TEXELS, vk::DescriptorType::eUniformTexelBuffer, &*shading_, &image_texels_, true}};
}

gpu::Buffer DeviceScene::make_shading_buffer(uint64_t tail_end) const {
  // The buffer has space for some more lights, so that switching them on needs no larger buffer.
  constexpr uint64_t kSpareBytes = 16 * sizeof(layout::LightRecord);
  const uint64_t bytes = tail_end + kSpareBytes;
  // Texels of images are single words. A view of them therefore holds fewer bytes than one with texels of four words:
  // a quarter.
  const vk::PhysicalDeviceLimits& limits = device_->limits();
  const uint64_t most_words_bytes =
      std::max<uint64_t>(limits.maxStorageBufferRange, limits.maxTexelBufferElements * sizeof(uint32_t));
  const bool is_too_large =
      bytes > gpu::Buffer::most_bytes(*device_, kStorageOrTexels) ||
      (image_words_bytes_ / sizeof(uint32_t) > limits.maxTexelBufferElements && bytes > limits.maxStorageBufferRange);
  if (image_words_bytes_ > 0 && is_too_large) {
    throw RunError({"device.textures.large",
                    "the scene's textures need " + std::to_string(image_words_bytes_ >> 20) +
                        " MiB, and the device allows " + std::to_string(most_words_bytes >> 20) + " MiB for textures",
                    "", "lower the memory for textures", Setting::kTextureMemory});
  }
  return {*device_, bytes, kStorageOrTexels};
}

void DeviceScene::take_shading_buffer(gpu::Buffer buffer) {
  vk::raii::BufferView texels = buffer.make_texel_view();
  // Without images the view contains words that nothing reads.
  vk::raii::BufferView image_texels =
      buffer.make_word_view(image_words_bytes_ == 0 ? 0 : image_words_offset_,
                            std::max<vk::DeviceSize>(image_words_bytes_, sizeof(uint32_t)));
  shading_texels_ = std::move(texels);
  image_texels_ = std::move(image_texels);
  shading_.emplace(std::move(buffer));
  choose_texels();
}

void DeviceScene::choose_texels() {
  const bool holds_images = image_words_bytes_ / sizeof(uint32_t) <= device_->limits().maxTexelBufferElements;
  fetches_texels_ = holds_images && std::max({nodes_.size_bytes(), primitives_.size_bytes(), shading_->size_bytes()}) <=
                                        device_->profile().most_texel_bytes;
}

PackedMaterials DeviceScene::pack_materials(std::span<const Material> materials) const {
  return promin::pack_materials(materials, {textures_, images_});
}

void DeviceScene::write_tail(Tail tail) {
  const PlacedTail placed = place_tail(tail);
  const PlacedTail last = place_tail(tail_);
  const bool needs_larger = shading_->size_bytes() < placed.end();
  if (needs_larger) {
    gpu::Buffer larger = make_shading_buffer(placed.end());
    larger.copy_from(*shading_, head_bytes_);
    take_shading_buffer(std::move(larger));
  }
  for (const auto part :
       {&PlacedTail::materials, &PlacedTail::texture_slots, &PlacedTail::extensions, &PlacedTail::glasses,
        &PlacedTail::lobe_tables, &PlacedTail::sky, &PlacedTail::lights, &PlacedTail::tables}) {
    if (!needs_larger && is_same(placed.*part, last.*part)) continue;
    write(*shading_, placed.*part);
    uploads_.shading += (placed.*part).bytes.size();
  }
  constants_.first_index.x = placed.materials.first_index;
  constants_.first_index.y = placed.lights.first_index;
  constants_.first_lookup =
      uvec4(placed.lobe_tables.first_index, placed.sky.first_index, tail.sky->side, placed.extensions.first_index);
  constants_.first_texture.z = placed.texture_slots.first_index;
  constants_.first_glass.x = placed.glasses.first_index;
  constants_.has_glass = std::ranges::any_of(tail.materials->glasses, [](const layout::GlassRecord& glass) {
    return (glass.bits.x & layout::GLASS_IS_CLEAR) != 0;
  });
  constants_.media.clear();
  for (const layout::MaterialRecord& record : tail.materials->records) {
    const uint32_t number = std::bit_cast<uint32_t>(record.emissive.w) >> layout::MATERIAL_GLASS_SHIFT;
    const uint32_t bits = number == 0 ? 0 : tail.materials->glasses[number - 1].bits.x;
    const bool is_medium = (bits & (layout::GLASS_IS_CLEAR | layout::GLASS_IS_THIN)) == layout::GLASS_IS_CLEAR;
    constants_.media.push_back(is_medium ? number : 0);
  }
  constants_.irradiance = tail.sky->irradiance;
  const auto direct_count = static_cast<uint32_t>(tail.lights.records.size()) - tail.lights.first_direct;
  const bool has_other_sources = constants_.light_count != tail.lights.light_count ||
                                 constants_.first_direct != tail.lights.first_direct ||
                                 constants_.direct_count != direct_count;
  if (needs_larger || has_other_sources) ++version_;
  constants_.light_count = tail.lights.light_count;
  constants_.first_direct = tail.lights.first_direct;
  constants_.direct_count = direct_count;
  tail_ = std::move(tail);
}

std::shared_ptr<DeviceScene> upload_scene(const gpu::Device& device, const PackedScene& packed,
                                          const ShadingParts& shading) {
  std::shared_ptr<DeviceScene> scene;
  gpu::translate_vulkan_errors([&] { scene = std::make_shared<DeviceScene>(device, packed, shading); });
  return scene;
}

}  // namespace promin
