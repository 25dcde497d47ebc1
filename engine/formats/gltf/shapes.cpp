// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/shapes.h"

#include <algorithm>
#include <string>

#include "formats/gltf/json_lookup.h"
#include "promin/load_scene.h"

namespace promin {
namespace {

using nlohmann::json;

/// How far a transform may be from a similarity, relative to its scale: transforms that went through fp32 are off by
/// 1e-6, and a shape that is off by 1e-5 of its size is off by less than a pixel.
constexpr double kShapeTolerance = 1e-5;

/// What a node's transform does to a shape that stands along Y.
struct Placement {
  dvec3 center;
  dvec3 x, y, z;
  double radial_scale;
  double axial_scale;

  explicit Placement(const dmat4& m)
      : center(m[3]), x(m[0]), y(m[1]), z(m[2]), radial_scale(glm::length(x)), axial_scale(glm::length(y)) {}

  /// Circles around the axis stay circles around an axis at right angles.
  bool keeps_cylinders() const {
    return is_close(glm::length(z), radial_scale) && is_right_angle(x, y) && is_right_angle(y, z) &&
           is_right_angle(z, x);
  }
  bool keeps_spheres() const { return keeps_cylinders() && is_close(axial_scale, radial_scale); }

 private:
  static bool is_close(double a, double b) { return std::abs(a - b) <= kShapeTolerance * std::max(a, b); }
  static bool is_right_angle(const dvec3& a, const dvec3& b) {
    return std::abs(glm::dot(a, b)) <= kShapeTolerance * glm::length(a) * glm::length(b);
  }
};

class ShapeReader {
 public:
  ShapeReader(const json& shapes, size_t index, const PlacedNode& placed, LoadReport& report)
      : shape_(shapes["shapes"][index]),
        title_(title_of(shapes, "shapes", index)),
        place_("extensions.KHR_implicit_shapes.shapes[" + std::to_string(index) + "]"),
        node_(placed.node),
        at_(placed.world_from_object),
        report_(report) {}

  std::optional<Shape> read() {
    const std::string type = shape_["type"];
    if (type == "sphere") return read_sphere();
    if (type == "cylinder") return read_cylinder();
    if (type == "plane") return read_plane();
    return fall_back("is a " + type + ", which is no analytic shape here");
  }

 private:
  std::optional<Shape> fall_back(const std::string& reason) {
    report_.warn("shape " + title_ + " " + reason + ": the mesh in its place is drawn");
    return std::nullopt;
  }

  std::optional<Shape> fall_back_from_transform() {
    return fall_back("does not keep its form under the transform of nodes[" + std::to_string(node_) + "]");
  }

  double parameter(const char* name, double otherwise) const {
    const auto parameters = shape_.find(shape_["type"].get<std::string>());
    return parameters == shape_.end() ? otherwise : parameters->value(name, otherwise);
  }

  /// A size in the world; `size` 0 is allowed where it is an apex.
  float check_size(double size, const char* name, bool may_be_zero = false) {
    const bool is_valid = (size >= kMinSize || (may_be_zero && size == 0.0)) && size <= kMaxCoordinate;
    if (!is_valid) {
      report_.refuse("the " + std::string(name) + " of shape " + title_ + " is " + json(size).dump() + " in the world",
                     "nodes[" + std::to_string(node_) + "]", "use a scale that leaves it between 1e-22 and 1e15");
    }
    return static_cast<float>(size);
  }

  vec3 check_center() {
    const dvec3 magnitude = glm::abs(at_.center);
    if (!(std::max({magnitude.x, magnitude.y, magnitude.z}) <= kMaxCoordinate)) {
      report_.refuse("shape " + title_ + " lies beyond 1e15 in the world", "nodes[" + std::to_string(node_) + "]",
                     "use a smaller translation in it and its parents");
    }
    return vec3(at_.center);
  }

  std::optional<Shape> read_sphere() {
    if (!at_.keeps_spheres()) return fall_back_from_transform();
    return Sphere{check_center(), check_size(parameter("radius", 0.5) * at_.radial_scale, "radius")};
  }

  std::optional<Shape> read_cylinder() {
    const double top = parameter("radiusTop", 0.25);
    const double bottom = parameter("radiusBottom", 0.25);
    if (top == 0.0 && bottom == 0.0) {
      report_.refuse("both radii of shape " + title_ + " are 0", place_ + ".cylinder",
                     "make radiusTop or radiusBottom positive");
      return NotDrawn{};
    }
    if (!at_.keeps_cylinders()) return fall_back_from_transform();
    const vec3 center = check_center();
    const vec3 axis(at_.y / at_.axial_scale);
    const float half_height = check_size(0.5 * parameter("height", 0.5) * at_.axial_scale, "half height");
    const float radius_bottom = check_size(bottom * at_.radial_scale, "radius", bottom == 0.0);
    const float radius_top = check_size(top * at_.radial_scale, "radius", top == 0.0);
    if (top == bottom) return Cylinder{center, axis, half_height, radius_bottom};
    return Cone{center, axis, half_height, radius_bottom, radius_top};
  }

  std::optional<Shape> read_plane() {
    if (shape_.contains("plane") && (shape_["plane"].contains("sizeX") || shape_["plane"].contains("sizeZ"))) {
      return fall_back("is a plane with sizes");
    }
    // The normal goes with the inverse transpose, which a mirroring transform turns over.
    const dvec3 normal = glm::cross(at_.z, at_.x);
    const double length = glm::length(normal);
    if (!(length > 0.0) || !std::isfinite(length)) {
      report_.refuse("the scale leaves nothing of plane " + title_, "nodes[" + std::to_string(node_) + "]",
                     "use a scale other than 0");
      return NotDrawn{};
    }
    const double sign = glm::dot(normal, at_.y) < 0.0 ? -1.0 : 1.0;
    return Plane{check_center(), vec3(sign / length * normal)};
  }

  const json& shape_;
  std::string title_;
  std::string place_;
  int node_;
  Placement at_;
  LoadReport& report_;
};

}  // namespace

std::optional<Shape> read_gltf_shape(const GltfDocument& document, size_t mesh, size_t primitive,
                                     const PlacedNode& placed, LoadReport& report) {
  const json* link =
      find_extension(document.json["meshes"][mesh]["primitives"][primitive], "PROMIN_mesh_primitive_implicit_shape");
  if (link == nullptr) return std::nullopt;
  const auto& extension = document.json["extensions"]["KHR_implicit_shapes"];
  return ShapeReader(extension, (*link)["shape"], placed, report).read();
}

}  // namespace promin
