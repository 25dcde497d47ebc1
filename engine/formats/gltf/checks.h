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

/// Makes cameras without parameters null, with a warning.
void check_gltf_cameras(nlohmann::json& document, LoadReport& report);

/// Refuses nodes that are their own ancestors. What else keeps nodes from being trees of transforms is repaired: a
/// scene lists each node once, and none that lies below another that it lists; a node has each child once; a matrix
/// counts alone and is affine; a rotation has some length. A node with two parents is warned of and shown below both.
void check_gltf_nodes(nlohmann::json& document, bool is_strict, LoadReport& report);

/// Checks that buffer views lie within their buffers' byteLength and accessors within their views, and that attributes
/// have the formats and counts that the specification (section 3.7.2.1) and KHR_mesh_quantization allow. Attributes
/// that only shade are left out of their primitives where they do not, and images are left without their views.
void check_gltf_accessors(nlohmann::json& document, bool is_strict, LoadReport& report);

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
