// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/explanation.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "core/json_text.h"

namespace promin::app {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// Returns the number, or null for infinity, because JSON has no infinity.
OrderedJson json_of_part(float value) {
  return std::isfinite(value) ? read_ordered_json(fmt::format("{:.9g}", value)) : OrderedJson(nullptr);
}

OrderedJson json_of_part(const vec3& v) {
  return OrderedJson::array({json_of_part(v.x), json_of_part(v.y), json_of_part(v.z)});
}

/// Returns a position of the scene in world coordinates, with the nine digits of fp32, or with all digits far from the
/// origin.
OrderedJson json_of_place(const vec3& place, const Scene& scene) {
  if (scene.center == dvec3(0.0)) return json_of_part(place);
  const dvec3 world = scene.center + dvec3(place);
  return OrderedJson::array({world.x, world.y, world.z});
}

OrderedJson json_of_part(const Ray& ray, const Scene& scene) {
  return {{"origin", json_of_place(ray.origin, scene)},
          {"direction", json_of_part(ray.direction)},
          {"tmin", json_of_part(ray.tmin)},
          {"tmax", json_of_part(ray.tmax)}};
}

/// Returns the name of a source that is no light of the scene; empty for a light.
std::string_view name_of_other(const ExplainedSource& source) {
  if (source.light == ExplainedSource::kSky) return "environment";
  if (source.light == ExplainedSource::kSurfaces) return "emissive surface";
  return source.light == ExplainedSource::kChosen ? "chosen source" : "";
}

/// Writes the members that every hit has, also a blocker's. json_of_part(ExplainedRay) adds the members of hits on the
/// path.
OrderedJson json_of_part(const Hit& hit) {
  if (hit.object < 0) return nullptr;
  return {{"object", hit.object},
          {"primitive", hit.primitive},
          {"t", json_of_part(hit.t)},
          {"u", json_of_part(hit.u)},
          {"v", json_of_part(hit.v)}};
}

OrderedJson json_of_part(const ExplainedSource& source, const Scene& scene) {
  const std::string_view other = name_of_other(source);
  OrderedJson json = {{"light", other.empty() ? OrderedJson(source.light) : OrderedJson(other)},
                      {"name", other.empty() ? scene.lights[source.light].name : std::string()},
                      {"visible", source.is_visible()},
                      {"contribution", json_of_part(source.contribution)},
                      {"shadow_ray", nullptr}};
  if (source.shadow_ray) {
    json["shadow_ray"] = json_of_part(*source.shadow_ray, scene);
    json["shadow_ray"]["blocker"] = json_of_part(source.blocker);
  }
  return json;
}

std::string_view ray_name_of(RayKind kind) {
  switch (kind) {
    case RayKind::kCamera:
      return "camera";
    case RayKind::kReflection:
      return "mirror";
    case RayKind::kRefraction:
      return "refracted";
    case RayKind::kThrough:
      return "through";
  }
  return "";
}

OrderedJson json_of_part(const ExplainedRay& ray, const Scene& scene) {
  OrderedJson json = {{"kind", ray_name_of(ray.kind)}, {"parent", nullptr}};
  if (ray.kind != RayKind::kCamera) json["parent"] = ray.parent;
  json.update(json_of_part(ray.ray, scene));
  json["weight"] = json_of_part(ray.weight);
  json["hit"] = json_of_part(ray.hit);
  if (ray.hit.object >= 0) {
    json["hit"].update({{"object_name", scene.objects[static_cast<size_t>(ray.hit.object)].name},
                        {"position", json_of_place(ray.position, scene)},
                        {"normal", json_of_part(ray.hit.normal)},
                        {"shading_normal", json_of_part(ray.shading_normal)},
                        {"lift", json_of_part(ray.lift)},
                        {"coverage", json_of_part(ray.coverage)},
                        {"material", ray.material},
                        {"material_name", scene.materials[ray.material].name}});
  }
  json["own"] = json_of_part(ray.own);
  json["sources"] = OrderedJson::array();
  for (const ExplainedSource& source : ray.sources) json["sources"].push_back(json_of_part(source, scene));
  json["radiance"] = json_of_part(ray.radiance);
  return json;
}

/// Returns a text, followed by `name` in quotes if there is a name.
std::string with_name(const std::string& text, const std::string& name) {
  return name.empty() ? text : text + " \"" + name + "\"";
}

std::string text_of(const vec3& v) {
  return fmt::format("({:.6g} {:.6g} {:.6g})", v.x, v.y, v.z);
}

std::string text_of_place(const vec3& place, const Scene& scene) {
  if (scene.center == dvec3(0.0)) return text_of(place);
  const dvec3 world = scene.center + dvec3(place);
  return fmt::format("({:.12g} {:.12g} {:.12g})", world.x, world.y, world.z);
}

std::string text_of(const Hit& hit, const Scene& scene) {
  const auto object = static_cast<uint32_t>(hit.object);
  return fmt::format("{} primitive {} at t {:.6g}",
                     with_name(fmt::format("object {}", object), scene.objects[object].name), hit.primitive, hit.t);
}

std::string text_of(const ExplainedSource& source, const Scene& scene) {
  const std::string_view other = name_of_other(source);
  const std::string name = other.empty()
                               ? with_name(fmt::format("light {}", source.light), scene.lights[source.light].name)
                               : fmt::format("the {}", other);
  if (source.is_visible()) return fmt::format("{}: visible, adds {}", name, text_of(source.contribution));
  if (!source.shadow_ray) return name + ": adds nothing from where it is";
  return fmt::format("{}: blocked by {}", name, text_of(source.blocker, scene));
}

/// Returns the text of a ray. `depth` is the number of rays that lead to it.
std::string text_of(const ExplainedRay& ray, size_t depth, const Scene& scene) {
  const std::string indent(2 * depth + 2, ' ');
  std::string text = fmt::format("{}{} ray from {} along {}, weight {}\n", indent, ray_name_of(ray.kind),
                                 text_of_place(ray.ray.origin, scene), text_of(ray.ray.direction), text_of(ray.weight));
  const auto add = [&](const std::string& line) { text += indent + "  " + line + "\n"; };
  if (ray.hit.object < 0) {
    add("misses: background " + text_of(ray.own));
  } else {
    add(fmt::format("hits {}, u {:.6g}, v {:.6g}", text_of(ray.hit, scene), ray.hit.u, ray.hit.v));
    add(fmt::format("at {}, normal {}, {}", text_of_place(ray.position, scene), text_of(ray.shading_normal),
                    with_name(fmt::format("material {}", ray.material), scene.materials[ray.material].name)));
    if (ray.coverage < 1.0F) add(fmt::format("covers {:.6g} of what is behind", ray.coverage));
    add("ambient and emitted " + text_of(ray.own));
  }
  for (const ExplainedSource& source : ray.sources) add(text_of(source, scene));
  add("path so far " + text_of(ray.radiance));
  return text;
}

}  // namespace

std::string explain_json(const Explanation& explanation, const Scene& scene) {
  OrderedJson samples = OrderedJson::array();
  for (const ExplainedSample& sample : explanation.samples) {
    OrderedJson rays = OrderedJson::array();
    for (const ExplainedRay& ray : sample.rays) rays.push_back(json_of_part(ray, scene));
    samples.push_back({{"rays", rays}, {"radiance", json_of_part(sample.radiance())}});
  }
  const OrderedJson json = {{"pixel", {explanation.pixel.x, explanation.pixel.y}},
                            {"samples", samples},
                            {"sum", json_of_part(explanation.sum)},
                            {"color", json_of_part(explanation.color)}};
  return json_text(json, 2) + "\n";
}

std::string explain_text(const Explanation& explanation, const Scene& scene) {
  std::string text =
      fmt::format("pixel {} {}: {}\n", explanation.pixel.x, explanation.pixel.y, text_of(explanation.color));
  for (size_t i = 0; i < explanation.samples.size(); ++i) {
    text += fmt::format("sample {}\n", i);
    const ExplainedSample& sample = explanation.samples[i];
    std::vector<size_t> depths;
    for (const ExplainedRay& ray : sample.rays) {
      depths.push_back(ray.kind == RayKind::kCamera ? 0 : depths[ray.parent] + 1);
      text += text_of(ray, depths.back(), scene);
    }
  }
  return text;
}

}  // namespace promin::app
