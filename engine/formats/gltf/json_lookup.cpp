// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/json_lookup.h"

#include "formats/load_report.h"

namespace promin {

using nlohmann::json;

const json& elements_of(const json& object, const char* name) {
  static const json kNone = json::array();
  const auto member = object.find(name);
  return member == object.end() ? kNone : *member;
}

const json* find_extension(const json& element, const char* name) {
  const auto extensions = element.find("extensions");
  if (extensions == element.end()) return nullptr;
  const auto extension = extensions->find(name);
  return extension == extensions->end() ? nullptr : &*extension;
}

dvec3 vec3_of(const json& object, const char* name, const dvec3& otherwise) {
  const auto member = object.find(name);
  if (member == object.end()) return otherwise;
  const json& v = *member;
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()};
}

dvec4 vec4_of(const json& object, const char* name, const dvec4& otherwise) {
  const auto member = object.find(name);
  if (member == object.end()) return otherwise;
  const json& v = *member;
  return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>(), v[3].get<double>()};
}

std::string title_of(const json& document, const char* array, size_t index) {
  const json& element = document[array][index];
  const std::string name = element.is_object() ? element.value("name", "") : "";
  return name.empty() ? std::string(array) + "[" + std::to_string(index) + "]" : quote(name);
}

}  // namespace promin
