// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace promin {

/// A small file that is in the place of a file that was never downloaded.
struct StandIn {
  /// The kind of stand-in, for messages.
  const char* what;
  const char* cure;
};

/// Returns the kind of stand-in that the first bytes of a file show: a Git LFS pointer or a web page. nullptr for other
/// files.
const StandIn* find_stand_in(std::string_view first_bytes);

/// Returns the text after a byte order mark and white space.
std::string_view skip_to_text(std::string_view bytes);

}  // namespace promin
