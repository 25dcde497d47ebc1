// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/render_help.h"

#include "options/help.h"

namespace promin::app {

void arrange_help(CLI::App& program, CLI::App& render) {
  add_examples(
      program,
      {{"promin model.glb", "writes model.png, and model.exr with linear light"},
       {"promin model.glb -o poster.jpg --size 4k", "writes one picture of 3840x2160 pixels"},
       {"promin model.glb -o cut.png --alpha", "makes the background transparent"},
       {"promin model.glb -o layers.exr --aov depth,normal", "writes distances and normals as additional channels"},
       {"promin compare before.png after.png", "prints how much two pictures differ"},
       {"promin info model.glb", "lists the contents of a file, such as cameras, lights and materials"}});
  group_options(
      render,
      {{"Output", {"output", "size", "crop", "alpha", "aov", "depth", "half", "compression", "explain"}},
       {"Quality",
        {"quality", "spp", "target-error", "time-limit", "min-spp", "max-spp", "error-in", "filter", "filter-width",
         "max-depth", "seed"}},
       {"Camera",
        {"from",
         "azimuth",
         "elevation",
         "roll",
         "zoom",
         "fit",
         "camera",
         "eye",
         "look-at",
         "direction",
         "up",
         "fov",
         "near",
         "aperture-radius",
         "focus-distance",
         "path",
         "turntable",
         "frames",
         "fps",
         "shutter",
         "skip-existing"}},
       {"Look",
        {"background", "light", "environment", "environment-rotation", "environment-intensity", "light-rotation",
         "exposure", "tone-mapping", "dither", "no-shadows", "lights-off", "variant", "shading"}},
       {"Jobs", {"job", "pieces", "tiles", "piece", "spec", "print-spec"}},
       {"Expert", {}}});
  add_examples(
      render,
      {{"promin render model.glb -o picture.png --size hd --spp 16", "takes 16 samples per pixel at 1280x720"},
       {"promin render fox.glb -o fox.mp4", "renders the animation as a film"},
       {"promin render model.glb -o turn.mp4 --turntable 96", "shows the model from all sides, as a film"},
       {"promin render model.glb -o best.png --time-limit 20", "renders the best picture that takes about 20 seconds"},
       {"promin render model.glb -o big.exr --job work",
        "saves its work, so the same command continues it after an interruption"}});
}

}  // namespace promin::app
