// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "options/load_options.h"

#include "options/arguments.h"

namespace promin::app {

void add_strict_option(OptionTable& table, LoadOptions& options) {
  table.add_flag("--strict", "Refuse a scene that breaks any rule of its format, or that requires an unknown extension",
                 options.is_strict);
}

void add_root_option(OptionTable& table, LoadOptions& options) {
  table.add("--root", "DIR",
            "Allow the scene to name any file below this folder. Links are resolved first [the scene's own folder]",
            [&](const OptionValues& w) {
              if (w.text().empty()) w.refuse("--root takes a folder, not \"\"");
              options.root = w.text();
            });
}

void add_motion_options(OptionTable& table, work::MotionOptions& options) {
  table.add("--time", "T",
            "Show the scene as its animation has it after T seconds. Before its first key and after its last one "
            "nothing moves [the pose of the scene's nodes]",
            [&](const OptionValues& w) { options.time_s = w.real(0, 0.0, work::kMaxTime); });
  table.add_repeated("--animation", "NAME|INDEX|all|none",
                     "Animation to show, by its name or index. all shows all animations together, and none the pose of "
                     "the nodes. The option may be repeated, or have several indices. If several animations change the "
                     "same property, the first of them counts. `promin info` lists the animations [0]",
                     [&](const OptionValues& w) {
                       for (const std::string& name : w.all()) {
                         if (name.empty()) w.refuse("--animation takes the name or index of an animation, not \"\"");
                       }
                       options.animations = w.all();
                     });
  table.add_flag("--loop", "Start each animation again after its end", options.loops);
}

void add_variant_option(OptionTable& table, LoadOptions& options) {
  table.add("--variant", "NAME",
            "Use this variant of the scene's materials. `promin info` lists the variants [the materials that the file "
            "assigns]",
            [&](const OptionValues& w) {
              if (w.text().empty()) w.refuse("--variant takes the name of a variant, not \"\"");
              options.material_variant = w.text();
            });
}

}  // namespace promin::app
