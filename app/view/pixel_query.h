// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "promin/explain.h"
#include "view/background.h"
#include "view/scene_preparer.h"
#include "view/screen_cover.h"

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

/// Traces single pixels of a shown scene beside its picture, each question on a thread of its own.
class PixelQuery {
 public:
  /// Asks what a pixel of the view is made of, traced with one sample. A question that comes before the answer to the
  /// one before is dropped.
  void ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel);
  /// Asks which point of the scene a pixel of the view shows; it is dropped in the same case.
  void ask_point(std::shared_ptr<const ShownScene> scene, View view, const uvec2& pixel);

  bool is_busy() const { return explained_.is_busy() || point_.is_busy(); }
  bool is_looking_for_point() const { return point_.is_busy(); }
  /// The answers, once they are there. They throw RunError.
  std::optional<ExplainedPixel> take_explained() { return explained_.take(); }
  /// The point in the world; nullopt where there is nothing.
  std::optional<std::optional<dvec3>> take_point() { return point_.take(); }

  /// Waits until no question is being answered.
  void wait() const;

 private:
  /// Where questions about a scene are answered, made when the first is asked.
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
