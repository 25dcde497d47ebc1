// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace promin {

/// The text with U+FFFD in place of what is not UTF-8: names and words of files may be in any encoding, but messages,
/// JSON, EXR files and Python want UTF-8.
std::string to_utf8(std::string_view text);

/// The text with question marks in place of control characters, for what a terminal shows: names and words of files may
/// hold line feeds and what drives it.
std::string to_one_line(std::string_view text);

}  // namespace promin
