// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "options/render_options.h"
#include "promin/scene.h"
#include "promin/view.h"

namespace promin::app {

/// The settings of a scene for a command: its file, lights, display, and the camera that determines the size of an
/// orthographic view.
struct DescribedScene {
  std::filesystem::path file;
  /// The picture's file; without one the command gets a default name.
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
  /// The builder of the tree, which affects the step counts that a picture may show.
  std::string builder = "sah";
  std::optional<std::filesystem::path> bvh = std::nullopt;
};

/// Returns the scene's camera with an orthographic camera's half height, which no option can set.
std::optional<size_t> find_half_height(const Scene& scene, const Camera& camera);

/// Returns whether there is such a command. There is none for an orthographic view whose half height no camera of the
/// scene has.
bool can_describe(const DescribedScene& scene, const View& view);

/// Returns the `promin render` command, for a shell, that gives the picture of a view bit for bit.
std::string describe_command(const DescribedScene& scene, const View& view);

}  // namespace promin::app
