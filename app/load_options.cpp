// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "load_options.h"

#include "arguments.h"

namespace promin::app {

void add_strict_option(OptionTable& table, LoadOptions& options) {
  table.add_flag("--strict",
                 "Refuse a scene for anything that its format forbids, and for required extensions that are not known",
                 options.is_strict);
}

void add_root_option(OptionTable& table, LoadOptions& options) {
  table.add("--root", "DIR", "Let the scene name files in this folder, links resolved [its own folder]",
            [&](const OptionValues& w) {
              if (w.text().empty()) w.refuse("--root takes a folder, not \"\"");
              options.root = w.text();
            });
}

void add_variant_option(OptionTable& table, LoadOptions& options) {
  table.add("--variant", "NAME",
            "Variant of the scene's materials; `promin info` lists them [the file's own materials]",
            [&](const OptionValues& w) {
              if (w.text().empty()) w.refuse("--variant takes the name of a variant, not \"\"");
              options.material_variant = w.text();
            });
}

}  // namespace promin::app
