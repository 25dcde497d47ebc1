// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

// What a glTF document must hold beyond its schema (schema.h), checked before any reader uses it.

/// Checks the version, and that parts which belong together are there.
void check_gltf_asset(const nlohmann::json& document, LoadReport& report);

/// Checks that the nodes form trees: there are no cycles, a node has at most one parent, and scenes list roots, once
/// each. Every transform must be one: a rotation of some length, or an affine matrix.
void check_gltf_nodes(const nlohmann::json& document, LoadReport& report);

/// Checks that buffer views lie within their buffers' byteLength and accessors within their views, and that attributes
/// have the formats and counts that the specification (section 3.7.2.1) and KHR_mesh_quantization allow.
void check_gltf_accessors(const nlohmann::json& document, LoadReport& report);

/// Whether meshes are read with this attribute. Any other is ignored, and the buffer it lies in may lack its bytes.
bool is_read_attribute(std::string_view name);

/// Types of components, by their numbers in the file.
inline constexpr int kGltfByte = 5120;
inline constexpr int kGltfUnsignedByte = 5121;
inline constexpr int kGltfShort = 5122;
inline constexpr int kGltfUnsignedShort = 5123;
inline constexpr int kGltfUnsignedInt = 5125;
inline constexpr int kGltfFloat = 5126;

/// Bytes of one component of a type such as kGltfFloat; components of a type such as "VEC3".
uint64_t component_bytes(int component_type);
uint64_t component_count(const std::string& type);

}  // namespace promin
