// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/instances.h"

#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "formats/gltf/accessors.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;

const json* attributes_of(const GltfDocument& document, const PlacedNode& placed) {
  const json& node = document.json["nodes"][static_cast<size_t>(placed.node)];
  const json* extension = find_extension(node, "EXT_mesh_gpu_instancing");
  return extension == nullptr ? nullptr : &(*extension)["attributes"];
}

/// Reads the instances of one node.
class InstanceReader {
 public:
  InstanceReader(const GltfDocument& document, const json& attributes, int node, LoadReport& report)
      : document_(document),
        place_("nodes[" + std::to_string(node) + "].extensions.EXT_mesh_gpu_instancing.attributes."),
        report_(report),
        translations_(read(attributes, "TRANSLATION")),
        rotations_(read(attributes, "ROTATION")),
        scales_(read(attributes, "SCALE")) {}

  dmat4 transform(size_t instance) {
    dmat4 matrix(1.0);
    if (!rotations_.empty()) {
      const float* r = &rotations_[4 * instance];
      const glm::dquat rotation(r[3], r[0], r[1], r[2]);
      if (glm::dot(rotation, rotation) >= 1e-12) {
        matrix = glm::mat4_cast(glm::normalize(rotation));
      } else {
        report_.repair({"gltf.rotation.zero", "a rotation has length 0", "",
                        place_ + "ROTATION, element " + std::to_string(instance), "use a unit quaternion",
                        "the instance is not turned"});
      }
    }
    for (int i = 0; i < 3 && !scales_.empty(); ++i) matrix[i] *= scales_[3 * instance + static_cast<size_t>(i)];
    if (!translations_.empty()) {
      const float* t = &translations_[3 * instance];
      matrix[3] = dvec4(t[0], t[1], t[2], 1.0);
    }
    return matrix;
  }

 private:
  std::vector<float> read(const json& attributes, const char* name) {
    const auto accessor = attributes.find(name);
    if (accessor == attributes.end()) return {};
    std::vector<float> numbers = read_floats(document_, *accessor, report_);
    for (size_t i = 0; i < numbers.size(); ++i) {
      if (std::isfinite(numbers[i])) continue;
      const size_t components = document_.accessors[accessor->get<size_t>()].component_count;
      report_.refuse("gltf.number.range", "a number is not finite",
                     place_ + name + ", element " + std::to_string(i / components), "export the file again");
      break;
    }
    return numbers;
  }

  const GltfDocument& document_;
  std::string place_;
  LoadReport& report_;
  std::vector<float> translations_;
  std::vector<float> rotations_;
  std::vector<float> scales_;
};

}  // namespace

std::optional<uint64_t> count_gltf_instances(const GltfDocument& document, const PlacedNode& placed) {
  const json* attributes = attributes_of(document, placed);
  // All attributes of instances have the same count (checks.h).
  if (attributes == nullptr || attributes->empty()) return std::nullopt;
  return document.accessors[attributes->begin()->get<size_t>()].count;
}

std::vector<dmat4> place_gltf_instances(const GltfDocument& document, const PlacedNode& placed, LoadReport& report) {
  std::vector<dmat4> places;
  const std::optional<uint64_t> count = count_gltf_instances(document, placed);
  if (!count) return places;
  InstanceReader reader(document, *attributes_of(document, placed), placed.node, report);
  places.reserve(*count);
  for (size_t i = 0; i < *count; ++i) places.push_back(reader.transform(i));
  return places;
}

}  // namespace promin
