// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/lights.h"

#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <type_traits>

#include "environment/read_panorama.h"
#include "formats/gltf/image_bytes.h"
#include "formats/gltf/json_lookup.h"
#include "motion/attach.h"
#include "promin/validate.h"

namespace promin {
namespace {

using nlohmann::json;

/// Returns the kind of light for a type that the schema accepts. Throws std::logic_error for any other type.
LightKind light_kind_of(const std::string& type) {
  if (type == "directional") return LightKind::kDirectional;
  if (type == "point") return LightKind::kPoint;
  if (type == "spot") return LightKind::kSpot;
  throw std::logic_error("a light of type \"" + type + "\" is not known");
}

void read_cone(const json& source, const std::string& place, Light& light, LoadReport& report) {
  const json spot = source.value("spot", json::object());
  const double inner = spot.value("innerConeAngle", 0.0);
  const double outer = spot.value("outerConeAngle", std::numbers::pi / 4.0);
  if (set_cone(inner, outer, light)) return;
  report.repair({"gltf.light.cone", "a spot's inner cone angle is not less than its outer cone angle", "",
                 place + ".spot", "make innerConeAngle less than outerConeAngle", "its edge is sharp"});
}

/// Reads the power. Candela and lux are used without conversion; a directional light has no attenuation, because it has
/// no distance.
void read_power(const json& source, const std::string& title, LightLink& link, LoadReport& report) {
  Light& light = link.rest;
  link.intensity = source.value("intensity", 1.0);
  link.color = vec3_of(source, "color", dvec3(1.0));
  const dvec3 power = link.intensity * link.color;
  light.diffuse = light.specular = vec3(power);
  light.attenuation = Attenuation::kInverseSquare;
  if (const json* classic = find_extension(source, "PROMIN_lights_phong")) {
    light.diffuse = vec3(vec3_of(*classic, "diffuseColor", power));
    light.specular = vec3(vec3_of(*classic, "specularColor", power));
    link.has_diffuse_power = !classic->contains("diffuseColor");
    link.has_specular_power = !classic->contains("specularColor");
    if (classic->value("attenuation", "none") == "none") {
      light.attenuation = Attenuation::kNone;
    } else if (light.kind == LightKind::kDirectional) {
      report.warn("light " + title + " is directional; its attenuation is ignored");
    }
  }
  if (light.kind == LightKind::kDirectional) light.attenuation = Attenuation::kNone;
  // A range beyond the largest coordinate has no effect.
  const double range = source.value("range", 2.0 * kMaxCoordinate);
  if (light.attenuation == Attenuation::kInverseSquare && range <= kMaxCoordinate) {
    light.range = static_cast<float>(range);
  }
}

/// Reads the size of a light, in metres and radians; the node's scale does not change it.
void read_size(const json& source, const std::string& title, Light& light, LoadReport& report) {
  const json* size = find_extension(source, "PROMIN_lights_size");
  if (size == nullptr) return;
  const bool is_directional = light.kind == LightKind::kDirectional;
  const char* unused = is_directional ? "radius" : "angle";
  if (size->contains(unused)) {
    report.warn("light " + title + " is " + (is_directional ? "directional" : "not directional") + "; its " + unused +
                " is ignored");
  }
  if (is_directional) {
    light.angle = static_cast<float>(size->value("angle", 0.0));
  } else {
    light.radius = static_cast<float>(size->value("radius", 0.0));
  }
}

GradientSky gradient_of(const json& source) {
  GradientSky sky;
  sky.top = vec3(vec3_of(source, "topColor", dvec3(0.0)));
  sky.horizon = vec3(vec3_of(source, "horizonColor", dvec3(0.0)));
  sky.bottom = vec3(vec3_of(source, "bottomColor", dvec3(0.0)));
  sky.top_curve = source.value("topCurve", sky.top_curve);
  sky.bottom_curve = source.value("bottomCurve", sky.bottom_curve);
  return sky;
}

/// Returns the member of this name if it exists and has the right type.
template <typename T>
std::optional<T> value_of(const json& object, const char* name) {
  if (!object.is_object()) return std::nullopt;
  const auto member = object.find(name);
  if (member == object.end()) return std::nullopt;
  const bool is_right = std::is_same_v<T, std::string> ? member->is_string() : member->is_number_unsigned();
  if (!is_right) return std::nullopt;
  return member->get<T>();
}

/// Reads the picture of a panorama. If this fails, adds the reason to the report and returns nullopt.
std::optional<Panorama> read_panorama_sky(const GltfDocument& document, const json& source, LoadReport& report) {
  if (source.contains("cubemap") && !source.contains("equirectangular")) {
    report.warn("the sky is a cube map, but promin draws only equirectangular panoramas; the scene has no sky");
    return std::nullopt;
  }
  const json& textures = elements_of(document.json, "textures");
  const json& images = elements_of(document.json, "images");
  const auto texture = value_of<size_t>(source, "equirectangular");
  const auto image = texture ? value_of<size_t>(textures[*texture], "source") : std::nullopt;
  if (!image || !images.is_array() || *image >= images.size()) {
    report.warn("the sky's panorama has no image of a known format; the scene has no sky");
    return std::nullopt;
  }
  const std::string name = "the sky's panorama " + title_of(document.json, "images", *image);
  PictureSource picture;
  read_gltf_image(document, *image, picture, report);
  if (picture.problem) {
    report.warn(name + " is ignored: " + describe_problem(picture));
    return std::nullopt;
  }
  try {
    std::vector<std::string> warnings;
    Panorama panorama = read_panorama(picture.file, name, warnings);
    for (const std::string& warning : warnings) report.warn(warning);
    return panorama;
  } catch (const InputError& error) {
    report.warn(name + " is ignored: " + error.problems().front().what);
    return std::nullopt;
  }
}

/// Warns of features of a directional sky that promin does not model.
void warn_about_sky(const json& sky, LoadReport& report) {
  if (sky.value("ambientSkyContribution", 1.0) < 1.0) {
    report.warn("ambientSkyContribution is ignored; all ambient light comes from the sky");
  }
  const auto gradient = sky.find("gradient");
  if (gradient != sky.end() && (gradient->contains("sunAngleMax") || gradient->contains("sunCurve"))) {
    report.warn("suns light the scene but are not drawn in the sky");
  }
}

/// Names a light after its node or its definition, and places it. If that fails, warns and returns nullopt; `far` is
/// the warning of a light beyond the limits.
std::optional<LightLink> place_light(const Light& light, const PlacedNode& placed, const json& node, const json& source,
                                     const char* far, LoadReport& report) {
  const std::string node_place = "nodes[" + std::to_string(placed.node) + "]";
  LightLink link{.node = placed.index, .rest = light};
  const std::string name = node.value("name", "");
  link.rest.name = name.empty() ? source.value("name", "") : name;
  switch (attach(placed.world_from_object, placed.rotation, link.rest)) {
    case Attached::kDone:
      return link;
    case Attached::kFar:
      report.warn({"gltf.light.far", far, "", node_place, "", "promin omits it"});
      break;
    case Attached::kWithoutDirection:
      report.warn({"gltf.light.direction", "a light has no direction", "", node_place, "", "promin omits it"});
      break;
  }
  return std::nullopt;
}

/// Returns the width and height of a flat light.
dvec2 sides_of(const json& source, LightKind kind, const dmat4& world_from_node) {
  const dmat3 columns(world_from_node);
  const double scale = std::max({glm::length(columns[0]), glm::length(columns[1]), glm::length(columns[2])});
  const double height = scale * source.value("size", 1.0);
  const double aspect = kind == LightKind::kRect && source.contains("rect") ? source["rect"].value("aspect", 1.0) : 1.0;
  return {aspect * height, height};
}

}  // namespace

std::optional<LightLink> read_gltf_light(const GltfDocument& document, const PlacedNode& placed, LoadReport& report) {
  const auto& node = document.json["nodes"][static_cast<size_t>(placed.node)];
  const json* link = find_extension(node, "KHR_lights_punctual");
  if (link == nullptr) return std::nullopt;
  const auto& extension = document.json["extensions"]["KHR_lights_punctual"];
  const size_t index = (*link)["light"];
  const auto& source = extension["lights"][index];
  // A light that cannot be used is null (JsonCheck).
  if (source.is_null()) return std::nullopt;
  const std::string place = "extensions.KHR_lights_punctual.lights[" + std::to_string(index) + "]";

  Light light;
  light.kind = light_kind_of(source["type"]);
  auto result = place_light(light, placed, node, source, "a light lies beyond 1e15 in the world", report);
  if (!result) return std::nullopt;
  result->definition = static_cast<uint32_t>(index);
  if (light.kind == LightKind::kSpot) read_cone(source, place, result->rest, report);
  const std::string title = title_of(extension, "lights", index);
  read_power(source, title, *result, report);
  read_size(source, title, result->rest, report);
  return result;
}

std::optional<LightLink> read_gltf_area_light(const GltfDocument& document, const PlacedNode& placed,
                                              LoadReport& report) {
  const auto& node = document.json["nodes"][static_cast<size_t>(placed.node)];
  const json* link = find_extension(node, "EXT_lights_area");
  if (link == nullptr) return std::nullopt;
  const size_t index = (*link)["light"];
  const auto& source = document.json["extensions"]["EXT_lights_area"]["lights"][index];
  if (source.is_null()) return std::nullopt;

  constexpr const char* kFar = "a light lies beyond 1e15 in the world, or its sides are out of range";
  Light light;
  light.kind = source["type"] == "rect" ? LightKind::kRect : LightKind::kDisk;
  light.size = vec2(sides_of(source, light.kind, placed.world_from_object));
  const bool is_sized = std::min(light.size.x, light.size.y) >= kLeastLightSide &&
                        static_cast<double>(std::max(light.size.x, light.size.y)) <= kMaxCoordinate;
  if (!is_sized) {
    const std::string node_place = "nodes[" + std::to_string(placed.node) + "]";
    report.warn({"gltf.light.far", kFar, "", node_place, "", "promin omits it"});
    return std::nullopt;
  }
  auto result = place_light(light, placed, node, source, kFar, report);
  if (!result) return std::nullopt;
  const dvec3 radiance = source.value("intensity", 1.0) * vec3_of(source, "color", dvec3(1.0));
  result->rest.diffuse = result->rest.specular = vec3(radiance);
  return result;
}

void read_gltf_sky(const GltfDocument& document, Scene& scene, LoadReport& report) {
  const json* extension = find_extension(document.json, "OMI_environment_sky");
  if (extension == nullptr || (*extension)["skies"].empty()) return;
  size_t index = 0;
  const json& scenes = elements_of(document.json, "scenes");
  if (!scenes.empty()) {
    const json& shown = scenes[document.scene];
    if (const json* choice = find_extension(shown, "OMI_environment_sky")) index = choice->value("sky", size_t{0});
  }

  const auto& sky = (*extension)["skies"][index];
  if (sky.is_null()) return;
  const std::string type = sky["type"];
  dvec3 color(0.0);
  if (type == "gradient" && sky.contains(type)) {
    scene.environment.sky = gradient_of(sky[type]);
    scene.environment.shows_sky = true;
    warn_about_sky(sky, report);
    return;
  }
  if (type == "panorama" && sky.contains(type)) {
    if (std::optional<Panorama> panorama = read_panorama_sky(document, sky[type], report)) {
      scene.environment.sky = std::move(*panorama);
      scene.environment.shows_sky = true;
      // In the extension, the middle of the picture is +Z.
      scene.environment.rotation = std::numbers::pi_v<float>;
      warn_about_sky(sky, report);
      return;
    }
  } else if (type != "plain") {
    report.warn("the sky is of type " + quote(type) +
                ", but promin draws only plain skies, gradients and panoramas; the background is black");
  } else if (sky.contains("plain")) {
    color = vec3_of(sky["plain"], "color", dvec3(0.0));
  }
  scene.environment.background = vec3(color);
  scene.environment.ambient =
      vec3(glm::mix(vec3_of(sky, "ambientLightColor", dvec3(0.0)), color, sky.value("ambientSkyContribution", 1.0)));
}

}  // namespace promin
