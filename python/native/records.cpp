// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "records.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>

#include "picture_arrays.h"
#include "promin/error.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

constexpr std::string_view kLightKinds[] = {"point", "directional", "spot", "headlight"};
constexpr std::string_view kAttenuations[] = {"none", "inverse_square"};
constexpr std::string_view kAlphaModes[] = {"opaque", "mask", "blend"};
constexpr std::string_view kProjections[] = {"perspective", "orthographic"};

using Model = decltype(Material::model);
using Sky = decltype(Environment::sky);
using Shape = std::variant<Sphere, Plane, Cylinder, Cone, Box, Capsule>;

// Names of alternatives, in their order.
constexpr std::string_view kModels[] = {"phong", "metallic_roughness", "unlit"};
constexpr std::string_view kSkies[] = {"none", "studio", "gradient", "panorama"};
constexpr std::string_view kShapes[] = {"sphere", "plane", "cylinder", "cone", "box", "capsule"};

/// Has the visitor see members by their names, which stand in one text with ", " between.
template <typename Visitor, typename... Members>
void visit_members(Visitor& visitor, std::string_view names, Members&... members) {
  const auto next = [&] {
    const std::string name(names.substr(0, names.find(',')));
    names.remove_prefix(std::min(names.size(), name.size() + 2));
    return name;
  };
  (visitor.field(next(), members), ...);
}

// PROMIN_MEMBERS(STRUCT, members...): what a struct is made of, for a visitor that reads or writes. All its members are
// listed, in their order; where one is left out it does not compile.
#define PROMIN_MEMBERS(STRUCT, ...)                    \
  template <typename Visitor>                          \
  void visit(Visitor& visitor, STRUCT& record) {       \
    auto& [__VA_ARGS__] = record;                      \
    visit_members(visitor, #__VA_ARGS__, __VA_ARGS__); \
  }

// clang-format off
PROMIN_MEMBERS(Light, name, kind, position, direction, diffuse, specular, attenuation, range, inner_cone_angle,
               outer_cone_angle, is_on)
PROMIN_MEMBERS(TextureSlot, texture, uv_set, to_u, to_v)
PROMIN_MEMBERS(Phong, ambient, diffuse, specular, shininess, reflection, transmission, ior, fresnel, diffuse_texture,
               specular_texture, normal_texture)
PROMIN_MEMBERS(MetallicRoughness, base_color, metallic, roughness, ior, specular, specular_color, specular_texture,
               specular_color_texture, transmission, transmission_texture, thickness, attenuation_color,
               attenuation_distance, dispersion, base_color_texture, metallic_roughness_texture, normal_texture,
               normal_scale, occlusion_texture, occlusion_strength, clearcoat, clearcoat_roughness, clearcoat_texture,
               clearcoat_roughness_texture, clearcoat_normal_texture, clearcoat_normal_scale, sheen_color,
               sheen_roughness, sheen_color_texture, sheen_roughness_texture)
PROMIN_MEMBERS(Unlit, color, color_texture)
PROMIN_MEMBERS(Material, name, model, emissive, emissive_texture, alpha_mode, alpha, alpha_cutoff, is_double_sided)
PROMIN_MEMBERS(Camera, name, projection, eye, look, up, yfov, ymag, aspect_ratio, resolution, near)
PROMIN_MEMBERS(Studio, front)
PROMIN_MEMBERS(GradientSky, top, horizon, bottom, top_curve, bottom_curve)
PROMIN_MEMBERS(Panorama, image)
PROMIN_MEMBERS(Environment, ambient, background, sky, shows_sky, rotation, intensity)
PROMIN_MEMBERS(DisplayTransform, exposure_ev, tone_mapping, dithers)
PROMIN_MEMBERS(ExrOptions, is_half, compression, is_multipart)
PROMIN_MEMBERS(ErrorTarget, error, min_samples, white, display, max_samples)
PROMIN_MEMBERS(PixelWindow, lo, hi)
PROMIN_MEMBERS(RenderMode, debug_view, has_shadows)
PROMIN_MEMBERS(View, camera, size, crop, samples_per_pixel, error_target, depth_kind, filter, filter_width, max_depth,
               mode)
PROMIN_MEMBERS(Sphere, center, radius)
PROMIN_MEMBERS(Plane, point, normal)
PROMIN_MEMBERS(Cylinder, center, axis, half_height, radius, is_open)
PROMIN_MEMBERS(Cone, center, axis, half_height, radius_bottom, radius_top, is_open)
PROMIN_MEMBERS(Box, center, half_size)
PROMIN_MEMBERS(Capsule, center, axis, half_height, radius_bottom, radius_top)
// clang-format on
#undef PROMIN_MEMBERS

template <typename Visitor>
void visit(Visitor&, std::monostate&) {}

template <int N, typename T>
using Vec = glm::vec<N, T, glm::defaultp>;

template <typename T>
T read_one(const nb::dict& record);

/// Makes the variant hold what the record is by its kind, one of the names.
template <typename... Kinds>
void read_kind(std::variant<Kinds...>& value, Names names, const std::string& kind, const std::string& what,
               const nb::dict& record) {
  const size_t place = find_name(names, kind, what);
  size_t index = 0;
  const auto read = [&]<typename Kind>(std::type_identity<Kind>) {
    if (index++ == place) value = read_one<Kind>(record);
  };
  (read(std::type_identity<Kinds>()), ...);
}

/// Fills a struct from a dict.
class Reader {
 public:
  explicit Reader(const nb::dict& record) : record_(record) {}

  /// A number, an enumerator by its name, or a struct as a dict.
  template <typename T>
  void field(const std::string& name, T& value) const {
    if constexpr (std::is_enum_v<T>) {
      value = static_cast<T>(find_name(names_of(T()), find_text(name), name));
    } else if constexpr (std::is_class_v<T>) {
      value = read_one<T>(convert<nb::dict>(find(name), name, "a record"));
    } else {
      value = convert<T>(find(name), name, "a number");
    }
  }
  void field(const std::string& name, std::string& value) const { value = find_text(name); }
  void field(const std::string& name, bool& value) const { value = convert<bool>(find(name), name, "True or False"); }
  template <int N, typename T>
  void field(const std::string& name, Vec<N, T>& value) const {
    const auto numbers = convert<std::array<T, N>>(find(name), name, N == 2 ? "two numbers" : "three numbers");
    for (int i = 0; i < N; ++i) value[i] = numbers[static_cast<size_t>(i)];
  }
  void field(const std::string& name, TextureSlot& value) const {
    std::optional<TextureSlot> slot;
    field(name, slot);
    value = slot.value_or(TextureSlot());
  }
  template <typename T>
  void field(const std::string& name, std::optional<T>& value) const {
    value.reset();
    if (!find(name).is_none()) value = read_one<T>(convert<nb::dict>(find(name), name, "a record"));
  }
  void field(const std::string& name, Model& value) const {
    read_kind(value, kModels, find_text(name), "model of materials", record_);
  }
  void field(const std::string& name, Sky& value) const {
    value = {};
    if (find(name).is_none()) return;
    const auto sky = convert<nb::dict>(find(name), name, "a record");
    read_kind(value, kSkies, Reader(sky).find_text("kind"), "kind of sky", sky);
  }
  void field(const std::string& name, std::shared_ptr<const Image>& value) const {
    PictureArray pixels;
    if (!nb::try_cast(find(name), pixels, false)) {
      throw UsageError({name + " is no array of (rows, columns, 3) float32", "", ""});
    }
    value = std::make_shared<const Image>(read_image_array(pixels));
  }

 private:
  nb::object find(const std::string& name) const {
    if (!record_.contains(name.c_str())) throw UsageError({"no " + name, "", ""});
    return record_[name.c_str()];
  }
  std::string find_text(const std::string& name) const { return convert<std::string>(find(name), name, "text"); }
  template <typename T>
  static T convert(const nb::object& value, const std::string& name, const char* kind) {
    T result;
    // A number that is cut off, as 1.5 for an integer, is none of the right kind: Python's int() decides.
    if (nb::try_cast<T>(value, result)) return result;
    // Cut by characters, in Python: a cut between a character's bytes leaves what is no text.
    const auto shown = nb::cast<std::string>(nb::str(nb::repr(value))[nb::slice(0, 80)]);
    throw UsageError({name + " is " + shown + ", not " + kind, "", ""});
  }

  const nb::dict& record_;
};

template <typename T>
T read_one(const nb::dict& record) {
  T value;
  const Reader reader(record);
  visit(reader, value);
  return value;
}

/// Fills a dict from a struct.
class Writer {
 public:
  template <typename T>
  static nb::dict write_one(T value) {
    Writer writer;
    visit(writer, value);
    return writer.record_;
  }

  /// A number, an enumerator as its name, or a struct as a dict.
  template <typename T>
  void field(const std::string& name, T& value) {
    if constexpr (std::is_enum_v<T>) {
      put(name, nb::cast(std::string(names_of(value)[static_cast<size_t>(value)])));
    } else if constexpr (std::is_class_v<T>) {
      put(name, write_one(value));
    } else {
      put(name, nb::cast(value));
    }
  }
  void field(const std::string& name, std::string& value) { put(name, nb::cast(value)); }
  template <typename T>
  void field(const std::string& name, std::optional<T>& value) {
    put(name, value ? nb::object(write_one(*value)) : nb::none());
  }
  template <int N, typename T>
  void field(const std::string& name, Vec<N, T>& value) {
    std::array<T, N> numbers;
    for (int i = 0; i < N; ++i) numbers[static_cast<size_t>(i)] = value[i];
    put(name, nb::tuple(nb::cast(numbers)));
  }
  void field(const std::string& name, TextureSlot& value) {
    put(name, value.exists() ? nb::object(write_one(value)) : nb::none());
  }
  void field(const std::string& name, Model& value) {
    put(name, nb::cast(std::string(kModels[value.index()])));
    std::visit([&](const auto& model) { record_.update(write_one(model)); }, value);
  }
  void field(const std::string& name, Sky& value) {
    nb::dict sky = std::visit([](const auto& one) { return write_one(one); }, value);
    sky["kind"] = std::string(kSkies[value.index()]);
    put(name, value.index() == 0 ? nb::none() : nb::object(sky));
  }
  void field(const std::string& name, std::shared_ptr<const Image>& value) { put(name, write_image_array(*value)); }

 private:
  void put(const std::string& name, const nb::object& value) { record_[name.c_str()] = value; }

  nb::dict record_;
};

template <typename T>
std::optional<T> read_optional(const nb::dict& record, const std::string& name) {
  if (!record.contains(name.c_str()) || record[name.c_str()].is_none()) return {};
  T value{};
  Reader(record).field(name, value);
  return value;
}

}  // namespace

// clang-format off
Names names_of(LightKind) { return kLightKinds; }
Names names_of(Attenuation) { return kAttenuations; }
Names names_of(AlphaMode) { return kAlphaModes; }
Names names_of(Projection) { return kProjections; }
Names names_of(DepthKind) { return depth_kind_names(); }
Names names_of(ToneMapping) { return tone_mapping_names(); }
Names names_of(PixelFilter) { return pixel_filter_names(); }
Names names_of(DebugView) { return debug_view_names(); }
Names names_of(ExrCompression) { return exr_compression_names(); }
// clang-format on

size_t find_name(Names names, const std::string& name, const std::string& what) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end()) return static_cast<size_t>(found - names.begin());
  std::string all;
  for (const std::string_view one : names) all += (all.empty() ? "" : ", ") + std::string(one);
  throw UsageError({"no " + what + " \"" + name + "\"", "", "choose one of: " + all});
}

std::optional<float> read_real(const nb::dict& record, const std::string& name) {
  return read_optional<float>(record, name);
}

std::optional<uint32_t> read_whole(const nb::dict& record, const std::string& name) {
  return read_optional<uint32_t>(record, name);
}

Light read_light(const nb::dict& record) {
  return read_one<Light>(record);
}

nb::dict write(const Light& light) {
  return Writer::write_one(light);
}

Material read_material(const nb::dict& record) {
  return read_one<Material>(record);
}

nb::dict write(const Material& material) {
  return Writer::write_one(material);
}

Camera read_camera(const nb::dict& record) {
  return read_one<Camera>(record);
}

nb::dict write(const Camera& camera) {
  return Writer::write_one(camera);
}

Environment read_environment(const nb::dict& record) {
  return read_one<Environment>(record);
}

nb::dict write(const Environment& environment) {
  return Writer::write_one(environment);
}

DisplayTransform read_display(const nb::dict& record) {
  return read_one<DisplayTransform>(record);
}

nb::dict write(const DisplayTransform& display) {
  return Writer::write_one(display);
}

ExrOptions read_exr_options(const nb::dict& record) {
  return read_one<ExrOptions>(record);
}

nb::dict write(const ExrOptions& options) {
  return Writer::write_one(options);
}

View read_view(const nb::dict& record) {
  return read_one<View>(record);
}

nb::dict write(const View& view) {
  return Writer::write_one(view);
}

nb::dict write(const ErrorTarget& target) {
  return Writer::write_one(target);
}

RenderMode read_mode(const nb::dict& record) {
  return read_one<RenderMode>(record);
}

Geometry read_shape(const std::string& kind, const nb::dict& record) {
  Shape shape;
  read_kind(shape, kShapes, kind, "shape", record);
  return std::visit([](const auto& one) -> Geometry { return one; }, shape);
}

}  // namespace promin::python
