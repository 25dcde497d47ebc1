// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/pixel_query.h"

#include <fmt/format.h>

#include "explanation.h"

namespace promin::app {
void PixelQuery::ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel) {
  if (text_.is_busy()) return;
  text_.start([scene = std::move(scene), view, pixel] {
    const Explanation explanation = scene->renderer->explain(view, pixel);
    return PixelText{fmt::format("pixel {}, {} at 1 spp", pixel.x, pixel.y), explain_text(explanation, *scene->scene)};
  });
}

void PixelQuery::ask_middle(std::shared_ptr<const ShownScene> scene, const Camera& camera) {
  if (middle_.is_busy()) return;
  middle_.start([scene = std::move(scene), camera]() -> std::optional<dvec3> {
    // The sample of a picture of one pixel goes through its middle.
    View view;
    view.camera = camera;
    view.size = uvec2(1);
    view.max_depth = 0;
    const ExplainedRay ray = scene->renderer->explain(view, uvec2(0)).samples.front().rays.front();
    return ray.hit.object < 0 ? std::nullopt : std::optional(dvec3(ray.position));
  });
}

void PixelQuery::wait() const {
  text_.wait();
  middle_.wait();
}

}  // namespace promin::app
