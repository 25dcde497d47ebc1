// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/load_gltf.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>

#include "formats/gltf/cameras.h"
#include "formats/gltf/document.h"
#include "formats/gltf/instances.h"
#include "formats/gltf/json_lookup.h"
#include "formats/gltf/lights.h"
#include "formats/gltf/materials.h"
#include "formats/gltf/meshes.h"
#include "formats/gltf/nodes.h"
#include "formats/gltf/shapes.h"
#include "formats/gltf/skins.h"
#include "formats/gltf/variants.h"

namespace promin {
namespace {

using nlohmann::json;

/// The largest number of triangles of a scene. Nodes may show one mesh many times, so the file's size does not limit
/// it.
constexpr uint64_t kMaxTriangles = uint64_t{1} << 28;
/// The largest number of objects. Objects are numbered in 32 bits, and the last two numbers mean "no object".
constexpr uint64_t kMaxObjects = (uint64_t{1} << 32) - 2;

/// Converts the nodes of a document to a scene.
class SceneReader {
 public:
  SceneReader(const GltfDocument& document, bool decodes_images, LoadReport& report)
      : document_(document), decodes_images_(decodes_images), report_(report) {}

  Scene read() {
    scene_.file = report_.file();
    scene_.variants = list_gltf_variants(document_.json);
    scene_.extensions = document_.extensions;
    GltfTextures textures(document_, decodes_images_, report_);
    scene_.materials = read_gltf_materials(document_, textures, report_);
    read_gltf_sky(document_, scene_, report_);
    const std::vector<PlacedNode> placed_nodes = place_gltf_nodes(document_, report_);
    skins_.emplace(document_, placed_nodes, report_);
    for (const PlacedNode& placed : placed_nodes) read_node(placed);
    const auto is_phong = [](const Material& material) { return std::holds_alternative<Phong>(material.model); };
    scene_.is_classic = !scene_.materials.empty() && std::ranges::all_of(scene_.materials, is_phong);
    if (scene_.materials.empty()) scene_.materials.push_back(default_gltf_material());
    warn_about_motion();
    report_.throw_if_refused();
    textures.finish(scene_);
    report_.throw_if_refused();
    scene_.warnings = report_.warnings();
    return std::move(scene_);
  }

 private:
  void read_node(const PlacedNode& placed) {
    if (const auto camera = read_gltf_camera(document_, placed, report_)) scene_.cameras.push_back(*camera);
    if (placed.is_visible) {
      if (const auto light = read_gltf_light(document_, placed, report_)) scene_.lights.push_back(*light);
    }
    const GltfNode& node = document_.nodes[static_cast<size_t>(placed.node)];
    if (node.mesh < 0) return;
    if (is_skinned(node)) return read_skinned_mesh(placed);
    const std::optional<uint64_t> instance_count = count_gltf_instances(document_, placed);
    if (!instance_count) return read_mesh(placed);
    if (*instance_count == 0 || !has_room_for(*instance_count, placed)) return;
    for (const dmat4& place : place_gltf_instances(document_, placed, report_)) {
      read_mesh({placed.node, place, placed.rotation, placed.is_visible});
    }
  }

  bool is_skinned(const GltfNode& node) const { return node.skin >= 0 && skins_->has_joints(node.skin); }

  /// Reads a skinned mesh. The node that shows it does not determine its place (glTF 2.0, section 3.7.3.3).
  void read_skinned_mesh(const PlacedNode& placed) {
    if (count_gltf_instances(document_, placed)) {
      report_.warn({"gltf.skin.instances", "a skinned mesh has instances", "",
                    "nodes[" + std::to_string(placed.node) + "]", "",
                    "promin draws it once, in the pose of its joints"});
    }
    const GltfPose& pose = skins_->find(document_.nodes[static_cast<size_t>(placed.node)].skin);
    PlacedNode posed = placed;
    posed.world_from_object = pose.world_from_mesh;
    posed.is_visible = placed.is_visible && !pose.is_hidden;
    read_mesh(posed);
  }

  /// Returns whether there is space for a node's instances, before any of them is added.
  bool has_room_for(uint64_t instance_count, const PlacedNode& placed) {
    const auto mesh = static_cast<size_t>(document_.nodes[static_cast<size_t>(placed.node)].mesh);
    const uint64_t primitive_count = document_.meshes[mesh].primitives.size();
    uint64_t triangle_count = 0;
    for (size_t i = 0; i < primitive_count; ++i) triangle_count += count_gltf_triangles(document_, mesh, i);
    // The code divides, because products may not fit into 64 bits.
    const uint64_t triangle_room = kMaxTriangles - std::min(triangle_count_, kMaxTriangles);
    const bool has_room = triangle_count <= triangle_room / instance_count &&
                          primitive_count <= (kMaxObjects - scene_.objects.size()) / instance_count;
    if (has_room) return true;
    report_.refuse("scene.size.limit",
                   "the mesh has too many instances (" + std::to_string(instance_count) + "), triangles (" +
                       std::to_string(triangle_count) + ") or primitives (" + std::to_string(primitive_count) +
                       ") for a scene",
                   "nodes[" + std::to_string(placed.node) + "]", "use fewer instances, or a simpler mesh");
    return false;
  }

  void read_mesh(const PlacedNode& placed) {
    const GltfNode& node = document_.nodes[static_cast<size_t>(placed.node)];
    const auto mesh = static_cast<size_t>(node.mesh);
    const GltfMesh& source = document_.meshes[mesh];
    for (size_t primitive = 0; primitive < source.primitives.size(); ++primitive) {
      Object object;
      object.name = node.name.empty() ? source.name : node.name;
      // Some files hide a node with a scale of 0.
      const bool is_shown = placed.is_visible && !has_no_area(placed.world_from_object);
      if (is_shown) read_geometry(placed, mesh, primitive, object);
      if (object.geometry == Object::kNoGeometry) {
        if (is_shown) report_.lose_geometry();
      } else {
        object.material = read_material(source.primitives[primitive].material, scene_.geometries[object.geometry]);
      }
      scene_.objects.push_back(std::move(object));
    }
  }

  void read_geometry(const PlacedNode& placed, size_t mesh, size_t primitive, Object& object) {
    if (std::optional<Geometry> shape = read_gltf_shape(document_, mesh, primitive, placed, report_)) {
      object.geometry = add(std::move(*shape));
      object.world_from_object = placed.world_from_object;
      return;
    }
    if (triangle_count_ > kMaxTriangles) return;
    const uint32_t geometry = find_mesh(placed.node, primitive);
    if (geometry == Object::kNoGeometry) return;
    triangle_count_ += primitive_count(scene_.geometries[geometry]);
    if (triangle_count_ > kMaxTriangles) {
      report_.refuse("scene.size.limit", "the scene has more than " + std::to_string(kMaxTriangles) + " triangles",
                     "nodes[" + std::to_string(placed.node) + "]", "use the mesh in fewer nodes, or simplify it");
    }
    place_gltf_mesh(placed, geometry,
                    "meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]", scene_,
                    object, report_);
  }

  uint32_t add(Geometry geometry) {
    scene_.geometries.push_back(std::move(geometry));
    return static_cast<uint32_t>(scene_.geometries.size() - 1);
  }

  /// Returns the geometry of a primitive of a node's mesh; kNoGeometry if nothing is drawn. The geometry is read once
  /// for all nodes with the same morph weights and the same skin.
  uint32_t find_mesh(int node, size_t primitive) {
    const GltfNode& shown = document_.nodes[static_cast<size_t>(node)];
    const auto mesh = static_cast<size_t>(shown.mesh);
    const std::vector<double>& weights = shown.weights ? *shown.weights : document_.meshes[mesh].weights;
    const int skin = is_skinned(shown) ? shown.skin : -1;
    const auto [known, is_new] = mesh_geometries_.try_emplace({mesh, primitive, weights, skin}, Object::kNoGeometry);
    if (is_new) {
      const GltfPose* pose = skin < 0 ? nullptr : &skins_->find(skin);
      Mesh triangles = read_gltf_mesh(document_, mesh, primitive, weights, pose, report_);
      if (!triangles.triangles.empty()) known->second = add(std::move(triangles));
    }
    return known->second;
  }

  uint32_t read_material(int material, const Geometry& geometry) {
    if (material >= 0) {
      const auto index = static_cast<size_t>(material);
      const auto* mesh = std::get_if<Mesh>(&geometry);
      if (mesh != nullptr && !mesh->colors.empty() &&
          find_extension(document_.json["materials"][index], "KHR_materials_unlit") != nullptr) {
        report_.warn("material " + title_of(document_.json, "materials", index) +
                     " is unlit; the vertex colours of its meshes are ignored");
      }
      return static_cast<uint32_t>(material);
    }
    if (default_material_ == kNoMaterial) {
      default_material_ = static_cast<uint32_t>(scene_.materials.size());
      scene_.materials.push_back(default_gltf_material());
    }
    return default_material_;
  }

  void warn_about_motion() {
    const auto has_targets = [](const GltfPrimitive& primitive) { return !primitive.targets.empty(); };
    const auto is_morphed = [&](const GltfMesh& mesh) { return std::ranges::any_of(mesh.primitives, has_targets); };
    std::string parts;
    const auto say = [&](const char* part) { parts += (parts.empty() ? ": " : ", ") + std::string(part); };
    if (!elements_of(document_.json, "animations").empty()) say("animations are ignored");
    if (std::ranges::any_of(document_.meshes, is_morphed)) say("morph targets have their default weights");
    if (!parts.empty()) report_.warn("the scene does not move" + parts);
  }

  static constexpr uint32_t kNoMaterial = std::numeric_limits<uint32_t>::max();

  const GltfDocument& document_;
  bool decodes_images_;
  LoadReport& report_;
  Scene scene_;
  std::optional<GltfSkins> skins_;
  std::map<std::tuple<size_t, size_t, std::vector<double>, int>, uint32_t> mesh_geometries_;
  uint64_t triangle_count_ = 0;
  uint32_t default_material_ = kNoMaterial;
};

}  // namespace

Scene load_gltf(const LoadOptions& options, LoadReport& report) {
  GltfDocument document = read_gltf_document(options, report);
  if (!options.material_variant.empty()) choose_gltf_variant(document, options.material_variant, report.file());
  return SceneReader(document, options.decodes_images, report).read();
}

}  // namespace promin
