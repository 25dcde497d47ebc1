// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/scene_json.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <vector>

#include "core/hash.h"
#include "core/json_text.h"
#include "core/parse_number.h"
#include "output/work_names.h"
#include "promin/motion.h"
#include "scene/members.h"
#include "work/pictures/scene_counts.h"

namespace promin::app {
namespace {

// The JSON type whose objects sort their keys.
using Json = nlohmann::json;

template <typename Element>
Json hash_of(const std::vector<Element>& elements) {
  if (elements.empty()) return nullptr;
  Hash64 hash;
  hash.add(elements.size());
  hash.add(std::as_bytes(std::span(elements)));
  return fmt::format("{:016x}", hash.value());
}

Json json_value(bool value) {
  return value;
}

template <typename Number>
Json json_value(Number value) {
  if constexpr (std::is_integral_v<Number>) return value;
  if (!std::isfinite(value)) return nullptr;
  // The shortest decimal text of an fp32 number is used, because the number converted to double has many more digits.
  return to_number<double>(fmt::format("{}", value)).value_or(0.0);
}

template <int N, typename Number>
Json json_value(const glm::vec<N, Number, glm::defaultp>& value) {
  Json list = Json::array();
  for (int i = 0; i < N; ++i) list.push_back(json_value(value[i]));
  return list;
}

/// Fills an object of JSON from a struct.
class JsonWriter {
 public:
  template <typename Record>
  static Json write(Record record) {
    JsonWriter writer;
    visit_members(writer, record);
    return std::move(writer.json_);
  }

  template <typename Value>
  void field(const std::string& name, Value& value) {
    if constexpr (std::is_enum_v<Value>) {
      json_[name] = names_of(value)[static_cast<size_t>(value)];
    } else {
      json_[name] = json_value(value);
    }
  }
  void field(const std::string& name, std::string& value) { json_[name] = value; }
  void field(const std::string& name, std::optional<Backdrop>& backdrop) {
    json_[name] = backdrop ? write(*backdrop) : Json();
  }
  void field(const std::string& name, TextureSlot& slot) { json_[name] = slot.exists() ? write(slot) : Json(); }
  void field(const std::string& name, MaterialModel& model) {
    json_[name] = kModelNames[model.index()];
    std::visit([&](const auto& one) { json_.update(write(one)); }, model);
  }
  void field(const std::string& name, SkyModel& sky) {
    if (sky.index() > 0) json_[name] = std::visit([](const auto& one) { return write(one); }, sky);
    json_[name]["kind"] = kSkyNames[sky.index()];
  }
  void field(const std::string& name, std::shared_ptr<const Image>& image) {
    json_[name] = {{"size", json_value(image->size)}, {"hash", hash_of(image->pixels)}};
  }

 private:
  Json json_ = Json::object();
};

template <typename Record>
Json list_of(const std::vector<Record>& records) {
  Json list = Json::array();
  for (const Record& record : records) list.push_back(JsonWriter::write(record));
  return list;
}

Json describe(const Mesh& mesh) {
  return {{"vertices", mesh.positions.size()},
          {"triangles", mesh.triangles.size()},
          {"hashes",
           {{"positions", hash_of(mesh.positions)},
            {"normals", hash_of(mesh.normals)},
            {"colors", hash_of(mesh.colors)},
            {"uvs", hash_of(mesh.uvs)},
            {"tangents", hash_of(mesh.tangents)},
            {"triangles", hash_of(mesh.triangles)},
            {"triangle_materials", hash_of(mesh.triangle_materials)}}}};
}

template <typename Shape>
Json describe(const Shape& shape) {
  return JsonWriter::write(shape);
}

Json describe(const Geometry& geometry) {
  Json json = std::visit([](const auto& one) { return describe(one); }, geometry);
  json["kind"] = kShapeNames[geometry.index()];
  return json;
}

/// Writes a matrix column by column.
Json describe(const dmat4& matrix) {
  if (matrix == dmat4(1.0)) return nullptr;
  Json list = Json::array();
  for (int i = 0; i < 16; ++i) list.push_back(json_value(matrix[i / 4][i % 4]));
  return list;
}

Json list_objects(const Scene& scene) {
  std::vector<Json> geometries;
  for (const Geometry& geometry : scene.geometries) geometries.push_back(describe(geometry));
  Json list = Json::array();
  for (uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const bool is_drawn = object.geometry != Object::kNoGeometry;
    list.push_back({{"name", object.name},
                    {"number", i},
                    {"geometry", is_drawn ? geometries[object.geometry] : Json()},
                    {"material", is_drawn ? Json(object.material) : Json()},
                    {"world_from_object", is_drawn ? describe(object.world_from_object) : Json()}});
  }
  return list;
}

Json list_images(const Scene& scene) {
  Json list = Json::array();
  for (const auto& image : scene.images) {
    list.push_back({{"name", image->name},
                    {"size", json_value(image->size)},
                    {"use", names_of(image->use)[static_cast<size_t>(image->use)]},
                    {"hash", hash_of(image->texels)}});
  }
  return list;
}

Json describe(const SceneCounts& counts) {
  Json kinds = Json::object();
  for (size_t i = 0; i < counts.objects.size(); ++i) kinds[std::string(kObjectNames[i])] = counts.objects[i];
  return {{"objects", kinds},
          {"primitives", counts.primitives},
          {"triangles", counts.triangles},
          {"stored_triangles", counts.stored_triangles}};
}

Json describe(const Animation& animation) {
  Json channels = Json::object();
  for (const AnimationChannel& channel : animation.channels) {
    Json& count = channels[std::string(name_of(channel.property))];
    count = count.is_null() ? 1 : count.get<int>() + 1;
  }
  return {{"name", animation.name},
          {"duration_s", animation.duration_s},
          {"channels", channels},
          {"can_be_shown", animation.problems.empty()}};
}

Json describe(const Motion& motion) {
  Json animations = Json::array();
  for (const Animation& animation : motion.animations) animations.push_back(describe(animation));
  Json skins = Json::array();
  for (const Skin& skin : motion.skins) skins.push_back({{"name", skin.name}, {"joints", skin.joints.size()}});
  return {{"nodes", motion.nodes.size()},
          {"skins", skins},
          {"morph_targets", count_morphs(motion).targets},
          {"animations", animations}};
}

Json describe(const Bounds& bounds) {
  if (bounds.is_empty()) return nullptr;
  return {{"lo", json_value(bounds.lo)}, {"hi", json_value(bounds.hi)}};
}

}  // namespace

Json json_of(const Environment& environment) {
  return JsonWriter::write(environment);
}

Json json_of(const DisplayTransform& display) {
  return JsonWriter::write(display);
}

Json json_of(const Scene& scene) {
  return {{"file", scene.file.filename().string()},
          {"is_classic", scene.is_classic},
          {"counts", describe(count_scene(scene))},
          {"center", {scene.center.x, scene.center.y, scene.center.z}},
          {"bounds", describe(bounds_of(scene))},
          {"objects", list_objects(scene)},
          {"materials", list_of(scene.materials)},
          {"images", list_images(scene)},
          {"textures", list_of(scene.textures)},
          {"lights", list_of(scene.lights)},
          {"cameras", list_of(scene.cameras)},
          {"environment", json_of(scene.environment)},
          {"motion", scene.motion == nullptr ? Json() : describe(*scene.motion)},
          {"variants", scene.variants},
          {"extensions", list_of(scene.extensions)},
          {"warnings", scene.warnings}};
}

std::string write_json(const Json& json) {
  return json_text(json, 1) + "\n";
}

}  // namespace promin::app
