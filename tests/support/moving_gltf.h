// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "support/gltf_builder.h"

namespace promin::test {

/// Adds a channel to an animation of the document, which gets animations as needed. `target` is a path such as
/// "/nodes/0/rotation". `output` is the accessor of the values.
inline void animate(GltfBuilder& gltf, size_t animation, const std::string& target, const std::vector<float>& times,
                    size_t output, const std::string& interpolation = "LINEAR") {
  using nlohmann::json;
  json& animations = gltf.json["animations"];
  while (animations.size() <= animation) {
    animations.push_back({{"channels", json::array()}, {"samplers", json::array()}});
  }
  json& clip = animations[animation];
  clip["samplers"].push_back(
      {{"input", gltf.add<float>(times, "SCALAR")}, {"output", output}, {"interpolation", interpolation}});
  const size_t sampler = clip["samplers"].size() - 1;
  const std::string path = target.substr(target.rfind('/') + 1);
  const bool is_of_node = target.starts_with("/nodes/") && target.find('/', 7) == target.rfind('/');
  if (is_of_node) {
    const size_t node = std::stoul(target.substr(7));
    clip["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
  } else {
    clip["channels"].push_back(
        {{"sampler", sampler},
         {"target", {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", target}}}}}}}});
  }
}

/// Adds the values of a channel as floats.
inline void animate(GltfBuilder& gltf, size_t animation, const std::string& target, const std::vector<float>& times,
                    const std::vector<float>& values, const std::string& type,
                    const std::string& interpolation = "LINEAR") {
  const size_t output = gltf.add<float>(values, type);
  animate(gltf, animation, target, times, output, interpolation);
}

}  // namespace promin::test
