// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/nff/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

#include "formats/text_lines.h"
#include "formats/text_words.h"
#include "formats/triangulate.h"
#include "promin/validate.h"
#include "promin/view.h"

namespace promin {
namespace {

/// The largest factor in a file. A material's factor is the product of two such numbers, and fp32 and validate() allow
/// up to 1e15.
constexpr double kMostFactor = 1e7;
/// The smallest sine of the angle between view direction and up vector. With a smaller angle the view has no top.
constexpr double kLeastViewSine = 1e-6;

/// The words of a view statement.
constexpr std::string_view kViewParts[] = {"from", "at", "up", "angle", "hither", "resolution"};

class NffParser {
 public:
  NffParser(std::string_view text, LoadReport& report) : words_(text), report_(report) {}

  NffText parse() {
    while (!is_broken_ && !words_.next().empty()) read_statement(words_.take());
    return std::move(out_);
  }

 private:
  struct Statement {
    std::string_view keyword;
    /// The values that follow the statement, for messages.
    const char* form;
    void (NffParser::*read)();
    /// True if the statement is a shape. After a shape, the next statement begins behind the words that the shape
    /// needs.
    bool is_shape = true;
  };
  static constexpr size_t kStatementCount = 8;
  static const std::array<Statement, kStatementCount> kStatements;

  static const Statement* find_statement(std::string_view keyword) {
    const auto* const found = std::ranges::find(kStatements, keyword, &Statement::keyword);
    return found == kStatements.end() ? nullptr : found;
  }

  static bool is_view_part(std::string_view word) {
    return std::ranges::find(kViewParts, word) != std::end(kViewParts);
  }

  void read_statement(std::string_view keyword) {
    const Statement* found = find_statement(keyword);
    const bool is_further_number = statement_ != nullptr && !statement_->is_shape && parse_any_number(keyword);
    if (found == nullptr && is_further_number)
      return repair("nff.numbers.many", "has too many numbers", keyword, "they are ignored");
    if (found == nullptr) {
      return refuse("nff.statement.unknown", quote(keyword) + " is not a statement of NFF",
                    "use v, b, l, f, c, s, p or pp with all of its numbers");
    }
    statement_ = found;
    is_placed_ = true;
    (this->*found->read)();
  }

  void refuse(ProblemCode code, const std::string& what, const std::string& cure) {
    if (!is_broken_) report_.refuse(code, what, words_.place(), cure);
    is_broken_ = true;
  }

  void refuse(ProblemCode code, const std::string& what) {
    refuse(code, what, std::string("write ") + statement_->form);
  }

  /// Reports a repair of the statement. `what` is the part of the sentence about the statement.
  void repair(ProblemCode code, const std::string& what, std::string_view word, const std::string& repair) {
    report_.repair({code, quote(statement_->keyword) + " " + what, word.empty() ? "" : quote(word), words_.place(),
                    std::string("write ") + statement_->form, repair});
  }

  void leave_out(ProblemCode code, const std::string& what) {
    repair(code, what, {}, "promin omits it");
    if (statement_->is_shape) report_.lose_geometry();
  }

  /// Reads the next word as a number, which may be infinite or NaN; NaN if it is not a number. If another statement or
  /// another part of a view begins, the word is not consumed.
  double take_any_number() {
    if (is_broken_) return 0.0;
    if (words_.next().empty()) {
      refuse("nff.file.short", "the file ends within " + quote(statement_->keyword));
      return 0.0;
    }
    const bool is_other = find_statement(words_.next()) != nullptr || is_view_part(words_.next());
    word_ = is_other && !statement_->is_shape ? std::string_view() : words_.take();
    const std::optional<double> number = parse_any_number(word_);
    if (!number && statement_->is_shape) refuse("nff.number.wrong", quote(word_) + " is not a number");
    return number.value_or(std::numeric_limits<double>::quiet_NaN());
  }

  /// Reads a number in a range. Other numbers are reported and become the nearest one in the range, or the smallest.
  double take_number(double least, double most, const char* range) {
    const double number = take_any_number();
    if (is_broken_ || (number >= least && number <= most)) return number;
    if (word_.empty()) {
      repair("nff.numbers.few", "has too few numbers", {}, "the missing ones are set to the smallest value allowed");
    } else {
      repair("nff.number.range", std::string("has a number that is not ") + range, word_,
             "the nearest allowed value is used, or else the smallest");
    }
    return number > most ? most : least;
  }

  double take_coordinate() {
    const double number = take_any_number();
    // The comparison is written so that NaN fails.
    if (std::abs(number) <= kMaxCoordinate) return number;
    if (is_placed_ && !is_broken_) {
      repair("nff.position.range", "has a coordinate that is not a number up to 1e15", word_, "promin omits it");
      if (statement_->is_shape) report_.lose_geometry();
    }
    is_placed_ = false;
    return 0.0;
  }
  float take_factor() { return static_cast<float>(take_number(0.0, kMostFactor, "from 0 to 1e7")); }

  // Reads the coordinates in separate statements, because the order of evaluation of arguments is unspecified.
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

  /// Returns whether the whole statement was read without an error and has a valid position.
  bool is_good() const { return is_placed_ && !is_broken_; }

  /// Reads a radius. A wrong sign only causes a report.
  double take_radius(bool may_be_zero) {
    const double radius = take_coordinate();
    const bool is_valid = std::abs(radius) >= kMinSize || (may_be_zero && radius == 0.0);
    if (is_good() && !is_valid) {
      leave_out("nff.size.range", "has a radius that is 0 or too small");
      is_placed_ = false;
    }
    return radius;
  }

  void read_background() { out_.background = take_color(); }

  void read_light() {
    NffLight light{vec3(take_place())};
    if (parse_any_number(words_.next())) light.color = take_color();
    if (is_good()) out_.lights.push_back(light);
  }

  void read_material() {
    NffMaterial material;
    material.color = take_color();
    material.diffuse = take_factor();
    material.specular = take_factor();
    material.shininess = static_cast<float>(take_number(0.0, kMaxCoordinate, "from 0 to 1e15"));
    material.transmittance = take_factor();
    material.ior = take_factor();
    // A group with this material starts only if a shape follows.
    material_ = material;
    is_group_open_ = false;
  }

  void add(const NffShape& shape) {
    if (!is_good()) return;
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
    if (!is_good()) return;
    if (base_radius == 0.0 && apex_radius == 0.0) return leave_out("nff.size.range", "has two radii of 0");
    if (base_radius * apex_radius < 0.0)
      return leave_out("nff.size.range", "has one radius that is negative and one that is not");
    const dvec3 center = 0.5 * (base + apex);
    const dvec3 axis = apex - base;
    const double half_height = 0.5 * glm::length(axis);
    if (!(half_height >= kMinSize && half_height <= kMaxCoordinate)) {
      return leave_out("nff.size.range", "has a base and an apex that coincide or are too far apart");
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
    if (words_.next().empty()) return refuse("nff.file.short", "the file ends within " + quote(statement_->keyword));
    const std::string_view word = words_.take();
    const std::optional<int64_t> count = parse_integer(word);
    constexpr auto kMostCorners = static_cast<int64_t>(kMaxPolygonCorners);
    if (!count || *count < 0 || *count > kMostCorners) {
      return refuse("nff.corners.count", quote(word) + " is not a number of corners",
                    "give a whole number from 3 to " + std::to_string(kMostCorners));
    }
    const NffPolygon polygon{out_.corners.size(), out_.normals.size(), static_cast<uint32_t>(*count), has_normals};
    for (int64_t i = 0; i < *count && !is_broken_; ++i) {
      out_.corners.emplace_back(take_place());
      if (has_normals) out_.normals.push_back(take_normal());
    }
    if (*count >= 3) return add(polygon);
    if (is_good()) leave_out("nff.corners.count", "has fewer than 3 corners");
  }

  /// Reads a normal. Returns 0 if the numbers are not a direction.
  vec3 take_normal() {
    dvec3 normal;
    for (int i = 0; i < 3; ++i) normal[i] = take_any_number();
    // The comparison is written so that NaN fails.
    return glm::length(normal) <= kMaxCoordinate ? vec3(normal) : vec3(0.0F);
  }

  /// Reads a view. Its parts may be in any order, and some may be absent.
  void read_view() {
    std::optional<dvec3> from;
    std::optional<dvec3> at;
    std::optional<dvec3> up;
    Camera camera;
    camera.aspect_ratio = 1.0F;
    std::optional<double> angle;
    while (is_view_part(words_.next()) && !is_broken_) {
      const std::string_view part = words_.take();
      if (part == "from") from = take_place();
      if (part == "at") at = take_place();
      if (part == "up") up = take_point();
      if (part == "angle") angle = take_any_number();
      if (part == "hither") camera.near = static_cast<float>(take_number(0.0, kMaxCoordinate, "from 0 to 1e15"));
      if (part == "resolution") camera.resolution = take_resolution();
    }
    if (!is_good()) return;
    if (!from || !at || !up || !angle) return leave_out("nff.view.incomplete", "lacks from, at, up or angle");
    // The comparison is written so that NaN fails.
    if (!(*angle >= 1e-3 && *angle <= 179.9))
      return leave_out("nff.number.range", "has an angle that is not from 0.001 to 179.9 degrees");
    camera.yfov = static_cast<float>(glm::radians(*angle));
    if (camera.resolution.x > 0) {
      camera.aspect_ratio = static_cast<float>(camera.resolution.x) / static_cast<float>(camera.resolution.y);
    }
    const dvec3 look = glm::normalize(*at - *from);
    const dvec3 side = glm::cross(look, glm::normalize(*up));
    // The comparison is written so that NaN fails too; coinciding points give NaN.
    if (!(glm::length(side) >= kLeastViewSine)) {
      return leave_out("nff.view.direction",
                       "has equal points from and at, or a vector up that is 0 or parallel to the view");
    }
    camera.eye = vec3(*from);
    camera.look = vec3(look);
    camera.up = vec3(glm::cross(glm::normalize(side), look));
    out_.cameras.push_back(camera);
  }

  /// Reads a resolution. Returns 0 if the file has no valid resolution.
  uvec2 take_resolution() {
    dvec2 size;
    for (int i = 0; i < 2; ++i) size[i] = take_any_number();
    const auto is_side = [](double side) { return side >= 1.0 && side <= kMaxSide && side == std::floor(side); };
    if (is_broken_ || (is_side(size.x) && is_side(size.y))) return uvec2(size);
    repair("nff.resolution", "has a resolution that is not two whole numbers from 1 to 32768", {},
           "promin ignores its resolution");
    return uvec2(0);
  }

  TextWords words_;
  LoadReport& report_;
  NffText out_;
  const Statement* statement_ = nullptr;
  /// The last word that was read as a number; empty if there was none.
  std::string_view word_;
  /// True if the position of the statement is valid in the words read so far.
  bool is_placed_ = true;
  std::optional<NffMaterial> material_;
  bool is_group_open_ = false;
  bool is_broken_ = false;
};

const std::array<NffParser::Statement, NffParser::kStatementCount> NffParser::kStatements = {
    {{"p", "p and the number of corners, then x y z of each", &NffParser::read_polygon},
     {"pp", "pp and the number of corners, then x y z and a normal of each", &NffParser::read_patch},
     {"s", "s x y z radius", &NffParser::read_sphere},
     {"c", "c x y z radius of the base, then x y z radius of the apex", &NffParser::read_cone},
     {"f", "f red green blue Kd Ks Shine T index-of-refraction", &NffParser::read_material, false},
     {"l", "l x y z, and red green blue if the light has a colour", &NffParser::read_light, false},
     {"b", "b red green blue", &NffParser::read_background, false},
     {"v", "v from x y z at x y z up x y z angle degrees hither distance resolution width height",
      &NffParser::read_view, false}}};

}  // namespace

NffText parse_nff_text(std::string_view text, LoadReport& report) {
  return NffParser(text, report).parse();
}

}  // namespace promin
