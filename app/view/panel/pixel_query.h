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

/// A pixel's ray tree for the user.
struct ExplainedPixel {
  std::string title;
  Explanation explanation;
  /// The scene that it is of.
  std::shared_ptr<const Scene> scene;
  /// What the view shows of it.
  ScreenCover cover;
};

/// Traces single pixels of a shown scene beside its picture, each query on a separate thread.
class PixelQuery {
 public:
  /// Requests the explanation of a pixel of the view, traced with one sample. A query that comes before the previous
  /// one is answered is dropped.
  void ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel);
  /// Requests the point of the scene that a pixel of the view shows; it is dropped in the same case.
  void ask_point(std::shared_ptr<const ShownScene> scene, View view, const uvec2& pixel);

  bool is_busy() const { return explained_.is_busy() || point_.is_busy(); }
  bool is_looking_for_point() const { return point_.is_busy(); }
  /// Return the answers when they are ready. They throw RunError.
  std::optional<ExplainedPixel> take_explained() { return explained_.take(); }
  /// Returns the point in the world; the inner optional is empty on a miss.
  std::optional<std::optional<dvec3>> take_point() { return point_.take(); }

  /// Waits until no query is running.
  void wait() const;

 private:
  /// The device and scene for queries, created at the first one.
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
