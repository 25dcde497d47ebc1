// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "records.h"

#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "picture_arrays.h"
#include "promin/error.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

constexpr std::string_view kLightKinds[] = {"point", "directional", "spot", "headlight"};
constexpr std::string_view kAttenuations[] = {"none", "inverse_square"};
constexpr std::string_view kAlphaModes[] = {"opaque", "mask", "blend"};
constexpr std::string_view kProjections[] = {"perspective", "orthographic"};
constexpr std::string_view kDepthKinds[] = {"ray", "plane"};
constexpr const char* kModels[] = {"phong", "metallic_roughness", "unlit"};

// What a struct is made of, told to a visitor that reads or writes.

template <typename Visitor>
void visit(Visitor& v, Light& x) {
  v.field("name", x.name);
  v.choice("kind", x.kind, kLightKinds);
  v.field("position", x.position);
  v.field("direction", x.direction);
  v.field("diffuse", x.diffuse);
  v.field("specular", x.specular);
  v.choice("attenuation", x.attenuation, kAttenuations);
  v.field("range", x.range);
  v.field("inner_cone_angle", x.inner_cone_angle);
  v.field("outer_cone_angle", x.outer_cone_angle);
  v.field("is_on", x.is_on);
}

template <typename Visitor>
void visit(Visitor& v, TextureSlot& x) {
  v.field("texture", x.texture);
  v.field("uv_set", x.uv_set);
  v.field("to_u", x.to_u);
  v.field("to_v", x.to_v);
}

template <typename Visitor>
void visit(Visitor& v, Phong& x) {
  v.field("ambient", x.ambient);
  v.field("diffuse", x.diffuse);
  v.field("specular", x.specular);
  v.field("shininess", x.shininess);
  v.field("reflection", x.reflection);
  v.field("transmission", x.transmission);
  v.field("ior", x.ior);
  v.field("fresnel", x.fresnel);
  v.slot("diffuse_texture", x.diffuse_texture);
  v.slot("specular_texture", x.specular_texture);
  v.slot("normal_texture", x.normal_texture);
}

template <typename Visitor>
void visit(Visitor& v, MetallicRoughness& x) {
  v.field("base_color", x.base_color);
  v.field("metallic", x.metallic);
  v.field("roughness", x.roughness);
  v.field("ior", x.ior);
  v.field("specular", x.specular);
  v.field("specular_color", x.specular_color);
  v.slot("specular_texture", x.specular_texture);
  v.slot("specular_color_texture", x.specular_color_texture);
  v.field("transmission", x.transmission);
  v.slot("transmission_texture", x.transmission_texture);
  v.field("thickness", x.thickness);
  v.field("attenuation_color", x.attenuation_color);
  v.field("attenuation_distance", x.attenuation_distance);
  v.field("dispersion", x.dispersion);
  v.slot("base_color_texture", x.base_color_texture);
  v.slot("metallic_roughness_texture", x.metallic_roughness_texture);
  v.slot("normal_texture", x.normal_texture);
  v.field("normal_scale", x.normal_scale);
  v.slot("occlusion_texture", x.occlusion_texture);
  v.field("occlusion_strength", x.occlusion_strength);
  v.field("clearcoat", x.clearcoat);
  v.field("clearcoat_roughness", x.clearcoat_roughness);
  v.slot("clearcoat_texture", x.clearcoat_texture);
  v.slot("clearcoat_roughness_texture", x.clearcoat_roughness_texture);
  v.slot("clearcoat_normal_texture", x.clearcoat_normal_texture);
  v.field("clearcoat_normal_scale", x.clearcoat_normal_scale);
  v.field("sheen_color", x.sheen_color);
  v.field("sheen_roughness", x.sheen_roughness);
  v.slot("sheen_color_texture", x.sheen_color_texture);
  v.slot("sheen_roughness_texture", x.sheen_roughness_texture);
}

template <typename Visitor>
void visit(Visitor& v, Unlit& x) {
  v.field("color", x.color);
  v.slot("color_texture", x.color_texture);
}

/// Without the model.
template <typename Visitor>
void visit(Visitor& v, Material& x) {
  v.field("name", x.name);
  v.field("emissive", x.emissive);
  v.slot("emissive_texture", x.emissive_texture);
  v.choice("alpha_mode", x.alpha_mode, kAlphaModes);
  v.field("alpha", x.alpha);
  v.field("alpha_cutoff", x.alpha_cutoff);
  v.field("is_double_sided", x.is_double_sided);
}

template <typename Visitor>
void visit(Visitor& v, Camera& x) {
  v.field("name", x.name);
  v.choice("projection", x.projection, kProjections);
  v.field("eye", x.eye);
  v.field("look", x.look);
  v.field("up", x.up);
  v.field("yfov", x.yfov);
  v.field("ymag", x.ymag);
  v.field("aspect_ratio", x.aspect_ratio);
  v.field("resolution", x.resolution);
  v.field("near", x.near);
}

template <typename Visitor>
void visit(Visitor& v, Studio& x) {
  v.field("front", x.front);
}

template <typename Visitor>
void visit(Visitor& v, GradientSky& x) {
  v.field("top", x.top);
  v.field("horizon", x.horizon);
  v.field("bottom", x.bottom);
  v.field("top_curve", x.top_curve);
  v.field("bottom_curve", x.bottom_curve);
}

/// Without the sky.
template <typename Visitor>
void visit(Visitor& v, Environment& x) {
  v.field("ambient", x.ambient);
  v.field("background", x.background);
  v.field("shows_sky", x.shows_sky);
  v.field("rotation", x.rotation);
  v.field("intensity", x.intensity);
}

template <typename Visitor>
void visit(Visitor& v, DisplayTransform& x) {
  v.field("exposure_ev", x.exposure_ev);
  v.choice("tone_mapping", x.tone_mapping, tone_mapping_names());
  v.field("dithers", x.dithers);
}

template <typename Visitor>
void visit(Visitor& v, ErrorTarget& x) {
  v.field("error", x.error);
  v.field("min_samples", x.min_samples);
  v.field("white", x.white);
  v.field("max_samples", x.max_samples);
}

template <typename Visitor>
void visit(Visitor& v, PixelWindow& x) {
  v.field("lo", x.lo);
  v.field("hi", x.hi);
}

/// Without the camera.
template <typename Visitor>
void visit(Visitor& v, View& x) {
  v.field("size", x.size);
  v.optional("crop", x.crop);
  v.field("samples_per_pixel", x.samples_per_pixel);
  v.optional("error_target", x.error_target);
  v.choice("depth_kind", x.depth_kind, kDepthKinds);
  v.choice("filter", x.filter, pixel_filter_names());
  v.field("filter_width", x.filter_width);
  v.field("max_depth", x.max_depth);
  v.choice("debug_view", x.mode.debug_view, debug_view_names());
  v.field("has_shadows", x.mode.has_shadows);
}

template <typename Visitor>
void visit(Visitor& v, Sphere& x) {
  v.field("center", x.center);
  v.field("radius", x.radius);
}

template <typename Visitor>
void visit(Visitor& v, Plane& x) {
  v.field("point", x.point);
  v.field("normal", x.normal);
}

template <typename Visitor>
void visit(Visitor& v, Cylinder& x) {
  v.field("center", x.center);
  v.field("axis", x.axis);
  v.field("half_height", x.half_height);
  v.field("radius", x.radius);
  v.field("is_open", x.is_open);
}

template <typename Visitor>
void visit(Visitor& v, Cone& x) {
  v.field("center", x.center);
  v.field("axis", x.axis);
  v.field("half_height", x.half_height);
  v.field("radius_bottom", x.radius_bottom);
  v.field("radius_top", x.radius_top);
  v.field("is_open", x.is_open);
}

template <typename Visitor>
void visit(Visitor& v, Box& x) {
  v.field("center", x.center);
  v.field("half_size", x.half_size);
}

template <typename Visitor>
void visit(Visitor& v, Capsule& x) {
  v.field("center", x.center);
  v.field("axis", x.axis);
  v.field("half_height", x.half_height);
  v.field("radius_bottom", x.radius_bottom);
  v.field("radius_top", x.radius_top);
}

template <int N, typename T>
using Vec = glm::vec<N, T, glm::defaultp>;

/// Fills a struct from a dict.
class Reader {
 public:
  explicit Reader(const nb::dict& record) : record_(record) {}

  template <typename T>
  void field(const char* name, T& value) {
    value = convert<T>(find(name), name, "a number");
  }
  void field(const char* name, std::string& value) { value = convert<std::string>(find(name), name, "text"); }
  void field(const char* name, bool& value) { value = convert<bool>(find(name), name, "True or False"); }
  template <int N, typename T>
  void field(const char* name, Vec<N, T>& value) {
    const auto numbers = convert<std::array<T, N>>(find(name), name, N == 2 ? "two numbers" : "three numbers");
    for (int i = 0; i < N; ++i) value[i] = numbers[static_cast<size_t>(i)];
  }
  template <typename Enum>
  void choice(const char* name, Enum& value, std::span<const std::string_view> names) {
    const auto word = convert<std::string>(find(name), name, "text");
    const auto found = std::ranges::find(names, word);
    if (found == names.end()) {
      std::string all;
      for (const std::string_view one : names) all += (all.empty() ? "" : ", ") + std::string(one);
      throw UsageError({std::string("no ") + name + " \"" + word + "\"", "", "choose one of: " + all});
    }
    value = static_cast<Enum>(found - names.begin());
  }
  void slot(const char* name, TextureSlot& value) {
    value = {};
    if (!find(name).is_none()) nest(name, value);
  }
  template <typename T>
  void optional(const char* name, std::optional<T>& value) {
    value.reset();
    if (!find(name).is_none()) nest(name, value.emplace());
  }

  nb::object find(const char* name) const {
    if (!record_.contains(name)) throw UsageError({std::string("no ") + name, "", ""});
    return record_[name];
  }
  nb::dict find_dict(const char* name) const { return convert<nb::dict>(find(name), name, "a record"); }

 private:
  template <typename T>
  static T convert(const nb::object& value, const char* name, const char* kind) {
    T result;
    // A number that is cut off, as 1.5 for an integer, is none of the right kind: Python's int() decides.
    if (nb::try_cast<T>(value, result)) return result;
    const std::string shown = nb::cast<std::string>(nb::str(nb::repr(value)));
    throw UsageError({std::string(name) + " is " + shown.substr(0, 80) + ", not " + kind, "", ""});
  }
  template <typename T>
  void nest(const char* name, T& value) {
    const nb::dict record = find_dict(name);
    Reader reader(record);
    visit(reader, value);
  }

  const nb::dict& record_;
};

/// Fills a dict from a struct.
class Writer {
 public:
  template <typename T>
  void field(const char* name, T& value) {
    record[name] = value;
  }
  template <int N, typename T>
  void field(const char* name, Vec<N, T>& value) {
    std::array<T, N> numbers;
    for (int i = 0; i < N; ++i) numbers[static_cast<size_t>(i)] = value[i];
    record[name] = nb::tuple(nb::cast(numbers));
  }
  template <typename Enum>
  void choice(const char* name, Enum& value, std::span<const std::string_view> names) {
    record[name] = std::string(names[static_cast<size_t>(value)]);
  }
  void slot(const char* name, TextureSlot& value) {
    record[name] = nb::none();
    if (value.exists()) record[name] = write_one(value);
  }

  template <typename T>
  static nb::dict write_one(T value) {
    Writer writer;
    visit(writer, value);
    return writer.record;
  }

  nb::dict record;
};

template <typename T>
T read_one(const nb::dict& record) {
  T value;
  Reader reader(record);
  visit(reader, value);
  return value;
}

}  // namespace

Light read_light(const nb::dict& record) {
  return read_one<Light>(record);
}

nb::dict write(const Light& light) {
  return Writer::write_one(light);
}

Material read_material(const nb::dict& record) {
  auto material = read_one<Material>(record);
  const auto model = nb::cast<std::string>(nb::str(Reader(record).find("model")));
  if (model == kModels[0]) {
    material.model = read_one<Phong>(record);
  } else if (model == kModels[1]) {
    material.model = read_one<MetallicRoughness>(record);
  } else if (model == kModels[2]) {
    material.model = read_one<Unlit>(record);
  } else {
    throw UsageError({"no model of materials \"" + model + "\"", "", ""});
  }
  return material;
}

nb::dict write(const Material& material) {
  nb::dict record = Writer::write_one(material);
  record["model"] = kModels[material.model.index()];
  std::visit([&](const auto& model) { record.update(Writer::write_one(model)); }, material.model);
  return record;
}

Camera read_camera(const nb::dict& record) {
  return read_one<Camera>(record);
}

nb::dict write(const Camera& camera) {
  return Writer::write_one(camera);
}

Environment read_environment(const nb::dict& record) {
  auto environment = read_one<Environment>(record);
  const Reader reader(record);
  if (reader.find("sky").is_none()) return environment;
  const nb::dict sky = reader.find_dict("sky");
  const auto kind = nb::cast<std::string>(nb::str(Reader(sky).find("kind")));
  if (kind == "studio") {
    environment.sky = read_one<Studio>(sky);
  } else if (kind == "gradient") {
    environment.sky = read_one<GradientSky>(sky);
  } else if (kind == "panorama") {
    PictureArray pixels;
    if (!nb::try_cast(Reader(sky).find("image"), pixels, false)) {
      throw UsageError({"the panorama's image is no array of (rows, columns, 3) float32", "", ""});
    }
    environment.sky = Panorama{std::make_shared<const Image>(read_image_array(pixels))};
  } else {
    throw UsageError({"no kind of sky \"" + kind + "\"", "", ""});
  }
  return environment;
}

nb::dict write(const Environment& environment) {
  nb::dict record = Writer::write_one(environment);
  record["sky"] = nb::none();
  const auto put = [&](const char* kind, nb::dict sky) {
    sky["kind"] = kind;
    record["sky"] = sky;
  };
  if (const auto* studio = std::get_if<Studio>(&environment.sky)) put("studio", Writer::write_one(*studio));
  if (const auto* gradient = std::get_if<GradientSky>(&environment.sky)) put("gradient", Writer::write_one(*gradient));
  if (const auto* panorama = std::get_if<Panorama>(&environment.sky)) {
    nb::dict sky;
    sky["image"] = write_image_array(*panorama->image);
    put("panorama", sky);
  }
  return record;
}

DisplayTransform read_display(const nb::dict& record) {
  return read_one<DisplayTransform>(record);
}

nb::dict write(const DisplayTransform& display) {
  return Writer::write_one(display);
}

View read_view(const nb::dict& record) {
  auto view = read_one<View>(record);
  view.camera = read_camera(Reader(record).find_dict("camera"));
  return view;
}

Geometry read_shape(const std::string& kind, const nb::dict& record) {
  if (kind == "sphere") return read_one<Sphere>(record);
  if (kind == "plane") return read_one<Plane>(record);
  if (kind == "cylinder") return read_one<Cylinder>(record);
  if (kind == "cone") return read_one<Cone>(record);
  if (kind == "box") return read_one<Box>(record);
  if (kind == "capsule") return read_one<Capsule>(record);
  throw UsageError({"no shape \"" + kind + "\"", "", ""});
}

}  // namespace promin::python
