// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/nff/text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "formats/nff/tokens.h"
#include "formats/text_lines.h"
#include "formats/triangulate.h"
#include "promin/validate.h"
#include "promin/view.h"

namespace promin {
namespace {

/// The product of two is a factor of a material, of which fp32 and validate() take up to 1e15.
constexpr double kMostFactor = 1e7;
/// A view along its up to this sine has no top.
constexpr double kLeastSine = 1e-6;

class NffParser {
 public:
  NffParser(std::string_view text, LoadReport& report) : tokens_(text), report_(report) {}

  NffText parse() {
    while (!is_broken_ && !tokens_.next().empty()) read_statement(tokens_.take());
    return std::move(out_);
  }

 private:
  struct Statement {
    std::string_view keyword;
    /// What follows it, for messages.
    const char* form;
    void (NffParser::*read)();
  };

  void read_statement(std::string_view keyword) {
    static constexpr Statement kStatements[] = {
        {"p", "p and the number of corners, then x y z of each", &NffParser::read_polygon},
        {"pp", "pp and the number of corners, then x y z and a normal of each", &NffParser::read_patch},
        {"s", "s x y z radius", &NffParser::read_sphere},
        {"c", "c x y z radius of the base, then x y z radius of the apex", &NffParser::read_cone},
        {"f", "f red green blue Kd Ks Shine T index-of-refraction", &NffParser::read_material},
        {"l", "l x y z, and red green blue where it has a colour", &NffParser::read_light},
        {"b", "b red green blue", &NffParser::read_background},
        {"v", "v from x y z at x y z up x y z angle degrees hither distance resolution width height",
         &NffParser::read_view}};
    const auto* const found = std::ranges::find(kStatements, keyword, &Statement::keyword);
    if (found == std::end(kStatements)) {
      return refuse(quote(keyword) + " is no statement of NFF", "use v b l f c s p or pp, each with all its numbers");
    }
    statement_ = found;
    (this->*found->read)();
  }

  void refuse(const std::string& what, const std::string& cure) {
    if (!is_broken_) report_.refuse(what, tokens_.place(), cure);
    is_broken_ = true;
  }

  void refuse(const std::string& what) { refuse(what, std::string("write ") + statement_->form); }

  /// Takes the next word as a number; 0 once a problem is reported, here and below.
  double take_number(double least, double most, const char* range) {
    if (is_broken_) return 0.0;
    if (tokens_.next().empty()) {
      refuse("the file ends within " + quote(statement_->keyword));
      return 0.0;
    }
    const std::string_view word = tokens_.take();
    const std::optional<double> number = parse_number(word);
    if (number && *number >= least && *number <= most) return *number;
    refuse(quote(word) + " is no number " + range);
    return 0.0;
  }

  double take_coordinate() { return take_number(-kMaxCoordinate, kMaxCoordinate, "up to 1e15"); }
  float take_factor() { return static_cast<float>(take_number(0.0, kMostFactor, "from 0 to 1e7")); }

  // The order in which arguments are evaluated is the compiler's own, that of statements is not.
  dvec3 take_point() {
    dvec3 point;
    for (int i = 0; i < 3; ++i) point[i] = take_coordinate();
    return point;
  }
  dvec3 take_place() { return take_point() - report_.center(); }
  vec3 take_color() {
    vec3 color;
    for (int i = 0; i < 3; ++i) color[i] = take_factor();
    return color;
  }

  /// Takes a radius, of whose sign nothing is made but that it is told.
  double take_radius(bool may_be_zero) {
    const double radius = take_coordinate();
    const bool is_valid = std::abs(radius) >= kMinSize || (may_be_zero && radius == 0.0);
    if (!is_broken_ && !is_valid) refuse("the radius is 0 or too small", "give one from 1e-22 to 1e15");
    return radius;
  }

  void read_background() { out_.background = take_color(); }

  void read_light() {
    NffLight light{vec3(take_place())};
    if (parse_number(tokens_.next())) light.color = take_color();
    out_.lights.push_back(light);
  }

  void read_material() {
    NffMaterial material;
    material.color = take_color();
    material.diffuse = take_factor();
    material.specular = take_factor();
    material.shininess = static_cast<float>(take_number(0.0, kMaxCoordinate, "from 0 to 1e15"));
    material.transmittance = take_factor();
    material.ior = take_factor();
    // Only shapes make a group of it.
    material_ = material;
    is_group_open_ = false;
  }

  void add(const NffShape& shape) {
    if (is_broken_) return;
    if (!is_group_open_) out_.groups.push_back({material_});
    is_group_open_ = true;
    out_.groups.back().shapes.push_back(shape);
  }

  void read_sphere() {
    const dvec3 center = take_place();
    add(Sphere{center, std::abs(take_radius(false))});
  }

  void read_cone() {
    const dvec3 base = take_place();
    const double base_radius = take_radius(true);
    const dvec3 apex = take_place();
    const double apex_radius = take_radius(true);
    if (is_broken_) return;
    if (base_radius == 0.0 && apex_radius == 0.0) return refuse("both radii are 0", "give at least one another size");
    if (base_radius * apex_radius < 0.0) {
      return refuse("one radius is negative and the other is not", "give both the same sign");
    }
    const dvec3 center = 0.5 * (base + apex);
    const dvec3 axis = apex - base;
    const double half_height = 0.5 * glm::length(axis);
    if (!(half_height >= kMinSize && half_height <= kMaxCoordinate)) {
      return refuse("base and apex are one point, or too far from each other", "place them from 1e-22 to 1e15 apart");
    }
    if (base_radius == apex_radius) {
      add(Cylinder{center, axis, half_height, std::abs(base_radius), true});
    } else {
      add(Cone{center, axis, half_height, std::abs(base_radius), std::abs(apex_radius), true});
    }
  }

  void read_polygon() { read_corners(false); }
  void read_patch() { read_corners(true); }

  void read_corners(bool has_normals) {
    if (tokens_.next().empty()) return refuse("the file ends within " + quote(statement_->keyword));
    const std::string_view word = tokens_.take();
    const std::optional<int64_t> count = parse_integer(word);
    constexpr auto kMostCorners = static_cast<int64_t>(kMaxPolygonCorners);
    if (!count || *count < 3 || *count > kMostCorners) {
      return refuse(quote(word) + " is no number of corners", "give 3 to " + std::to_string(kMostCorners));
    }
    const NffPolygon polygon{out_.corners.size(), out_.normals.size(), static_cast<uint32_t>(*count), has_normals};
    for (int64_t i = 0; i < *count && !is_broken_; ++i) {
      out_.corners.emplace_back(take_place());
      if (has_normals) out_.normals.emplace_back(take_point());
    }
    add(polygon);
  }

  /// Its parts may come in any order, and some may be absent.
  void read_view() {
    std::optional<dvec3> from;
    std::optional<dvec3> at;
    std::optional<dvec3> up;
    Camera camera;
    camera.aspect_ratio = 1.0F;
    std::optional<double> angle;
    for (bool is_part = true; is_part && !is_broken_;) {
      const std::string_view part = tokens_.next();
      is_part =
          part == "from" || part == "at" || part == "up" || part == "angle" || part == "hither" || part == "resolution";
      if (is_part) tokens_.take();
      if (part == "from") from = take_place();
      if (part == "at") at = take_place();
      if (part == "up") up = take_point();
      if (part == "angle") angle = take_number(1e-3, 179.9, "of degrees from 0.001 to 179.9");
      if (part == "hither") camera.near = static_cast<float>(take_number(0.0, kMaxCoordinate, "from 0 to 1e15"));
      if (part == "resolution") camera.resolution = take_resolution();
    }
    if (is_broken_) return;
    if (!from || !at || !up || !angle) return refuse("a view is without from, at, up or angle");
    camera.yfov = static_cast<float>(glm::radians(*angle));
    if (camera.resolution.x > 0) {
      camera.aspect_ratio = static_cast<float>(camera.resolution.x) / static_cast<float>(camera.resolution.y);
    }
    const dvec3 look = glm::normalize(*at - *from);
    const dvec3 side = glm::cross(look, glm::normalize(*up));
    // Written so that NaN, which points in one place give, is refused too.
    if (!(glm::length(side) >= kLeastSine)) {
      return refuse("a view has from and at in one place, or an up that is 0 or along it",
                    "give two points and a direction across");
    }
    camera.eye = vec3(*from);
    camera.look = vec3(look);
    camera.up = vec3(glm::cross(glm::normalize(side), look));
    out_.cameras.push_back(camera);
  }

  uvec2 take_resolution() {
    uvec2 size(0);
    for (int i = 0; i < 2; ++i) {
      const double side = take_number(1.0, kMaxSide, "of pixels from 1 to 32768");
      if (!is_broken_ && side != std::floor(side)) refuse("a resolution is no whole number");
      size[i] = static_cast<uint32_t>(side);
    }
    return size;
  }

  NffTokens tokens_;
  LoadReport& report_;
  NffText out_;
  const Statement* statement_ = nullptr;
  std::optional<NffMaterial> material_;
  bool is_group_open_ = false;
  bool is_broken_ = false;
};

}  // namespace

NffText parse_nff_text(std::string_view text, LoadReport& report) {
  return NffParser(text, report).parse();
}

}  // namespace promin
