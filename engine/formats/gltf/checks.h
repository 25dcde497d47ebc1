// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>

#include "formats/load_report.h"

namespace promin {

// What a glTF document must hold beyond its schema (gltf_schema.h), checked before tinygltf or anything else uses it.

/// Version, required extensions, parts that belong together.
void check_gltf_asset(const nlohmann::json& document, LoadReport& report);

/// The nodes form trees: no cycles, one parent at most; scenes list roots, once each. Every transform is one: a
/// rotation of some length, an affine matrix.
void check_gltf_nodes(const nlohmann::json& document, LoadReport& report);

/// Buffer views lie within their buffers' byteLength and accessors within their views; attributes have the formats
/// and counts that the specification (section 3.7.2.1) and KHR_mesh_quantization allow.
void check_gltf_accessors(const nlohmann::json& document, LoadReport& report);

/// Bytes of one component of a type such as 5126 (float); components of a type such as "VEC3".
uint64_t component_bytes(int component_type);
uint64_t component_count(const std::string& type);

}  // namespace promin
