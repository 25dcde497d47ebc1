// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "render_help.h"

#include "help.h"

namespace promin::app {

void arrange_help(CLI::App& program, CLI::App& render) {
  add_examples(program, {{"promin model.glb", "writes model.png, and model.exr with linear light"},
                         {"promin model.glb -o poster.jpg --size 4k", "writes one picture of 3840x2160 pixels"},
                         {"promin model.glb -o cut.png --alpha", "leaves the background out"},
                         {"promin model.glb -o layers.exr --aov depth,normal", "adds distances and normals"},
                         {"promin compare before.png after.png", "says how far two pictures are apart"},
                         {"promin info model.glb", "lists what a file holds: cameras, lights, materials"}});
  group_options(
      render,
      {{"Output", {"output", "size", "crop", "alpha", "aov", "depth", "half", "compression", "multipart", "explain"}},
       {"Quality",
        {"quality", "spp", "target-error", "time-limit", "min-spp", "max-spp", "error-in", "filter", "filter-width",
         "max-depth"}},
       {"Camera",
        {"from", "azimuth", "elevation", "roll", "zoom", "fit", "camera", "eye", "look-at", "direction", "up", "fov",
         "near", "path", "frames", "fps", "skip-existing"}},
       {"Look",
        {"background", "light", "environment", "environment-rotation", "environment-intensity", "light-rotation",
         "exposure", "tone-mapping", "dither", "no-shadows", "lights-off", "variant", "shading"}},
       {"Jobs", {"job", "pieces", "tiles", "piece"}},
       {"Expert", {}}});
  add_examples(render, {{"promin render model.glb -o picture.png --size hd --spp 16", "16 samples a pixel, 1280x720"},
                        {"promin render model.glb -o best.png --time-limit 20", "the best picture of about 20 seconds"},
                        {"promin render model.glb -o big.exr --job work",
                         "continues where it was ended, with the same command"}});
}

}  // namespace promin::app
