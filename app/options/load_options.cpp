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
