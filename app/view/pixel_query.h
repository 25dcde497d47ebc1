// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "promin/math.h"
#include "view/background.h"
#include "view/scene_preparer.h"

namespace promin::app {

/// A pixel's ray tree for the user.
struct PixelText {
  std::string title;
  std::string text;
};

/// Traces single pixels of a shown scene beside its picture, each question on a thread of its own.
class PixelQuery {
 public:
  /// Asks what a pixel of the view is made of, traced with one sample. A question that comes before the answer to the
  /// one before is dropped.
  void ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel);
  /// Asks what is in the middle of the picture; it is dropped in the same case.
  void ask_middle(std::shared_ptr<const ShownScene> scene, const Camera& camera);

  bool is_busy() const { return text_.is_busy() || middle_.is_busy(); }
  bool is_looking_for_middle() const { return middle_.is_busy(); }
  /// The answers, once they are there. They throw RunError.
  std::optional<PixelText> take_text() { return text_.take(); }
  /// The point in the world; nullopt where there is nothing.
  std::optional<std::optional<dvec3>> take_middle() { return middle_.take(); }

  /// Waits until no question is being answered.
  void wait() const;

 private:
  Background<PixelText> text_;
  Background<std::optional<dvec3>> middle_;
};

}  // namespace promin::app
