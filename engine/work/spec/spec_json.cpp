// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/spec_json.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <fstream>
#include <functional>
#include <iostream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <type_traits>

#include "core/file.h"
#include "core/json_text.h"
#include "core/suggest.h"
#include "core/utf8.h"
#include "formats/gltf/parse_json.h"
#include "image/color_words.h"
#include "promin/error.h"
#include "promin/image.h"
#include "promin/validate.h"
#include "work/pictures/camera_path.h"

namespace promin::work {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The version of the format.
constexpr int kFormat = 1;

// Functions that read and write values of members. A reader throws WrongValue.

/// Thrown if a value is refused. The text is the end of a sentence about the member: "takes true or false, not 1".
struct WrongValue {
  std::string what;
};

std::string text_of(const Json& json) {
  return json_text(json);
}

[[noreturn]] void refuse_value(const std::string& takes, const Json& value) {
  throw WrongValue{fmt::format("takes {}, not {}", takes, text_of(value))};
}

/// Returns a number with the fewest digits that reproduce it.
template <typename Number>
Json write_number(Number value) {
  return read_ordered_json(fmt::format("{}", value));
}

/// Reads a number in a range. The range applies to the number as stored, because the shortest digits of a float
/// represent another number in double.
template <typename Number = double>
Number read_real(const Json& json, Number min, Number max) {
  const double value = json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
  const auto stored = static_cast<Number>(value);
  // The comparison is written so that a NaN is refused.
  if (!(stored >= min && stored <= max)) refuse_value(fmt::format("a number from {:g} to {:g}", min, max), json);
  return stored;
}

uint32_t read_whole(const Json& json, uint32_t min, uint32_t max) {
  const bool is_whole = json.is_number_unsigned() || (json.is_number_integer() && json.get<int64_t>() >= 0);
  if (!is_whole || json.get<uint64_t>() < min || json.get<uint64_t>() > max) {
    refuse_value(fmt::format("a whole number from {} to {}", min, max), json);
  }
  return json.get<uint32_t>();
}

const Json& read_array(const Json& json, size_t size, const std::string& takes) {
  if (!json.is_array() || json.size() != size) refuse_value(takes, json);
  return json;
}

/// Reads and writes numbers in a range. The member's type determines the kind of number.
template <typename Number>
struct NumberIn {
  Number min;
  Number max;

  Json write(Number value) const { return write_number(value); }
  Number read(const Json& json) const {
    if constexpr (std::is_floating_point_v<Number>) {
      return read_real(json, min, max);
    } else {
      return read_whole(json, min, max);
    }
  }
};

struct Flag {
  Json write(bool value) const { return value; }
  bool read(const Json& json) const {
    if (!json.is_boolean()) refuse_value("true or false", json);
    return json.get<bool>();
  }
};

struct Text {
  Json write(const std::string& value) const { return value; }
  std::string read(const Json& json) const {
    if (!json.is_string()) refuse_value("a text", json);
    return json.get<std::string>();
  }
};

/// Reads and writes the name of a file. read_member() and write_fields() convert it to and from absolute paths.
struct Path {
  Json write(const fs::path& value) const { return value.string(); }
  fs::path read(const Json& json) const { return Text().read(json); }
};

/// Reads and writes one file or a list of files.
struct Paths {
  Json write(const std::vector<fs::path>& values) const {
    Json json = Json::array();
    for (const fs::path& value : values) json.push_back(value.string());
    return json;
  }
  std::vector<fs::path> read(const Json& json) const {
    if (!json.is_array()) return {Path().read(json)};
    std::vector<fs::path> files;
    for (const Json& part : json) files.push_back(Path().read(part));
    return files;
  }
};

/// Reads and writes one of some names. The first `hidden` names are not for users.
template <typename Enum>
struct NameOf {
  std::span<const std::string_view> names;
  size_t hidden = 0;

  Json write(Enum value) const { return std::string(names[static_cast<size_t>(value)]); }
  Enum read(const Json& json) const {
    const auto known = names.subspan(hidden);
    const auto found = json.is_string() ? std::ranges::find(known, json.get<std::string>()) : known.end();
    if (found == known.end()) refuse_value(list_choices(known), json);
    return static_cast<Enum>(static_cast<size_t>(found - known.begin()) + hidden);
  }
};

struct Vector {
  Json write(const dvec3& value) const { return {write_number(value.x), write_number(value.y), write_number(value.z)}; }
  dvec3 read(const Json& json) const {
    const Json& parts = read_array(json, 3, "three numbers");
    const auto part = [&](size_t i) { return read_real(parts[i], -kMaxCoordinate, kMaxCoordinate); };
    return {part(0), part(1), part(2)};
  }
};

/// Reads and writes a pair of whole numbers.
struct Pair {
  uint32_t min;
  uint32_t max;

  Json write(const uvec2& value) const { return {value.x, value.y}; }
  uvec2 read(const Json& json) const {
    const Json& parts = read_array(json, 2, "two whole numbers");
    return {read_whole(parts[0], min, max), read_whole(parts[1], min, max)};
  }
};

struct Size {
  Json write(const uvec2& value) const { return Pair{0, kMaxSide}.write(value); }
  uvec2 read(const Json& json) const {
    const uvec2 size = Pair{0, kMaxSide}.read(json);
    if (size == uvec2(0)) refuse_value("a width and a height, one of which may be 0 for the camera's choice", json);
    return size;
  }
};

struct Window {
  Json write(const PixelWindow& value) const { return {value.lo.x, value.lo.y, value.hi.x, value.hi.y}; }
  PixelWindow read(const Json& json) const {
    const std::string takes = "X0, Y0, X1, Y1 with X0 < X1 and Y0 < Y1";
    const Json& parts = read_array(json, 4, takes);
    const auto part = [&](size_t i) { return read_whole(parts[i], 0, kMaxSide); };
    const PixelWindow window = {{part(0), part(1)}, {part(2), part(3)}};
    if (window.lo.x >= window.hi.x || window.lo.y >= window.hi.y) refuse_value(takes, json);
    return window;
  }
};

struct Frames {
  Json write(const FrameRange& value) const { return {value.first, value.last}; }
  FrameRange read(const Json& json) const {
    const uvec2 ends = Pair{0, kMaxFrame}.read(json);
    if (ends.x > ends.y) refuse_value("the first frame and the last", json);
    return {ends.x, ends.y};
  }
};

/// Reads and writes a rate, or the word for the frames that a path stores.
struct Fps {
  static constexpr const char* kWord = "stored";

  Json write(double value) const { return value == PathPictures::kStored ? Json(kWord) : write_number(value); }
  double read(const Json& json) const {
    if (json == kWord) return PathPictures::kStored;
    return read_real(json, PathPictures::kMinFps, PathPictures::kMaxFps);
  }
};

struct PowerOfTwo {
  Json write(uint32_t value) const { return value; }
  uint32_t read(const Json& json) const {
    const uint32_t samples = read_whole(json, kMinRefinedSamples, kMaxRefinedSamples);
    if (!std::has_single_bit(samples)) refuse_value("a power of two", json);
    return samples;
  }
};

/// Reads and writes numbers of lights. Each occurs once, and they are in ascending order.
struct Indices {
  Json write(const std::vector<uint32_t>& value) const { return value; }
  std::vector<uint32_t> read(const Json& json) const {
    if (!json.is_array()) refuse_value("numbers of 0 or more", json);
    std::vector<uint32_t> numbers;
    for (const Json& part : json) numbers.push_back(read_whole(part, 0, std::numeric_limits<uint32_t>::max()));
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    return numbers;
  }
};

/// Reads and writes a background: "environment", a displayed colour as a word or as three numbers, or linear light as
/// {"linear": [R, G, B]}.
struct Background {
  static constexpr const char* kEnvironment = "environment";
  static constexpr const char* kLinear = "linear";

  static Json write_color(const vec3& color) {
    return {write_number(color.x), write_number(color.y), write_number(color.z)};
  }
  static vec3 read_color(const Json& json, double most) {
    const Json& parts = read_array(json, 3, "three numbers");
    return vec3(dvec3(read_real(parts[0], 0.0, most), read_real(parts[1], 0.0, most), read_real(parts[2], 0.0, most)));
  }
  Json write(const BackgroundChoice& value) const {
    if (value.is_environment) return kEnvironment;
    return value.is_linear ? Json{{kLinear, write_color(value.color)}} : write_color(value.color);
  }
  BackgroundChoice read(const Json& json) const {
    if (json == kEnvironment) return {.is_environment = true};
    if (json.is_string()) {
      const std::optional<vec3> color = find_color(json.get<std::string>());
      if (!color) refuse_value("the name of a colour, #rrggbb, three numbers from 0 to 1 or environment", json);
      return {.color = *color};
    }
    if (json.is_object() && json.size() == 1 && json.contains(kLinear)) {
      return {.is_linear = true, .color = read_color(json[kLinear], kMaxBackground)};
    }
    return {.color = read_color(json, 1.0)};
  }
};

// The table of members follows.

/// Properties of a member that matter for jobs and command lines.
struct Traits {
  /// A value that has the same effect as leaving the member out.
  Json usual = {};
  bool affects_bits = true;
  bool is_file = false;
  /// True if pieces depend on the member; false for members that are chosen when pieces are merged.
  bool is_of_pieces = true;
  /// The members that this member replaces if it is given in addition to a specification.
  std::vector<std::string_view> replaces = {};
};

const Traits kNoBits{.affects_bits = false};

/// A member of a specification.
template <typename Spec>
struct Field {
  /// The name in JSON. The option's name has - in place of _.
  std::string name;
  Traits traits;
  /// Returns the member's value as JSON; null for the default value.
  std::function<Json(const Spec&)> write;
  std::function<void(const Json&, Spec&)> read;
  std::function<void(Spec&)> reset;
};

template <typename T>
struct IsOptional : std::false_type {};
template <typename T>
struct IsOptional<std::optional<T>> : std::true_type {};

/// Returns a field. `get` returns a reference to the member's value in a specification.
template <typename Spec, typename Get, typename Codec>
Field<Spec> make_field(std::string name, Get get, Codec codec, Traits traits) {
  Field<Spec> field{std::move(name), std::move(traits), {}, {}, {}};
  field.write = [get, codec](const Spec& spec) -> Json {
    const auto& value = get(spec);
    if constexpr (IsOptional<std::decay_t<decltype(value)>>::value) {
      return value ? Json(codec.write(*value)) : Json();
    } else {
      const Spec usual{};
      return value == get(usual) ? Json() : Json(codec.write(value));
    }
  };
  field.read = [get, codec](const Json& json, Spec& spec) { get(spec) = codec.read(json); };
  field.reset = [get](Spec& spec) {
    const Spec usual{};
    get(spec) = get(usual);
  };
  return field;
}

/// A function that returns the place of a member in a specification.
#define PROMIN_AT(MEMBER)   \
  [](auto& spec) -> auto& { \
    return spec.MEMBER;     \
  }

template <typename Spec>
class Table {
 public:
  template <typename Get, typename Codec>
  void add(std::string name, Get get, Codec codec, Traits traits = {}) {
    fields_.push_back(make_field<Spec>(std::move(name), get, codec, std::move(traits)));
  }
  /// Adds a number. The member's type determines the kind of number and whether it may be empty.
  template <typename Get>
  void add_number(std::string name, Get get, double min, double max, Traits traits = {}) {
    using Value = std::decay_t<decltype(get(std::declval<Spec&>()))>;
    if constexpr (IsOptional<Value>::value) {
      using Number = typename Value::value_type;
      add(std::move(name), get, NumberIn<Number>{static_cast<Number>(min), static_cast<Number>(max)},
          std::move(traits));
    } else {
      add(std::move(name), get, NumberIn<Value>{static_cast<Value>(min), static_cast<Value>(max)}, std::move(traits));
    }
  }
  template <typename Get>
  void add_flag(std::string name, Get get, Traits traits = {}) {
    add(std::move(name), get, Flag(), std::move(traits));
  }
  /// Adds a file or a list of files.
  template <typename Get>
  void add_file(std::string name, Get get, Traits traits = {}) {
    using Value = std::decay_t<decltype(get(std::declval<Spec&>()))>;
    using Codec = std::conditional_t<std::is_same_v<Value, std::vector<fs::path>>, Paths, Path>;
    traits.is_file = true;
    add(std::move(name), get, Codec(), std::move(traits));
  }
  void add(Field<Spec> field) { fields_.push_back(std::move(field)); }

  const std::vector<Field<Spec>>& fields() const { return fields_; }

 private:
  std::vector<Field<Spec>> fields_;
};

template <typename Spec>
void add_scene(Table<Spec>& table) {
  table.add_file("scene", PROMIN_AT(tracing.scene), kNoBits);
}

template <typename Spec>
void add_loading(Table<Spec>& table) {
  table.add("builder", PROMIN_AT(tracing.builder), Text(), {.affects_bits = false, .replaces = {"bvh"}});
  table.add_file("bvh", PROMIN_AT(tracing.bvh), {.affects_bits = false, .replaces = {"builder"}});
  table.add_flag("strict", PROMIN_AT(tracing.load.is_strict));
  table.add_file("root", PROMIN_AT(tracing.load.root), kNoBits);
}

using std::string_view_literals::operator""sv;

void add_samples(Table<RenderSpec>& table) {
  table.add_number("spp", PROMIN_AT(view.samples_per_pixel), 1, kMaxSamplesPerPixel,
                   {.usual = kDefaultSamples,
                    .replaces = {"quality", "target_error", "time_limit", "min_spp", "max_spp", "error_in"}});
  table.add("quality", PROMIN_AT(quality), NameOf<Quality>{quality_names()},
            {.usual = "normal", .replaces = {"spp", "target_error", "time_limit", "min_spp", "max_spp", "error_in"}});
  table.add_number("target_error", PROMIN_AT(error.target), static_cast<double>(kMinTargetError), 1.0,
                   {.replaces = {"spp", "quality"}});
  table.add_number("time_limit", PROMIN_AT(error.time_limit_s), kMinTimeLimit, kMaxTimeLimit,
                   {.replaces = {"spp", "quality"}});
  table.add("min_spp", PROMIN_AT(error.min_samples), PowerOfTwo());
  table.add("max_spp", PROMIN_AT(error.max_samples), PowerOfTwo());
  table.add("error_in", PROMIN_AT(error.space), NameOf<ErrorSpace>{error_space_names()}, {.usual = "linear"});
}

/// Returns the field of --exposure, which sets two members.
Field<RenderSpec> make_exposure() {
  constexpr const char* kAverage = "average";
  return {"exposure",
          {},
          [](const RenderSpec& spec) -> Json {
            const LookOptions& look = spec.view.look;
            if (look.averages_exposure) return kAverage;
            return look.exposure_ev ? write_number(*look.exposure_ev) : Json();
          },
          [](const Json& json, RenderSpec& spec) {
            LookOptions& look = spec.view.look;
            look.averages_exposure = json == kAverage;
            look.exposure_ev.reset();
            if (json == kAverage || json == "auto") return;
            look.exposure_ev = static_cast<float>(read_real(json, -kMaxExposureEv, kMaxExposureEv));
          },
          [](RenderSpec& spec) {
            spec.view.look.averages_exposure = false;
            spec.view.look.exposure_ev.reset();
          }};
}

void add_look(Table<RenderSpec>& table) {
  table.add("light", PROMIN_AT(view.look.light), NameOf<LightChoice>{light_choice_names(), 1});
  table.add("background", PROMIN_AT(view.look.background), Background(), {.replaces = {"alpha"}});
  table.add(make_exposure());
  table.add("tone_mapping", PROMIN_AT(view.look.tone_mapping), NameOf<ToneMapping>{tone_mapping_names()});
  table.add_flag("dither", PROMIN_AT(view.look.dithers));
  table.add_number("texture_memory", PROMIN_AT(view.look.texture_memory_mib), 1, kMaxTextureMib);
}

void add_view(Table<RenderSpec>& table) {
  table.add("size", PROMIN_AT(view.size), Size());
  table.add("filter", PROMIN_AT(view.filter), NameOf<PixelFilter>{pixel_filter_names()});
#define PROMIN_VIEW_NUMBER(NAME, TYPE, MIN, MAX, USUAL, PLACEHOLDER, HELP) \
  table.add_number(#NAME, PROMIN_AT(view.NAME), static_cast<double>(MIN), static_cast<double>(MAX));
#include "work/spec/view_numbers.def"
  table.add("shading", PROMIN_AT(view.debug_view), NameOf<DebugView>{debug_view_names()});
  table.add_flag("no_shadows", PROMIN_AT(view.has_no_shadows));
  table.add("lights_off", PROMIN_AT(view.lights_off), Indices());
  add_look(table);
  table.add("camera", PROMIN_AT(view.camera), Text(), {.replaces = {"from", "fit", "path"}});
}

void add_pose(Table<RenderSpec>& table) {
  table.add("from", PROMIN_AT(view.pose.from), NameOf<Framing>{framing_names()},
            {.replaces = {"camera", "eye", "look_at", "direction", "path"}});
  table.add_number("fit", PROMIN_AT(view.pose.fit), double{kMinFit}, 1.0, {.replaces = {"camera", "eye", "look_at"}});
  table.add_number("azimuth", PROMIN_AT(view.pose.orbit.azimuth_deg), -kMaxTurnDeg, kMaxTurnDeg);
  table.add_number("elevation", PROMIN_AT(view.pose.orbit.elevation_deg), -kMaxTurnDeg, kMaxTurnDeg);
  table.add_number("roll", PROMIN_AT(view.pose.orbit.roll_deg), -kMaxTurnDeg, kMaxTurnDeg);
  table.add_number("zoom", PROMIN_AT(view.pose.zoom), kMinZoom, kMaxZoom);
  table.add("eye", PROMIN_AT(view.pose.eye), Vector(), {.replaces = {"from", "fit", "path"}});
  table.add("look_at", PROMIN_AT(view.pose.look_at), Vector(), {.replaces = {"direction", "from", "fit", "path"}});
  table.add("direction", PROMIN_AT(view.pose.direction), Vector(), {.replaces = {"look_at", "from", "path"}});
  table.add("up", PROMIN_AT(view.pose.up), Vector());
  table.add_number("fov", PROMIN_AT(view.pose.fov_deg), kMinFovDeg, kMaxFovDeg);
  table.add_number("near", PROMIN_AT(view.pose.near), 0.0, kMaxCoordinate);
}

void add_environment(Table<RenderSpec>& table) {
  table.add_file("environment", PROMIN_AT(view.environment.panorama));
  table.add_number("environment_rotation", PROMIN_AT(view.environment.rotation_deg), -kMaxRotationDeg, kMaxRotationDeg);
  table.add_number("environment_intensity", PROMIN_AT(view.environment.intensity), 0.0, kMaxIntensity);
  table.add_number("light_rotation", PROMIN_AT(view.environment.light_rotation_deg), -kMaxRotationDeg, kMaxRotationDeg);
}

/// The name of Cryptomatte, which is chosen like an AOV. Alpha has its own member.
constexpr const char* kCryptomatte = "cryptomatte";

Json write_aovs(const RenderSpec& spec) {
  Json names = Json::array();
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (#FIELD != "alpha"sv && spec.aovs.FIELD) names.push_back(#FIELD);
#include "promin/kinds/aovs.def"
  if (spec.aovs.cryptomatte) names.push_back(kCryptomatte);
  return names.empty() ? Json() : names;
}

void clear_aovs(RenderSpec& spec) {
  const bool has_alpha = spec.aovs.alpha;
  spec.aovs = {};
  spec.aovs.alpha = has_alpha;
}

void read_aovs(const Json& json, RenderSpec& spec) {
  clear_aovs(spec);
  if (!json.is_array()) refuse_value("a list of names", json);
  for (const Json& part : json) {
    const std::string name = Text().read(part);
    bool is_known = false;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (name == #FIELD) is_known = spec.aovs.FIELD = true;
#include "promin/kinds/aovs.def"
    if (name == kCryptomatte) is_known = spec.aovs.cryptomatte = true;
    if (!is_known) refuse_value(fmt::format("names from {}, {}", fmt::join(aov_names(), ", "), kCryptomatte), part);
  }
}

/// Returns the field of --compression. It is refused for pictures that are no EXR, even if it names the default.
Field<RenderSpec> make_compression() {
  auto field = make_field<RenderSpec>("compression", PROMIN_AT(exr.compression),
                                      NameOf<ExrCompression>{exr_compression_names()}, {.usual = "zip"});
  field.read = [read = field.read](const Json& json, RenderSpec& spec) {
    read(json, spec);
    spec.names_compression = true;
  };
  return field;
}

struct Features {
  Json write(bool has_all) const { return has_all ? "all" : "scene"; }
  bool read(const Json& json) const {
    if (json != "all" && json != "scene") refuse_value("scene or all", json);
    return json == "all";
  }
};

void add_channels(Table<RenderSpec>& table) {
  table.add({"aov", {}, write_aovs, read_aovs, clear_aovs});
  table.add_flag("alpha", PROMIN_AT(aovs.alpha), {.replaces = {"background"}});
  table.add("depth", PROMIN_AT(view.depth_kind), NameOf<DepthKind>{depth_kind_names()});
  table.add_flag("half", PROMIN_AT(exr.is_half));
  table.add(make_compression());
  table.add("features", PROMIN_AT(has_all_features), Features(), kNoBits);
}

Table<RenderSpec> make_table(const RenderSpec* /*kind*/) {
  Table<RenderSpec> table;
  add_scene(table);
  table.add_file("output", PROMIN_AT(pictures), {.affects_bits = false, .is_of_pieces = false});
  add_samples(table);
  table.add("variant", PROMIN_AT(tracing.load.material_variant), Text());
  add_view(table);
  add_pose(table);
  add_environment(table);
  table.add("crop", PROMIN_AT(view.crop), Window());
  table.add_file("path", PROMIN_AT(path),
                 {.replaces = {"camera", "from", "fit", "azimuth", "elevation", "roll", "zoom", "eye", "look_at",
                               "direction", "up", "fov", "near"}});
  table.add("frames", PROMIN_AT(frames), Frames());
  table.add("fps", PROMIN_AT(fps), Fps());
  table.add_number("pieces", PROMIN_AT(job.pieces), 1, kMaxSide, {.affects_bits = false, .replaces = {"tiles"}});
  table.add("tiles", PROMIN_AT(job.tiles), Pair{1, kMaxSide}, {.affects_bits = false, .replaces = {"pieces"}});
  add_channels(table);
  add_loading(table);
  return table;
}

Table<CastSpec> make_table(const CastSpec* /*kind*/) {
  Table<CastSpec> table;
  add_scene(table);
  table.add_file("rays", PROMIN_AT(rays), kNoBits);
  table.add_file("output", PROMIN_AT(output), {.affects_bits = false, .is_of_pieces = false});
  table.add_flag("any", PROMIN_AT(is_any), {.replaces = {"count", "all"}});
  table.add_flag("count", PROMIN_AT(is_count), {.replaces = {"any", "all"}});
  table.add_flag("all", PROMIN_AT(is_all), {.replaces = {"any", "count"}});
  table.add_file("offsets", PROMIN_AT(offsets), {.affects_bits = false, .is_of_pieces = false});
  table.add_number("pieces", PROMIN_AT(job.pieces), 1, kMostRayPieces, kNoBits);
  add_loading(table);
  return table;
}

template <typename Spec>
const std::vector<Field<Spec>>& fields_of() {
  static const Table<Spec> table = make_table(static_cast<const Spec*>(nullptr));
  return table.fields();
}

/// Returns the key of the format's version.
const char* key_of(const RenderSpec* /*kind*/) {
  return "promin_render_spec";
}
const char* key_of(const CastSpec* /*kind*/) {
  return "promin_cast_spec";
}

template <typename Spec>
const Field<Spec>* find_field(std::string_view name) {
  const auto& fields = fields_of<Spec>();
  const auto found = std::ranges::find(fields, name, &Field<Spec>::name);
  return found == fields.end() ? nullptr : &*found;
}

/// Changes each text in a value that is the name of a file.
void change_paths(Json& value, const std::function<std::string(const std::string&)>& change) {
  if (value.is_string() && value.get<std::string>() != kStandardInput) value = change(value.get<std::string>());
  if (!value.is_array()) return;
  for (Json& part : value) change_paths(part, change);
}

std::string make_absolute(const std::string& path) {
  if (to_utf8(path) != path) {
    throw UsageError({"spec.file.name", "the name of the file is not UTF-8, so a specification cannot contain it", path,
                      "rename the file"});
  }
  return fs::absolute(path).lexically_normal().string();
}

template <typename Spec>
std::string write_fields(const Spec& spec, bool is_of_pieces) {
  Json json = {{key_of(&spec), kFormat}};
  for (const Field<Spec>& field : fields_of<Spec>()) {
    if (is_of_pieces && !field.traits.is_of_pieces) continue;
    Json value = field.write(spec);
    if (value.is_null() || value == field.traits.usual) continue;
    if (field.traits.is_file) change_paths(value, make_absolute);
    json[field.name] = std::move(value);
  }
  // Arrays of a few numbers are written on one line.
  std::vector<std::string> lines;
  for (const auto& [name, value] : json.items()) lines.push_back(fmt::format(" \"{}\": {}", name, text_of(value)));
  return fmt::format("{{\n{}\n}}\n", fmt::join(lines, ",\n"));
}

template <typename Spec>
void read_member(const std::string& name, const nlohmann::json& parsed, const fs::path& folder, Spec& spec,
                 LoadReport& report) {
  const Field<Spec>* field = find_field<Spec>(name);
  if (field == nullptr) {
    std::vector<std::string_view> known;
    for (const Field<Spec>& each : fields_of<Spec>()) known.push_back(each.name);
    const std::string_view near = nearest_name(name, known);
    report.refuse("spec.member.unknown", fmt::format("a specification has no member {}", quote(name)), "",
                  near.empty() ? "remove it" : fmt::format("did you mean {}?", near));
    return;
  }
  Json value = parsed;
  if (field->traits.is_file) change_paths(value, [&](const std::string& path) { return (folder / path).string(); });
  try {
    field->read(value, spec);
  } catch (const WrongValue& wrong) {
    report.refuse("spec.member.value", fmt::format("{} {}", name, wrong.what), "", "correct it or remove it");
  }
}

/// Returns a value as it is written on a command line.
std::string describe_value(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value == true) return "given";
  if (!value.is_array()) return text_of(value);
  std::vector<std::string> parts;
  for (const Json& part : value) parts.push_back(describe_value(part));
  return fmt::format("{}", fmt::join(parts, " "));
}

}  // namespace

std::string option_of(std::string member) {
  std::ranges::replace(member, '_', '-');
  return "--" + member;
}

template <typename Spec>
Spec parse_spec(std::string_view text, const fs::path& file) {
  const std::string key = key_of(static_cast<const Spec*>(nullptr));
  LoadReport report(file);
  const std::string cure =
      fmt::format("give a file that promin's --print-spec has written, with \"{}\": {}", key, kFormat);
  const nlohmann::json json = parse_json(text, report, cure);
  if (!json.is_object() || !json.contains(key) || json[key] != kFormat) {
    report.refuse("spec.format", fmt::format("the file has no member \"{}\" with the value {}", key, kFormat), "",
                  cure);
    report.throw_if_refused();
  }
  const fs::path folder = file == kStandardInput ? fs::path() : file.parent_path();
  Spec spec;
  for (const auto& [name, value] : json.items()) {
    if (name != key) read_member(name, value, folder, spec, report);
  }
  report.throw_if_refused();
  return spec;
}

template <typename Spec>
Spec read_spec(const fs::path& file) {
  if (file == kStandardInput) {
    return parse_spec<Spec>(std::string(std::istreambuf_iterator<char>(std::cin), {}), file);
  }
  const std::vector<std::byte> bytes = read_file(file);
  return parse_spec<Spec>({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, file);
}

template <typename Spec>
std::string write_spec(const Spec& spec) {
  return write_fields(spec, false);
}

template <typename Spec>
std::string write_spec_of_pieces(const Spec& spec) {
  return write_fields(spec, true);
}

template <typename Spec>
std::vector<std::pair<std::string, std::string>> list_bits(const Spec& spec) {
  std::vector<std::pair<std::string, std::string>> bits;
  for (const Field<Spec>& field : fields_of<Spec>()) {
    if (!field.traits.affects_bits) continue;
    Json value = field.write(spec);
    if (value.is_null() || value == field.traits.usual) continue;
    if (field.traits.is_file) {
      change_paths(value, [](const std::string& path) { return fs::path(path).filename().string(); });
    }
    bits.emplace_back(option_of(field.name), describe_value(value));
  }
  return bits;
}

template <typename Spec>
void clear_rivals(Spec& spec, std::string_view option) {
  const auto& fields = fields_of<Spec>();
  const auto found =
      std::ranges::find_if(fields, [&](const Field<Spec>& field) { return option_of(field.name) == option; });
  if (found == fields.end()) return;
  for (const std::string_view rival : found->traits.replaces) {
    const Field<Spec>* field = find_field<Spec>(rival);
    if (field != nullptr) field->reset(spec);
  }
}

#define PROMIN_SPEC_FUNCTIONS(SPEC)                                                      \
  template SPEC read_spec<SPEC>(const fs::path& file);                                   \
  template SPEC parse_spec<SPEC>(std::string_view text, const fs::path& file);           \
  template std::string write_spec(const SPEC& spec);                                     \
  template std::string write_spec_of_pieces(const SPEC& spec);                           \
  template std::vector<std::pair<std::string, std::string>> list_bits(const SPEC& spec); \
  template void clear_rivals(SPEC& spec, std::string_view option);
PROMIN_SPEC_FUNCTIONS(RenderSpec)
PROMIN_SPEC_FUNCTIONS(CastSpec)
#undef PROMIN_SPEC_FUNCTIONS
#undef PROMIN_AT

}  // namespace promin::work
