// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "view/panel/pixel_query.h"

#include <fmt/format.h>

#include <utility>

#include "trace/film/explain_pixel.h"
#include "trace/render/renderer_impl.h"

namespace promin::app {

std::shared_ptr<PixelQuery::Place> PixelQuery::place_for(const std::shared_ptr<const ShownScene>& scene) {
  if (scene_ != scene) place_ = std::make_shared<Place>();
  scene_ = scene;
  return place_;
}

Explanation PixelQuery::explain(Place& place, const ShownScene& scene, const View& view, const uvec2& pixel) {
  const std::lock_guard lock(place.one_at_a_time);
  if (!place.apart.scene) place.apart = scene.set_apart();
  const SceneOnDevice& on_device = *scene.on_device;
  const FeatureMask features =
      on_device.features({.has_shadows = view.mode.has_shadows, .integrator = view.mode.integrator});
  Explanation explanation;
  gpu::translate_vulkan_errors([&] {
    explanation = explain_pixel(*place.apart.device, place.apart.scene, on_device.numbers(), features, view, pixel);
  });
  return explanation;
}

void PixelQuery::ask_why(std::shared_ptr<const ShownScene> scene, const View& view, const uvec2& pixel) {
  if (explained_.is_busy()) return;
  explained_.start([place = place_for(scene), scene, view, pixel] {
    return ExplainedPixel{fmt::format("pixel {}, {} at 1 spp", pixel.x, pixel.y), explain(*place, *scene, view, pixel),
                          scene->scene,
                          find_cover(*scene->scene, view.camera, double(view.size.x) / double(view.size.y))};
  });
}

void PixelQuery::ask_point(std::shared_ptr<const ShownScene> scene, View view, const uvec2& pixel) {
  if (point_.is_busy()) return;
  view.max_depth = 0;
  point_.start([place = place_for(scene), scene, view, pixel]() -> std::optional<dvec3> {
    const ExplainedRay ray = explain(*place, *scene, view, pixel).samples.front().rays.front();
    return ray.hit.object < 0 ? std::nullopt : std::optional(dvec3(ray.position));
  });
}

void PixelQuery::wait() const {
  explained_.wait();
  point_.wait();
}

}  // namespace promin::app
