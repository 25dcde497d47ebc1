// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

/// The parts of a .gltf or .glb file, as views of its bytes.
struct GltfContainer {
  std::string_view json;
  /// The binary chunk of a GLB file.
  std::optional<std::span<const std::byte>> binary;
};

/// Splits a file into its parts. A GLB file begins with a magic number (glTF 2.0, section 4.4). Every length is checked
/// against the size of the file. A chunk that lacks more than padding is refused, a wrong length in the header is
/// repaired, and bytes after the end of the GLB cause a warning. Throws InputError.
GltfContainer split_gltf(std::span<const std::byte> bytes, LoadReport& report);

}  // namespace promin
