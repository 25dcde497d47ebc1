// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "formats/source_file.h"
#include "output/work_names.h"
#include "promin/load_scene.h"
#include "promin/scene.h"
#include "promin/view.h"
#include "work/pictures/camera_path.h"
#include "work/pictures/run_stats.h"
#include "work/spec/environment_choice.h"
#include "work/spec/render_spec.h"

namespace promin::app {

/// A scene that was opened for a window: it is read, lit, and has a camera.
struct OpenedScene {
  std::filesystem::path file;
  LoadOptions load;
  MotionOptions motion;
  EnvironmentChoice environment;
  std::shared_ptr<const Scene> scene;
  Bounds bounds;
  /// The files from which the scene was read.
  std::vector<SourceFile> sources;
  View view;
  /// The integrator of a picture whose options name none.
  Integrator usual_integrator = Integrator::kWhitted;
  /// The options for lighting and showing the scene, with the light that was chosen for it (settle_light()). The scene
  /// keeps this light with every integrator.
  LookOptions look;
  /// The flight to play.
  std::optional<PathPictures> replay;
  RunStats stats;
};

/// A function that opens the scene of a file. Throws Error.
using OpenScene = std::function<OpenedScene(const std::filesystem::path& file)>;

}  // namespace promin::app
