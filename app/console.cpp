// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "console.h"

#include <fmt/format.h>

#include <cstdio>

namespace promin::app {

void Console::print(const std::string& text, Verbosity least) const {
  // fmt::print would throw where the stream is closed, and that is no reason to fail.
  if (verbosity_ >= least) std::fputs(fmt::format("promin: {}\n", text).c_str(), stderr);
}

}  // namespace promin::app
