// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace promin::app {

/// SHA-256 over the sources that decide about the bits of pictures and hits, of which this program was built
/// (cmake/hash_sources.cmake): the programs and the Python module of one state of the sources have the same.
extern const std::string_view kSourcesHash;

}  // namespace promin::app
