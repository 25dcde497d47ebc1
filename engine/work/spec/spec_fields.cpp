// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "work/spec/spec_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <optional>
#include <type_traits>
#include <utility>

#include "promin/image.h"
#include "promin/validate.h"

namespace promin::work::fields {
namespace {

const Traits kNoBits{.affects_bits = false};

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
    using Codec = std::conditional_t<std::is_same_v<Value, std::vector<std::filesystem::path>>, Paths, Path>;
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
  table.add("instances", PROMIN_AT(tracing.instances), NameOf<Instancing>{instancing_names()}, {.usual = "auto"});
  table.add_flag("strict", PROMIN_AT(tracing.load.is_strict));
  table.add_file("root", PROMIN_AT(tracing.load.root), kNoBits);
  table.add("animation", PROMIN_AT(tracing.motion.animations), Animations());
  table.add_number("time", PROMIN_AT(tracing.motion.time_s), 0.0, kMaxTime);
  table.add_flag("loop", PROMIN_AT(tracing.motion.loops));
}

void add_samples(Table<RenderSpec>& table) {
  table.add_number("spp", PROMIN_AT(view.samples_per_pixel), 1, kMaxSamplesPerPixel,
                   {.replaces = {"quality", "target_error", "time_limit", "min_spp", "max_spp", "error_in"}});
  table.add("quality", PROMIN_AT(quality), NameOf<Quality>{quality_names()},
            {.usual = "normal", .replaces = {"spp", "target_error", "time_limit", "min_spp", "max_spp", "error_in"}});
  table.add_number("target_error", PROMIN_AT(error.target), static_cast<double>(kMinTargetError), 1.0,
                   {.replaces = {"spp", "quality"}});
  table.add("time_limit", PROMIN_AT(error.time_limit_s), Seconds(), {.replaces = {"spp", "quality"}});
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
  table.add("ground", PROMIN_AT(view.look.has_ground), Flag());
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
  table.add("integrator", PROMIN_AT(view.integrator), NameOf<Integrator>{integrator_names()});
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
  table.add("up", PROMIN_AT(view.pose.up), Direction());
  table.add_number("fov", PROMIN_AT(view.pose.fov_deg), kMinFovDeg, kMaxFovDeg);
  table.add_number("near", PROMIN_AT(view.pose.near), 0.0, kMaxCoordinate);
  table.add_number("aperture_radius", PROMIN_AT(view.aperture_radius), 0.0, kMaxCoordinate);
  table.add_number("focus_distance", PROMIN_AT(view.focus_distance), kLeastFocusDistance, kMaxCoordinate);
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
  if (std::string_view(#FIELD) != "alpha" && spec.aovs.FIELD) names.push_back(#FIELD);
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
                               "direction", "up", "fov", "near", "turntable"}});
  table.add_number("turntable", PROMIN_AT(turntable), kMinTurntable, kMaxFrame, {.replaces = {"path"}});
  table.add("frames", PROMIN_AT(frames), Frames());
  table.add("fps", PROMIN_AT(fps), Fps());
  table.add_number("shutter", PROMIN_AT(shutter), kMinShutter, 1.0);
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

#undef PROMIN_AT

}  // namespace

template <typename Spec>
const std::vector<Field<Spec>>& fields_of() {
  static const Table<Spec> table = make_table(static_cast<const Spec*>(nullptr));
  return table.fields();
}

template const std::vector<Field<RenderSpec>>& fields_of();
template const std::vector<Field<CastSpec>>& fields_of();

}  // namespace promin::work::fields
