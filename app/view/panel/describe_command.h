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

/// The settings of a scene that a command needs: its file, lights and display, and the camera that determines the size
/// of an orthographic view.
struct DescribedScene {
  std::filesystem::path file;
  /// The picture's file. If empty, the command uses a default name.
  std::optional<std::filesystem::path> output = std::nullopt;
  bool has_shadows = true;
  std::vector<uint32_t> lights_off = {};
  LookOptions look = {};
  /// The integrator of a command that names none.
  Integrator usual_integrator = Integrator::kWhitted;
  EnvironmentOptions environment = {};
  std::string variant = {};
  std::filesystem::path root = {};
  MotionOptions motion = {};
  /// The center of the scene, Scene::center.
  dvec3 center = dvec3(0.0);
  /// Index of the scene's camera that has the same half height as the view.
  std::optional<size_t> camera_index = std::nullopt;
  Instancing instances = Instancing::kAuto;
  /// The builder of the tree, which affects the step counts that a picture may show.
  std::string builder = "sah";
  std::optional<std::filesystem::path> bvh = std::nullopt;
};

/// Returns the index of the scene's camera with the half height of an orthographic camera, which no option can set.
std::optional<size_t> find_half_height(const Scene& scene, const Camera& camera);

/// Returns whether a command can describe the view. It cannot if the view is orthographic and no camera of the scene
/// has its half height.
bool can_describe(const DescribedScene& scene, const View& view);

/// Returns the `promin render` command, for a shell, that renders the picture of a view with the same bits.
std::string describe_command(const DescribedScene& scene, const View& view);

}  // namespace promin::app
