// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/gltf/document.h"

namespace promin {

/// Returns the bytes to which a URI refers, or the first `most_bytes` of them (for a data: URI up to three more). The
/// bytes are in a file beside the scene or in the URI itself. If this fails, adds the reason to the report and returns
/// nullopt.
std::optional<std::vector<std::byte>> read_gltf_uri(const std::string& uri, const std::string& place,
                                                    LoadReport& report,
                                                    uint64_t most_bytes = std::numeric_limits<uint64_t>::max());

/// Returns for each buffer view whether it is needed: whether it contains instances, attributes or indices of meshes
/// that are read, or, with `with_extras`, images, animations or any morph targets.
std::vector<bool> find_needed_views(const GltfDocument& document, bool with_extras);

/// Returns whether the bytes of a view, or the bytes of its compressed data, are available.
bool has_bytes(const GltfDocument& document, size_t view);
/// Returns whether the bytes of all views of an accessor are available.
bool has_accessor_bytes(const GltfDocument& document, int accessor);

/// Returns the bytes of every buffer of a document. They come from data: URIs, from files beside the scene (see
/// find_beside_scene) or from the GLB's binary chunk. A buffer with needed views, or with their compressed data, has
/// all bytes of these views; other buffers are empty. Missing bytes of a buffer that meshes need are an error; those of
/// other buffers cause a warning. Problems go to the report.
GltfBuffers read_gltf_buffers(const GltfDocument& document, std::optional<std::span<const std::byte>> glb_binary,
                              LoadReport& report);

/// Decodes base64 (RFC 4648), with or without padding, in either alphabet. Returns nullopt if the text is no base64.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

/// Decodes percent escapes (RFC 3986): "%20" is a space. Returns nullopt for a broken escape.
std::optional<std::string> decode_percent(std::string_view text);

}  // namespace promin
