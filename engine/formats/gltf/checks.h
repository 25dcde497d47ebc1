// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "formats/load_report.h"

namespace promin {

// Checks of a glTF document beyond its schema (schema.h). They run before any reader uses the document.

/// Sets cameras without parameters to null, with a warning.
void check_gltf_cameras(nlohmann::json& document, LoadReport& report);

/// Refuses nodes that are their own ancestors. Repairs other faults of the tree of transforms. Afterwards a scene lists
/// each node once, and no node below another listed node. A node lists each child once. A matrix is affine and replaces
/// other transforms. A rotation is not 0. A node with two parents causes a warning and is shown below both.
void check_gltf_nodes(nlohmann::json& document, bool is_strict, LoadReport& report);

/// Checks that buffer views lie within their buffers' byteLength and accessors within their views, and that attributes
/// have the formats and counts that the specification (section 3.7.2.1) and KHR_mesh_quantization allow. Invalid
/// attributes that only affect shading are removed from their primitives, and invalid views from their images.
void check_gltf_accessors(nlohmann::json& document, bool is_strict, LoadReport& report);

/// Returns whether meshes use this attribute. Other attributes are ignored, and the bytes of their buffers may be
/// missing.
bool is_read_attribute(std::string_view name);

/// Types of components, with their numbers in the file.
inline constexpr int kGltfByte = 5120;
inline constexpr int kGltfUnsignedByte = 5121;
inline constexpr int kGltfShort = 5122;
inline constexpr int kGltfUnsignedShort = 5123;
inline constexpr int kGltfUnsignedInt = 5125;
inline constexpr int kGltfFloat = 5126;

/// Returns the number of bytes of a component with a type such as kGltfFloat; component_count() returns the number of
/// components of a type such as "VEC3".
uint64_t component_bytes(int component_type);
uint64_t component_count(const std::string& type);

}  // namespace promin
