// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace promin {

/// Returns the text with U+FFFD in place of bytes that are not UTF-8. Names and words of files may have any encoding,
/// but messages, JSON, EXR files and Python need UTF-8.
std::string to_utf8(std::string_view text);

/// Returns the text with question marks in place of control characters, for output on a terminal. Names and words of
/// files may contain line feeds and escape sequences.
std::string to_one_line(std::string_view text);

}  // namespace promin
