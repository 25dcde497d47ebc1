// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace promin::app {

/// SHA-256 over the sources of this program that affect the bits of pictures and hits (cmake/hash_sources.cmake).
/// Programs and Python modules built from the same sources have the same hash.
extern const std::string_view kSourcesHash;

}  // namespace promin::app
