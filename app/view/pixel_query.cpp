// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/pixel_query.h"

#include <fmt/format.h>

#include "device/device.h"
#include "explanation.h"
#include "trace/explain_pixel.h"

namespace promin::app {
namespace {

Explanation explain(const gpu::Device& device, const ShownScene& scene, const RenderMode& look, const View& view,
                    const uvec2& pixel) {
  Explanation explanation;
  gpu::translate_vulkan_errors([&] {
    explanation = explain_pixel(device, *scene.on_device, scene.numbers, scene.light_features(look), view, pixel);
  });
  return explanation;
}

}  // namespace

void PixelQuery::ask_why(std::shared_ptr<const ShownScene> scene, const RenderMode& look, const View& view,
                         const uvec2& pixel) {
  if (text_.is_busy()) return;
  text_.start([this, scene = std::move(scene), look, view, pixel] {
    Explanation explanation = explain(*device_, *scene, look, view, pixel);
    number_lights_of_whole(explanation, scene->choice.lights_off);
    return PixelText{fmt::format("pixel {}, {} at 1 spp", pixel.x, pixel.y), explain_text(explanation, *scene->scene)};
  });
}

void PixelQuery::ask_middle(std::shared_ptr<const ShownScene> scene, const RenderMode& look, const Camera& camera) {
  if (middle_.is_busy()) return;
  middle_.start([this, scene = std::move(scene), look, camera]() -> std::optional<dvec3> {
    // The sample of a picture of one pixel goes through its middle.
    View view;
    view.camera = camera;
    view.size = uvec2(1);
    view.max_depth = 0;
    const ExplainedRay ray = explain(*device_, *scene, look, view, uvec2(0)).samples.front().rays.front();
    return ray.hit.object < 0 ? std::nullopt : std::optional(dvec3(ray.position));
  });
}

void PixelQuery::wait() const {
  text_.wait();
  middle_.wait();
}

}  // namespace promin::app
