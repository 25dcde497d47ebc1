// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace promin {

/// What lies in the place of a file that was never fetched.
struct StandIn {
  /// What it is.
  const char* what;
  const char* cure;
};

/// The kind of stand-in that a file is by its first bytes: a pointer of Git LFS, or a web page. nullptr where it is
/// none.
const StandIn* find_stand_in(std::string_view first_bytes);

/// The text behind a byte order mark and white space.
std::string_view skip_to_text(std::string_view bytes);

}  // namespace promin
