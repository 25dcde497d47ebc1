// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/load_gltf.h"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <utility>
#include <variant>

#include "core/count_of.h"
#include "core/rounding.h"
#include "formats/gltf/animations.h"
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
#include "motion/deform.h"
#include "motion/node_state.h"
#include "motion/place_mesh.h"
#include "motion/skin.h"
#include "promin/motion.h"
#include "scene/limits.h"

namespace promin {
namespace {

using nlohmann::json;

/// The largest number of triangles of all meshes. Views of buffers may overlap, so the file's size does not limit it.
constexpr uint64_t kMaxTriangles = uint64_t{1} << 28;
/// The largest number of objects. Nodes may show one mesh many times, so the file's size does not limit it.
constexpr uint64_t kMaxObjects = uint64_t{1} << 24;

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
    const std::vector<PlacedNode> placed_nodes = place_gltf_nodes(document_, motion_.nodes, report_);
    motion_.animations = read_gltf_animations(document_, motion_.nodes, report_);
    animated_ = find_gltf_animated(motion_.animations, motion_.nodes, scene_.materials.size());
    skins_.emplace(document_, report_);
    if (!elements_of(document_.json, "skins").empty()) {
      world_from_node_ = promin::place_nodes(motion_.nodes, report_.center());
    }
    for (const PlacedNode& placed : placed_nodes) read_node(placed);
    const auto is_phong = [](const Material& material) { return std::holds_alternative<Phong>(material.model); };
    scene_.is_classic = !scene_.materials.empty() && std::ranges::all_of(scene_.materials, is_phong);
    if (scene_.materials.empty()) scene_.materials.push_back(default_gltf_material());
    link_materials();
    report_.throw_if_refused();
    textures.finish(scene_);
    report_.throw_if_refused();
    scene_.warnings = report_.warnings();
    motion_.skins = skins_->take();
    scene_.motion = std::make_shared<const Motion>(std::move(motion_));
    return std::move(scene_);
  }

 private:
  void read_node(const PlacedNode& placed) {
    if (auto camera = read_gltf_camera(document_, placed, report_)) {
      scene_.cameras.push_back(camera->rest);
      motion_.cameras.push_back(std::move(*camera));
    }
    // A light that an animation may show keeps its number while it is hidden.
    if (placed.is_visible || animated_.is_hidden[placed.index]) {
      for (const auto& read : {read_gltf_light, read_gltf_area_light}) {
        auto light = read(document_, placed, report_);
        if (!light) continue;
        light->rest.is_on = placed.is_visible;
        scene_.lights.push_back(light->rest);
        motion_.lights.push_back(std::move(*light));
      }
    }
    const GltfNode& node = document_.nodes[static_cast<size_t>(placed.node)];
    if (node.mesh < 0) return;
    if (is_skinned(node)) return read_skinned_mesh(placed);
    const std::optional<uint64_t> instance_count = count_gltf_instances(document_, placed);
    if (!instance_count) return read_mesh(placed);
    if (*instance_count == 0 || !has_room_for(*instance_count, placed)) return;
    const size_t object_count = *instance_count * document_.meshes[static_cast<size_t>(node.mesh)].primitives.size();
    reserve(scene_.objects, object_count);
    const bool is_posed = may_change(placed);
    if (is_posed) reserve(motion_.places, *instance_count);
    size_t number = 0;
    for (const dmat4& place : place_gltf_instances(document_, placed, report_)) {
      PlacedNode instance = placed;
      instance.world_from_object = placed.world_from_object * place;
      if (!is_finite(instance.world_from_object)) {
        report_.refuse("gltf.node.far", "an instance's place in the world overflows",
                       "nodes[" + std::to_string(placed.node) + "], instance " + std::to_string(number),
                       "use smaller translations and scales");
        return;
      }
      ++number;
      if (is_posed) motion_.places.push_back(place);
      read_mesh(instance, is_posed ? static_cast<uint32_t>(motion_.places.size() - 1) : kNoIndex);
    }
  }

  /// Reserves space for more values, and at least as much as adding them one by one would reserve.
  template <typename Value>
  static void reserve(std::vector<Value>& values, size_t more) {
    if (values.size() + more <= values.capacity()) return;
    values.reserve(values.empty() ? more : std::max(values.size() + more, 2 * values.capacity()));
  }

  bool is_skinned(const GltfNode& node) const { return node.skin >= 0 && skins_->has_joints(node.skin); }

  /// Reads a skinned mesh. The node that shows it does not determine its place (glTF 2.0, section 3.7.3.3).
  void read_skinned_mesh(const PlacedNode& placed) {
    if (count_gltf_instances(document_, placed)) {
      report_.warn({"gltf.skin.instances", "a skinned mesh has instances", "",
                    "nodes[" + std::to_string(placed.node) + "]", "",
                    "promin draws it once, in the pose of its joints"});
    }
    const PosedSkin& pose = pose_of_skin(placed);
    PlacedNode posed = placed;
    posed.world_from_object = pose.world_from_mesh;
    posed.is_visible = placed.is_visible && !pose.is_hidden;
    read_mesh(posed);
  }

  const PosedSkin& pose_of_skin(const PlacedNode& placed) {
    return skins_->find(document_.nodes[static_cast<size_t>(placed.node)].skin, world_from_node_);
  }

  /// Returns whether there is space for a node's instances, before any of them is added.
  bool has_room_for(uint64_t instance_count, const PlacedNode& placed) {
    const auto mesh = static_cast<size_t>(document_.nodes[static_cast<size_t>(placed.node)].mesh);
    const uint64_t primitive_count = document_.meshes[mesh].primitives.size();
    const uint64_t room = kMaxObjects - std::min<uint64_t>(scene_.objects.size(), kMaxObjects);
    // The code divides, because the product may not fit into 64 bits.
    if (primitive_count <= room / instance_count) return true;
    report_.refuse("scene.size.limit",
                   "the scene has " + std::to_string(scene_.objects.size()) + " objects, and then " +
                       std::to_string(instance_count) + " instances of a mesh with " +
                       count_of(primitive_count, "primitive"),
                   "nodes[" + std::to_string(placed.node) + "]",
                   "use fewer, because promin supports at most " + std::to_string(kMaxObjects) + " objects");
    return false;
  }

  /// `place` is the index of an instance's transform in Motion::places.
  void read_mesh(const PlacedNode& placed, uint32_t place = kNoIndex) {
    const GltfNode& node = document_.nodes[static_cast<size_t>(placed.node)];
    const auto mesh = static_cast<size_t>(node.mesh);
    const GltfMesh& source = document_.meshes[mesh];
    for (size_t primitive = 0; primitive < source.primitives.size(); ++primitive) {
      Object object;
      object.name = node.name.empty() ? source.name : node.name;
      ObjectLink link{.node = placed.index, .place = place};
      if (is_skinned(node)) link.skin = static_cast<uint32_t>(node.skin);
      // Some files hide a node with a scale of 0.
      const bool is_shown = placed.is_visible && !has_no_area(placed.world_from_object);
      if (is_shown) {
        read_geometry(placed, mesh, primitive, object, link);
      } else if (may_be_shown(placed)) {
        read_hidden_geometry(placed, mesh, primitive, link);
      }
      const uint32_t geometry = object.geometry != Object::kNoGeometry ? object.geometry : link.geometry;
      if (object.geometry == Object::kNoGeometry && is_shown) report_.lose_geometry();
      if (geometry != kNoIndex) {
        object.material = read_material(source.primitives[primitive].material, scene_.geometries[geometry]);
      } else if (link.mesh != kNoIndex) {
        object.material = read_material(source.primitives[primitive].material, motion_.meshes[link.mesh]->base);
      }
      scene_.objects.push_back(std::move(object));
      // Links take memory, and objects without a link rest.
      if (!may_change(placed)) continue;
      motion_.objects.resize(scene_.objects.size());
      motion_.objects.back() = link;
    }
  }

  /// Returns whether an animation may show a hidden node.
  bool may_be_shown(const PlacedNode& placed) const {
    return animated_.is_moved[placed.index] || (placed.is_visible && has_moved_joint(placed));
  }

  /// Returns whether an animation may change the place, the form or the visibility of a node's mesh.
  bool may_change(const PlacedNode& placed) const {
    return animated_.is_moved[placed.index] || animated_.is_morphed[placed.index] || has_moved_joint(placed);
  }

  bool has_moved_joint(const PlacedNode& placed) const {
    const GltfNode& node = document_.nodes[static_cast<size_t>(placed.node)];
    if (!is_skinned(node)) return false;
    const json& joints = document_.json["skins"][static_cast<size_t>(node.skin)]["joints"];
    return std::ranges::any_of(joints, [&](const json& joint) { return animated_.is_moved[joint.get<size_t>()]; });
  }

  void read_geometry(const PlacedNode& placed, size_t mesh, size_t primitive, Object& object, ObjectLink& link) {
    if (std::optional<Geometry> shape = read_gltf_shape(document_, mesh, primitive, placed, report_)) {
      object.geometry = link.geometry = add(std::move(*shape));
      object.world_from_object = placed.world_from_object;
      const bool has_mesh = document_.meshes[mesh].primitives[primitive].attributes.contains("POSITION");
      // Another pose may distort the shape.
      if (animated_.is_moved[placed.index] && has_mesh) link.fallback = find_mesh(placed, primitive).posed;
      return;
    }
    const uint32_t geometry = connect_mesh(placed, primitive, link);
    if (geometry == Object::kNoGeometry) return;
    const auto [box, is_new] = boxes_.try_emplace(geometry);
    if (is_new) box->second = bounds_of_positions(std::get<Mesh>(scene_.geometries[geometry]));
    place_gltf_mesh(placed, geometry, box->second, place_of(mesh, primitive), scene_, object, report_);
  }

  /// Reads the geometry of an object that is hidden in the nodes' own pose.
  void read_hidden_geometry(const PlacedNode& placed, size_t mesh, size_t primitive, ObjectLink& link) {
    PlacedNode unscaled = placed;
    if (has_no_area(placed.world_from_object)) unscaled.world_from_object = dmat4(1.0);
    if (std::optional<Geometry> shape = read_gltf_shape(document_, mesh, primitive, unscaled, report_)) {
      link.geometry = add(std::move(*shape));
      const bool has_mesh = document_.meshes[mesh].primitives[primitive].attributes.contains("POSITION");
      if (has_mesh) link.fallback = find_mesh(placed, primitive).posed;
      return;
    }
    connect_mesh(placed, primitive, link);
  }

  /// Returns the geometry of a mesh in the nodes' own pose, and connects its object with it; Object::kNoGeometry if
  /// there is none, or if the scene has too many triangles already.
  uint32_t connect_mesh(const PlacedNode& placed, size_t primitive, ObjectLink& link) {
    if (triangle_count_ > kMaxTriangles) return Object::kNoGeometry;
    const KnownMesh known = find_mesh(placed, primitive);
    if (known.posed == Object::kNoGeometry) return Object::kNoGeometry;
    connect(known, link);
    count_triangles(known.posed, placed);
    return known.posed;
  }

  static std::string place_of(size_t mesh, size_t primitive) {
    return "meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(primitive) + "]";
  }

  void count_triangles(uint32_t geometry, const PlacedNode& placed) {
    if (!counted_.insert(geometry).second) return;
    triangle_count_ += primitive_count(scene_.geometries[geometry]);
    if (triangle_count_ <= kMaxTriangles) return;
    report_.refuse("scene.size.limit", "the scene has more than " + std::to_string(kMaxTriangles) + " triangles",
                   "nodes[" + std::to_string(placed.node) + "]", "simplify its meshes");
  }

  uint32_t add(Geometry geometry) {
    scene_.geometries.push_back(std::move(geometry));
    return static_cast<uint32_t>(scene_.geometries.size() - 1);
  }

  /// A mesh that was read.
  struct KnownMesh {
    /// Index of the geometry in the nodes' own pose; kNoGeometry if nothing is drawn.
    uint32_t posed = Object::kNoGeometry;
    /// Index into Motion::meshes; kNoIndex for a mesh that keeps its form.
    uint32_t source = kNoIndex;
  };

  static void connect(const KnownMesh& known, ObjectLink& link) {
    (known.source == kNoIndex ? link.geometry : link.mesh) = known.source == kNoIndex ? known.posed : known.source;
  }

  /// Returns a primitive of a node's mesh. The mesh is read once for all nodes that need the same parts of it, and
  /// deformed once for all nodes with the same morph weights and the same skin.
  KnownMesh find_mesh(const PlacedNode& placed, size_t primitive) {
    const GltfNode& shown = document_.nodes[static_cast<size_t>(placed.node)];
    const auto mesh = static_cast<size_t>(shown.mesh);
    const std::vector<double>& weights = motion_.nodes[static_cast<size_t>(placed.node)].weights;
    const int skin = is_skinned(shown) ? shown.skin : -1;
    GltfMeshNeeds needs;
    needs.targets = has_morph(weights) || animated_.is_morphed[placed.index];
    if (skin >= 0) needs.joint_count = elements_of(document_.json["skins"][static_cast<size_t>(skin)], "joints").size();
    const auto [known, is_new] = posed_meshes_.try_emplace({mesh, primitive, needs, weights, skin});
    if (!is_new) return known->second;
    const auto [read, is_unread] = read_meshes_.try_emplace({mesh, primitive, needs});
    if (is_unread) read->second = read_source(mesh, primitive, needs);
    known->second = read->second;
    if (known->second.source == kNoIndex) return known->second;
    const DeformingMesh& source = *motion_.meshes[known->second.source];
    known->second.posed = Object::kNoGeometry;
    Mesh posed = deform(source, weights, skin < 0 ? std::span<const dmat4>{} : pose_of_skin(placed).joint_matrices);
    if (std::ranges::all_of(posed.positions, [](const vec3& p) { return is_in_range(dvec3(p)); })) {
      if (drop_vanished_normals(posed)) warn_of_normals(place_of(mesh, primitive), report_);
      known->second.posed = add(std::move(posed));
    } else {
      report_.refuse("gltf.position.far", "a vertex lies beyond 1e15 in the world",
                     "nodes[" + std::to_string(placed.node) + "]",
                     "use smaller weights of morph targets, or a smaller translation or scale of joints");
    }
    return known->second;
  }

  /// Reads a mesh. A mesh that keeps its form becomes a geometry of the scene.
  KnownMesh read_source(size_t mesh, size_t primitive, const GltfMeshNeeds& needs) {
    DeformingMesh source = read_gltf_mesh(document_, mesh, primitive, needs, report_);
    if (source.base.triangles.empty()) return {};
    if (source.targets.empty() && source.influences.per_vertex == 0) return {.posed = add(std::move(source.base))};
    motion_.meshes.push_back(std::make_shared<const DeformingMesh>(std::move(source)));
    return {.source = static_cast<uint32_t>(motion_.meshes.size() - 1)};
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

  void link_materials() {
    for (uint32_t i = 0; i < animated_.is_material_changed.size(); ++i) {
      if (!animated_.is_material_changed[i]) continue;
      const json& source = document_.json["materials"][i];
      MaterialLink link{.material = i, .rest = scene_.materials[i]};
      link.emissive = vec3_of(source, "emissiveFactor", dvec3(0.0));
      if (const json* extension = find_extension(source, "KHR_materials_emissive_strength")) {
        link.emissive_strength = extension->value("emissiveStrength", 1.0);
      }
      link.textures = read_gltf_texture_links(source);
      motion_.materials.push_back(std::move(link));
    }
  }

  static constexpr uint32_t kNoMaterial = std::numeric_limits<uint32_t>::max();

  const GltfDocument& document_;
  bool decodes_images_;
  LoadReport& report_;
  Scene scene_;
  Motion motion_;
  GltfAnimated animated_;
  std::optional<GltfSkins> skins_;
  /// The transforms of all nodes, if the file has skins.
  std::vector<dmat4> world_from_node_;
  std::map<std::tuple<size_t, size_t, GltfMeshNeeds>, KnownMesh> read_meshes_;
  std::map<std::tuple<size_t, size_t, GltfMeshNeeds, std::vector<double>, int>, KnownMesh> posed_meshes_;
  /// The bounds of the positions of each mesh that an object shows.
  std::map<uint32_t, Bounds> boxes_;
  /// The number of triangles of all meshes.
  uint64_t triangle_count_ = 0;
  /// The geometries that were counted.
  std::set<uint32_t> counted_;
  uint32_t default_material_ = kNoMaterial;
};

}  // namespace

Scene load_gltf(const LoadOptions& options, LoadReport& report) {
  GltfDocument document = read_gltf_document(options, report);
  if (!options.material_variant.empty()) choose_gltf_variant(document, options.material_variant, report.file());
  return SceneReader(document, options.decodes_images, report).read();
}

}  // namespace promin
