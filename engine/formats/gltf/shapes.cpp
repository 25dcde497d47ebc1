// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/shapes.h"

#include <algorithm>
#include <string>

#include "core/json_text.h"
#include "formats/gltf/json_lookup.h"
#include "promin/load_scene.h"
#include "scene/limits.h"
#include "shapes/shapes.h"

namespace promin {
namespace {

using nlohmann::json;

class ShapeReader {
 public:
  ShapeReader(const json& shapes, size_t index, const PlacedNode& placed, LoadReport& report)
      : shape_(shapes["shapes"][index]),
        title_(title_of(shapes, "shapes", index)),
        place_("extensions.KHR_implicit_shapes.shapes[" + std::to_string(index) + "]"),
        node_(placed.node),
        at_(placed.world_from_object),
        report_(report) {}

  std::optional<Geometry> read() {
    const std::string type = shape_["type"];
    if (type == "sphere") return read_sphere();
    if (type == "cylinder") return read_cylinder();
    if (type == "plane") return read_plane();
    if (type == "box") return read_box();
    return read_capsule();
  }

 private:
  std::optional<Geometry> fall_back(const std::string& reason) {
    report_.warn("shape " + title_ + " " + reason + ": the mesh that replaces it is drawn");
    return std::nullopt;
  }

  std::optional<Geometry> fall_back_from_transform() {
    return fall_back("is distorted by the transform of nodes[" + std::to_string(node_) + "]");
  }

  double parameter(const char* name, double otherwise) const {
    const auto parameters = shape_.find(shape_["type"].get<std::string>());
    return parameters == shape_.end() ? otherwise : parameters->value(name, otherwise);
  }

  /// Returns the shape after checking its form in the world. Returns nullopt if the node's transform distorts it.
  template <class Described>
  std::optional<Geometry> check(const Described& shape) {
    if (!place(shape, at_)) return fall_back_from_transform();
    const std::string node = "nodes[" + std::to_string(node_) + "]";
    const dvec3 magnitude = glm::abs(center_of(shape, at_));
    if (!(std::max({magnitude.x, magnitude.y, magnitude.z}) <= kMaxCoordinate)) {
      report_.refuse("gltf.shape.far", "shape " + title_ + " lies beyond 1e15 in the world", node,
                     "use a smaller translation in it and its parents");
    }
    for (const NamedSize& size : sizes_of(shape, at_)) {
      if (is_valid(size)) continue;
      report_.refuse("gltf.shape.size",
                     "the " + std::string(size.name) + " of shape " + title_ + " is " + json_text(json(size.size)) +
                         " in the world",
                     node, "use a scale that keeps it between 1e-22 and 1e15");
    }
    return shape;
  }

  std::optional<Geometry> read_sphere() { return check(Sphere{dvec3(0.0), parameter("radius", 0.5)}); }

  std::optional<Geometry> read_cylinder() {
    const double top = parameter("radiusTop", 0.25);
    const double bottom = parameter("radiusBottom", 0.25);
    if (is_line(top, bottom)) return Cone();
    const double half_height = 0.5 * parameter("height", 0.5);
    if (top == bottom) return check(Cylinder{dvec3(0.0), kAxis, half_height, bottom});
    return check(Cone{dvec3(0.0), kAxis, half_height, bottom, top});
  }

  std::optional<Geometry> read_capsule() {
    const double top = parameter("radiusTop", 0.25);
    const double bottom = parameter("radiusBottom", 0.25);
    if (is_line(top, bottom)) return Capsule();
    return check(Capsule{dvec3(0.0), kAxis, 0.5 * parameter("height", 0.5), bottom, top});
  }

  bool is_line(double top, double bottom) {
    if (top != 0.0 || bottom != 0.0) return false;
    report_.refuse("gltf.shape.size", "both radii of shape " + title_ + " are 0",
                   place_ + "." + shape_["type"].get<std::string>(), "make radiusTop or radiusBottom positive");
    return true;
  }

  std::optional<Geometry> read_plane() {
    if (shape_.contains("plane") && (shape_["plane"].contains("sizeX") || shape_["plane"].contains("sizeZ"))) {
      return fall_back("is a plane that has sizes");
    }
    const Plane plane;
    if (!place(plane, at_)) {
      report_.refuse("gltf.shape.flat", "the scale flattens plane " + title_, "nodes[" + std::to_string(node_) + "]",
                     "use a scale other than 0");
      return plane;
    }
    return check(plane);
  }

  std::optional<Geometry> read_box() {
    dvec3 size(1.0);
    if (const auto box = shape_.find("box"); box != shape_.end() && box->contains("size")) {
      for (int i = 0; i < 3; ++i) size[i] = (*box)["size"][static_cast<size_t>(i)];
    }
    return check(Box{dvec3(0.0), 0.5 * size});
  }

  static constexpr dvec3 kAxis{0.0, 1.0, 0.0};

  const json& shape_;
  std::string title_;
  std::string place_;
  int node_;
  Placement at_;
  LoadReport& report_;
};

}  // namespace

std::optional<Geometry> read_gltf_shape(const GltfDocument& document, size_t mesh, size_t primitive,
                                        const PlacedNode& placed, LoadReport& report) {
  const json* link =
      find_extension(document.json["meshes"][mesh]["primitives"][primitive], "PROMIN_mesh_primitive_implicit_shape");
  if (link == nullptr) return std::nullopt;
  const auto& extension = document.json["extensions"]["KHR_implicit_shapes"];
  return ShapeReader(extension, (*link)["shape"], placed, report).read();
}

}  // namespace promin
