// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <tiny_gltf.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "formats/load_report.h"

namespace promin {

/// A glTF file, read and checked: every index, type, range and length in it can be relied on. What the core
/// specification defines lies in `model`; extensions are read from `json`.
struct GltfDocument {
  nlohmann::json json;
  tinygltf::Model model;
  /// The bytes of model.bufferViews[].buffer (model.buffers stays empty).
  std::vector<std::vector<std::byte>> buffers;
};

/// Reads the file that the report is about. Checks come in three rounds (the file's frame, the schema, what the
/// schema cannot say); each throws InputError with all of its problems.
GltfDocument read_gltf_document(LoadReport& report);

}  // namespace promin
