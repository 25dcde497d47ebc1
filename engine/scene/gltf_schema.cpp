// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene/gltf_schema.h"

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "scene/load_scene.h"

namespace promin {
namespace {

using nlohmann::json;

enum class Kind { kObject, kArray, kText, kBoolean, kInteger, kNumber, kNumbers, kIndex, kChoice };

/// What must stand at a path. "[]" is every element of an array, "*" every member of an object.
struct Rule {
  std::string_view path;
  Kind kind = Kind::kObject;
  bool is_required = false;
  /// Range of integers and numbers, ends included.
  double lo = 0.0;
  double hi = 0.0;
  /// Length of kNumbers.
  size_t count = 0;
  /// kIndex: path of the array it points into. kChoice: the values, separated by '|'.
  std::string_view target = {};
};

constexpr Rule object(std::string_view path) {
  return {.path = path, .kind = Kind::kObject};
}
constexpr Rule array(std::string_view path) {
  return {.path = path, .kind = Kind::kArray};
}
constexpr Rule text(std::string_view path) {
  return {.path = path, .kind = Kind::kText};
}
constexpr Rule boolean(std::string_view path) {
  return {.path = path, .kind = Kind::kBoolean};
}
constexpr Rule index(std::string_view path, std::string_view target) {
  return {.path = path, .kind = Kind::kIndex, .target = target};
}
constexpr Rule choice(std::string_view path, std::string_view choices) {
  return {.path = path, .kind = Kind::kChoice, .target = choices};
}
constexpr Rule integer(std::string_view path, double lo, double hi) {
  return {.path = path, .kind = Kind::kInteger, .lo = lo, .hi = hi};
}
constexpr Rule number(std::string_view path, double lo, double hi) {
  return {.path = path, .kind = Kind::kNumber, .lo = lo, .hi = hi};
}
constexpr Rule numbers(std::string_view path, size_t count, double lo, double hi) {
  return {.path = path, .kind = Kind::kNumbers, .lo = lo, .hi = hi, .count = count};
}
/// A length: a size that fp32 arithmetic can square.
constexpr Rule length(std::string_view path) {
  return number(path, kMinSize, kMaxCoordinate);
}
constexpr Rule length_or_zero(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
/// Powers and factors of light are not negative, but may exceed 1.
constexpr Rule factor(std::string_view path) {
  return number(path, 0.0, kMaxCoordinate);
}
constexpr Rule color(std::string_view path) {
  return numbers(path, 3, 0.0, kMaxCoordinate);
}
constexpr Rule needed(Rule rule) {
  rule.is_required = true;
  return rule;
}

constexpr double kMaxBytes = 0x1p53;
constexpr double kMaxCount = 0x1p31 - 1.0;
constexpr double kMaxScalar = 1e30;
/// Exporters that think in fp32 write pi/2 a little too large.
constexpr double kHalfPi = 1.5707964;
constexpr double kPi = 3.141592653589793;
constexpr double kJustUnder = 1.0 - 0x1p-52;
constexpr double kTiny = 1e-9;

#define PROMIN_LIGHTS "extensions.KHR_lights_punctual.lights"
#define PROMIN_SHAPES "extensions.KHR_implicit_shapes.shapes"
#define PROMIN_SKIES "extensions.OMI_environment_sky.skies"
#define PROMIN_LINK "meshes[].primitives[].extensions.PROMIN_mesh_primitive_implicit_shape"
#define PROMIN_PHONG "materials[].extensions.PROMIN_materials_phong"

constexpr Rule kRules[] = {
    needed(object("asset")),
    needed(text("asset.version")),
    text("asset.minVersion"),
    array("extensionsUsed"),
    text("extensionsUsed[]"),
    array("extensionsRequired"),
    text("extensionsRequired[]"),

    array("scenes"),
    index("scene", "scenes"),
    object("scenes[]"),
    array("scenes[].nodes"),
    index("scenes[].nodes[]", "nodes"),

    array("nodes"),
    object("nodes[]"),
    text("nodes[].name"),
    array("nodes[].children"),
    index("nodes[].children[]", "nodes"),
    index("nodes[].mesh", "meshes"),
    index("nodes[].camera", "cameras"),
    numbers("nodes[].matrix", 16, -kMaxScalar, kMaxScalar),
    numbers("nodes[].translation", 3, -kMaxCoordinate, kMaxCoordinate),
    numbers("nodes[].rotation", 4, -kMaxScalar, kMaxScalar),
    numbers("nodes[].scale", 3, -kMaxScalar, kMaxScalar),

    array("meshes"),
    object("meshes[]"),
    text("meshes[].name"),
    needed(array("meshes[].primitives")),
    object("meshes[].primitives[]"),
    needed(object("meshes[].primitives[].attributes")),
    index("meshes[].primitives[].attributes.*", "accessors"),
    index("meshes[].primitives[].indices", "accessors"),
    index("meshes[].primitives[].material", "materials"),
    integer("meshes[].primitives[].mode", 0, 6),
    array("meshes[].primitives[].targets"),

    array("buffers"),
    object("buffers[]"),
    text("buffers[].uri"),
    needed(integer("buffers[].byteLength", 1, kMaxBytes)),

    array("bufferViews"),
    object("bufferViews[]"),
    needed(index("bufferViews[].buffer", "buffers")),
    integer("bufferViews[].byteOffset", 0, kMaxBytes),
    needed(integer("bufferViews[].byteLength", 1, kMaxBytes)),
    integer("bufferViews[].byteStride", 4, 252),

    array("accessors"),
    object("accessors[]"),
    index("accessors[].bufferView", "bufferViews"),
    integer("accessors[].byteOffset", 0, kMaxBytes),
    needed(choice("accessors[].componentType", "5120|5121|5122|5123|5125|5126")),
    boolean("accessors[].normalized"),
    needed(integer("accessors[].count", 1, kMaxCount)),
    needed(choice("accessors[].type", "SCALAR|VEC2|VEC3|VEC4|MAT2|MAT3|MAT4")),
    object("accessors[].sparse"),
    needed(integer("accessors[].sparse.count", 1, kMaxCount)),
    needed(object("accessors[].sparse.indices")),
    needed(index("accessors[].sparse.indices.bufferView", "bufferViews")),
    integer("accessors[].sparse.indices.byteOffset", 0, kMaxCount),
    needed(choice("accessors[].sparse.indices.componentType", "5121|5123|5125")),
    needed(object("accessors[].sparse.values")),
    needed(index("accessors[].sparse.values.bufferView", "bufferViews")),
    integer("accessors[].sparse.values.byteOffset", 0, kMaxCount),

    array("materials"),
    object("materials[]"),
    text("materials[].name"),
    object("materials[].pbrMetallicRoughness"),
    numbers("materials[].pbrMetallicRoughness.baseColorFactor", 4, 0.0, kMaxCoordinate),
    number("materials[].pbrMetallicRoughness.metallicFactor", 0.0, 1.0),
    number("materials[].pbrMetallicRoughness.roughnessFactor", 0.0, 1.0),
    color("materials[].emissiveFactor"),
    choice("materials[].alphaMode", "OPAQUE|MASK|BLEND"),
    object("materials[].extensions"),
    object("materials[].extensions.*"),
    factor("materials[].extensions.KHR_materials_emissive_strength.emissiveStrength"),
    color(PROMIN_PHONG ".ambientFactor"),
    color(PROMIN_PHONG ".diffuseFactor"),
    color(PROMIN_PHONG ".specularFactor"),
    color(PROMIN_PHONG ".reflectionFactor"),
    factor(PROMIN_PHONG ".shininess"),

    array("cameras"),
    object("cameras[]"),
    text("cameras[].name"),
    needed(choice("cameras[].type", "perspective|orthographic")),
    object("cameras[].perspective"),
    needed(number("cameras[].perspective.yfov", kTiny, kPi* kJustUnder)),
    number("cameras[].perspective.aspectRatio", kTiny, 1e9),
    length_or_zero("cameras[].perspective.znear"),
    object("cameras[].orthographic"),
    needed(length("cameras[].orthographic.xmag")),
    needed(length("cameras[].orthographic.ymag")),
    length_or_zero("cameras[].orthographic.znear"),

    object("extensions"),
    object("extensions.*"),
    object("scenes[].extensions"),
    object("scenes[].extensions.*"),
    object("nodes[].extensions"),
    object("nodes[].extensions.*"),
    object("meshes[].primitives[].extensions"),
    object("meshes[].primitives[].extensions.*"),

    needed(index("nodes[].extensions.KHR_lights_punctual.light", PROMIN_LIGHTS)),
    boolean("nodes[].extensions.KHR_node_visibility.visible"),
    needed(array(PROMIN_LIGHTS)),
    object(PROMIN_LIGHTS "[]"),
    text(PROMIN_LIGHTS "[].name"),
    needed(choice(PROMIN_LIGHTS "[].type", "point|directional|spot")),
    color(PROMIN_LIGHTS "[].color"),
    factor(PROMIN_LIGHTS "[].intensity"),
    length(PROMIN_LIGHTS "[].range"),
    object(PROMIN_LIGHTS "[].spot"),
    number(PROMIN_LIGHTS "[].spot.innerConeAngle", 0.0, kHalfPi),
    number(PROMIN_LIGHTS "[].spot.outerConeAngle", 0.0, kHalfPi),
    object(PROMIN_LIGHTS "[].extensions"),
    object(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong"),
    choice(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.attenuation", "none|inverse_square"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.diffuseColor"),
    color(PROMIN_LIGHTS "[].extensions.PROMIN_lights_phong.specularColor"),

    index("scenes[].extensions.OMI_environment_sky.sky", PROMIN_SKIES),
    needed(array(PROMIN_SKIES)),
    object(PROMIN_SKIES "[]"),
    needed(text(PROMIN_SKIES "[].type")),
    object(PROMIN_SKIES "[].plain"),
    color(PROMIN_SKIES "[].plain.color"),
    color(PROMIN_SKIES "[].ambientLightColor"),
    number(PROMIN_SKIES "[].ambientSkyContribution", 0.0, 1.0),

    needed(index(PROMIN_LINK ".shape", PROMIN_SHAPES)),
    needed(array(PROMIN_SHAPES)),
    object(PROMIN_SHAPES "[]"),
    text(PROMIN_SHAPES "[].name"),
    needed(choice(PROMIN_SHAPES "[].type", "sphere|box|capsule|cylinder|plane")),
    object(PROMIN_SHAPES "[].sphere"),
    length(PROMIN_SHAPES "[].sphere.radius"),
    object(PROMIN_SHAPES "[].box"),
    object(PROMIN_SHAPES "[].capsule"),
    object(PROMIN_SHAPES "[].cylinder"),
    length(PROMIN_SHAPES "[].cylinder.height"),
    length_or_zero(PROMIN_SHAPES "[].cylinder.radiusTop"),
    length_or_zero(PROMIN_SHAPES "[].cylinder.radiusBottom"),
    object(PROMIN_SHAPES "[].plane"),
};

#undef PROMIN_LIGHTS
#undef PROMIN_SHAPES
#undef PROMIN_SKIES
#undef PROMIN_LINK
#undef PROMIN_PHONG

std::string written(double x) {
  std::string text = json(x).dump();
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text;
}

/// Calls `use(value, place)` for every value at `path` below `value`.
template <class Use>
void visit(json& value, const std::string& place, std::string_view path, const Rule& rule, LoadReport& report,
           const Use& use) {
  if (path.empty()) {
    use(value, place);
  } else if (path.starts_with("[]")) {
    if (!value.is_array()) return;
    for (size_t i = 0; i < value.size(); ++i) {
      visit(value[i], place + "[" + std::to_string(i) + "]", path.substr(2), rule, report, use);
    }
  } else if (path.front() == '.') {
    visit(value, place, path.substr(1), rule, report, use);
  } else {
    if (!value.is_object()) return;
    const size_t end = std::min(path.find_first_of(".["), path.size());
    const std::string_view name = path.substr(0, end);
    const std::string prefix = place.empty() ? "" : place + ".";
    for (auto member = value.begin(); name == "*" && member != value.end(); ++member) {
      visit(member.value(), prefix + member.key(), path.substr(end), rule, report, use);
    }
    if (name == "*") return;
    const auto member = value.find(std::string(name));
    if (member != value.end()) {
      visit(*member, prefix + std::string(name), path.substr(end), rule, report, use);
    } else if (rule.is_required && end == path.size()) {
      report.refuse(quote(name) + " is missing", place.empty() ? "the top level" : place, "add it");
    }
  }
}

/// Length of the array at a path without wildcards; 0 where there is none.
size_t size_of_array(const json& document, std::string_view path) {
  const json* value = &document;
  while (!path.empty()) {
    const size_t end = std::min(path.find('.'), path.size());
    if (!value->is_object()) return 0;
    const auto member = value->find(std::string(path.substr(0, end)));
    if (member == value->end()) return 0;
    value = &*member;
    path = path.substr(std::min(end + 1, path.size()));
  }
  return value->is_array() ? value->size() : 0;
}

/// Checks one value against one rule.
class ValueCheck {
 public:
  ValueCheck(const json& document, const Rule& rule, LoadReport& report) : rule_(rule), report_(report) {
    if (rule.kind == Kind::kIndex) target_size_ = size_of_array(document, rule.target);
  }

  void operator()(json& value, const std::string& place) const {
    switch (rule_.kind) {
      case Kind::kObject:
        return expect(value.is_object(), value, place, "an object");
      case Kind::kArray:
        return expect(value.is_array(), value, place, "an array");
      case Kind::kText:
        return expect(value.is_string(), value, place, "a string");
      case Kind::kBoolean:
        return expect(value.is_boolean(), value, place, "true or false");
      case Kind::kInteger:
        if (make_integer(value)) return check_range(value, place);
        return expect(false, value, place, "an integer");
      case Kind::kNumber:
        if (value.is_number()) return check_range(value, place);
        return expect(false, value, place, "a number");
      case Kind::kNumbers:
        return check_numbers(value, place);
      case Kind::kIndex:
        return check_index(value, place);
      case Kind::kChoice:
        return check_choice(value, place);
    }
  }

 private:
  void expect(bool is_met, const json& value, const std::string& place, const std::string& wanted) const {
    if (is_met) return;
    const std::string got = value.is_number() ? value.dump() : std::string("a JSON ") + value.type_name();
    report_.refuse(got + " stands where " + wanted + " belongs", place, "write " + wanted);
  }

  /// JSON has one kind of number: 3.0 is a valid index, and 1e99 an integer out of range.
  static bool make_integer(json& value) {
    if (value.is_number_integer()) return true;
    if (!value.is_number_float()) return false;
    const double number = value.get<double>();
    if (std::floor(number) != number) return false;
    if (std::abs(number) <= kMaxBytes) value = static_cast<int64_t>(number);
    return true;
  }

  void check_range(const json& value, const std::string& place) const {
    const double number = value.get<double>();
    if (number >= rule_.lo && number <= rule_.hi) return;
    report_.refuse(value.dump() + " is out of range", place,
                   "use a number from " + written(rule_.lo) + " to " + written(rule_.hi));
  }

  void check_numbers(const json& value, const std::string& place) const {
    if (!value.is_array() || value.size() != rule_.count) {
      return expect(false, value, place, "an array of " + std::to_string(rule_.count) + " numbers");
    }
    for (size_t i = 0; i < value.size(); ++i) {
      const std::string element = place + "[" + std::to_string(i) + "]";
      if (value[i].is_number()) {
        check_range(value[i], element);
      } else {
        expect(false, value[i], element, "a number");
      }
    }
  }

  void check_index(json& value, const std::string& place) const {
    if (!make_integer(value)) return expect(false, value, place, "an integer");
    const double number = value.get<double>();
    if (number >= 0.0 && number < static_cast<double>(target_size_)) return;
    const std::string target(rule_.target);
    report_.refuse("index " + value.dump() + " is out of range", place,
                   target_size_ == 0 ? "add the array " + target + " that it points into"
                                     : "use 0 to " + std::to_string(target_size_ - 1) + ", the elements of " + target);
  }

  void check_choice(json& value, const std::string& place) const {
    make_integer(value);
    const std::string got = value.is_string() ? value.get<std::string>() : value.dump();
    std::string_view rest = rule_.target;
    while (!rest.empty()) {
      const size_t end = std::min(rest.find('|'), rest.size());
      if (got == rest.substr(0, end)) return check_choice_type(value, place);
      rest = rest.substr(std::min(end + 1, rest.size()));
    }
    report_.refuse(quote(got) + " is none of " + std::string(rule_.target), place, "use one of them");
  }

  /// "5126" is not 5126.
  void check_choice_type(const json& value, const std::string& place) const {
    const bool is_number_wanted = rule_.target.front() >= '0' && rule_.target.front() <= '9';
    if (is_number_wanted != value.is_number()) expect(false, value, place, is_number_wanted ? "a number" : "a string");
  }

  const Rule& rule_;
  LoadReport& report_;
  size_t target_size_ = 0;
};

}  // namespace

void check_gltf_schema(json& document, LoadReport& report) {
  if (!document.is_object()) {
    report.refuse("the file is no JSON object", "the top level", "export the file again");
    return;
  }
  for (const Rule& rule : kRules) visit(document, "", rule.path, rule, report, ValueCheck(document, rule, report));
}

}  // namespace promin
