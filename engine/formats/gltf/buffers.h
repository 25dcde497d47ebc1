// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/load_report.h"

namespace promin {

/// The bytes of every buffer of a document: from data: URIs, files beside the scene (see find_beside_scene) or the
/// GLB's binary chunk, each at least its byteLength long. Problems go to the report.
std::vector<std::vector<std::byte>> read_gltf_buffers(const nlohmann::json& document,
                                                      std::optional<std::span<const std::byte>> glb_binary,
                                                      LoadReport& report);

/// RFC 4648, with or without padding; nullopt where the text is no base64.
std::optional<std::vector<std::byte>> decode_base64(std::string_view text);

/// RFC 3986: "%20" is a space; nullopt for a broken escape.
std::optional<std::string> decode_percent(std::string_view text);

}  // namespace promin
