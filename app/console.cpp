// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>

#include <cstdio>

namespace promin::app {

void Console::print(const std::string& text, Verbosity least) const {
  if (verbosity_ >= least) fmt::print(stderr, "promin: {}\n", text);
}

}  // namespace promin::app
