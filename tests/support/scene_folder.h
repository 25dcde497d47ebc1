// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "promin/load_scene.h"
#include "scene/world_scene.h"
#include "support/temp_folder.h"

namespace promin {

/// A loaded scene in world space, with its warnings.
struct LoadedScene : world::Scene {
  std::vector<std::string> warnings;
};

/// A test with a separate folder, in which it writes small scenes and loads them.
class SceneFolder : public TempFolder {
 protected:
  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    // The file is new each time, because some file systems flush when a file is truncated.
    std::filesystem::remove(folder_ / name);
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  LoadedScene load(const std::string& name, std::string_view bytes) const {
    const Scene scene = load_scene(write(name, bytes));
    return {world::flatten(scene), scene.warnings};
  }

  /// Returns the message with which load_scene refuses a file; empty if it does not.
  static std::string refusal(const std::filesystem::path& file) {
    return message_of([&] { load_scene(file); });
  }
  std::string refusal(const std::string& name, std::string_view bytes) const { return refusal(write(name, bytes)); }
};

/// Returns the text with lines that end in \r\n.
inline std::string with_carriage_returns(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '\n') result += '\r';
    result += c;
  }
  return result;
}

inline const Mesh& mesh_of(const world::Scene& scene, size_t object = 0) {
  return std::get<Mesh>(scene.objects.at(object).shape);
}

/// Returns the corners of a mesh, triangle after triangle.
inline std::vector<vec3> corners_of(const Mesh& mesh) {
  std::vector<vec3> corners;
  for (const uvec3& triangle : mesh.triangles) {
    for (int i = 0; i < 3; ++i) corners.push_back(mesh.positions.at(triangle[i]));
  }
  return corners;
}

}  // namespace promin
