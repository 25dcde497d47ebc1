// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "promin/explain.h"
#include "view/display/background.h"
#include "view/panel/screen_cover.h"
#include "view/scene/scene_preparer.h"

namespace promin::app {

/// The ray tree of a pixel, to be shown to the user.
struct ExplainedPixel {
  std::string title;
  Explanation explanation;
  /// The scene to which the pixel belongs.
  std::shared_ptr<const Scene> scene;
  /// The parts of the window in which the view shows the scene.
  ScreenCover cover;
};

/// Traces single pixels of a scene in addition to its picture. Each query runs on a separate thread.
class PixelQuery {
 public:
  /// Requests the explanation of a pixel of the view, traced with one sample. The request is dropped if the previous
  /// query is still running.
  void ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel);
  /// Requests the point of the scene that a pixel of the view shows. The request is dropped if the previous query is
  /// still running.
  void ask_point(std::shared_ptr<const ShownScene> scene, View view, const uvec2& pixel);

  bool is_busy() const { return explained_.is_busy() || point_.is_busy(); }
  bool is_looking_for_point() const { return point_.is_busy(); }
  /// Returns the explanation when it is ready. Throws RunError.
  std::optional<ExplainedPixel> take_explained() { return explained_.take(); }
  /// Returns the point in the world when it is ready; the inner optional is empty on a miss. Throws RunError.
  std::optional<std::optional<dvec3>> take_point() { return point_.take(); }

  /// Waits until no query is running.
  void wait() const;

 private:
  /// The device and scene for queries, created at the first query.
  struct Place {
    std::mutex one_at_a_time;
    SceneOn apart;
  };
  std::shared_ptr<Place> place_for(const std::shared_ptr<const ShownScene>& scene);
  static Explanation explain(Place& place, const ShownScene& scene, const View& view, const uvec2& pixel);

  std::shared_ptr<const ShownScene> scene_;
  std::shared_ptr<Place> place_;
  Background<ExplainedPixel> explained_;
  Background<std::optional<dvec3>> point_;
};

}  // namespace promin::app
