// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "promin/scene.h"
#include "promin/view.h"
#include "render_options.h"

namespace promin::app {

/// What of a scene a command leaves out, how it lights and shows it, and which camera gives an orthographic view its
/// size.
struct DescribedScene {
  std::filesystem::path file;
  /// The picture's file; without one the command gets a name of its own.
  std::optional<std::filesystem::path> output = std::nullopt;
  bool has_shadows = true;
  std::vector<uint32_t> lights_off = {};
  LookOptions look = {};
  EnvironmentOptions environment = {};
  std::string variant = {};
  std::filesystem::path root = {};
  /// Scene::center.
  dvec3 center = dvec3(0.0);
  /// The scene's camera that has the view's half height.
  std::optional<size_t> camera_index = std::nullopt;
  /// The tree, which decides the steps that a picture may show.
  std::string builder = "sah";
  std::optional<std::filesystem::path> bvh = std::nullopt;
};

/// The scene's camera that has an orthographic camera's half height, which no option gives.
std::optional<size_t> find_half_height(const Scene& scene, const Camera& camera);

/// Whether there is such a command. There is none for an orthographic view whose half height no camera of the scene
/// has.
bool can_describe(const DescribedScene& scene, const View& view);

/// The `promin render` command that gives the picture of a view, to the bit, for a shell.
std::string describe_command(const DescribedScene& scene, const View& view);

}  // namespace promin::app
