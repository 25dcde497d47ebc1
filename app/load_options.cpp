// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "load_options.h"

#include "arguments.h"

namespace promin::app {

void add_strict_option(OptionTable& table, LoadOptions& options) {
  table.add_flag("--strict",
                 "Refuse glTF files that require an extension which is not known, also where only materials have it",
                 options.is_strict);
}

}  // namespace promin::app
