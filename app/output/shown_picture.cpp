// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "output/shown_picture.h"

#include <utility>

#include "work/pictures/frame_plan.h"
#include "work/pictures/picture_run.h"
#include "work/pictures/tracing_run.h"

namespace promin::app {

Image render_shown(const RenderSpec& options, const gpu::Device& device, const Console& console) {
  const PictureRun run = prepare_pictures(options, plan_frames(options), console);
  const View& view = *run.stats.view;
  Renderer renderer =
      make_renderer(device, run.scene, make_renderer_options(run.options, count_samples(view, 1, run.options)));
  RenderResult result = renderer.render(view);
  check_validation(device, run.stats);
  std::vector<vec3>& pixels = result.image.pixels;
  const std::vector<vec4>& unlit = result.aovs.unlit;
  DisplayTransform display = run.stats.display;
  if (options.view.look.averages_exposure) {
    display.exposure_ev = average_exposure_ev(pixels, result.aovs.object, unlit);
  }
  for (size_t i = 0; i < pixels.size(); ++i) {
    pixels[i] = apply(display, pixels[i], unlit.empty() ? vec4(0.0F) : unlit[i]);
  }
  return std::move(result.image);
}

}  // namespace promin::app
