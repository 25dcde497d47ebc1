// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/load_report.h"
#include "promin/load_scene.h"

namespace promin {

// Typed views of the parts of a document that several readers share, with the specification's defaults. An index that
// the file leaves out is -1.

/// Modes of a mesh primitive; lower ones are points and lines, 6 is a fan.
inline constexpr int kGltfTriangles = 4;
inline constexpr int kGltfTriangleStrip = 5;

struct GltfBufferView {
  int buffer = -1;
  size_t byte_offset = 0;
  size_t byte_length = 0;
  /// 0: the elements are tightly packed.
  size_t byte_stride = 0;
};

struct GltfSparse {
  size_t count = 0;
  int index_view = -1;
  size_t index_offset = 0;
  int index_type = 0;
  int value_view = -1;
  size_t value_offset = 0;
};

struct GltfAccessor {
  int view = -1;
  size_t byte_offset = 0;
  int component_type = 0;
  /// Components of an element.
  size_t component_count = 0;
  size_t count = 0;
  bool is_normalized = false;
  std::optional<GltfSparse> sparse;
};

struct GltfPrimitive {
  /// The accessor of each attribute.
  std::map<std::string, int> attributes;
  int indices = -1;
  int material = -1;
  int mode = kGltfTriangles;
  /// The accessors of each morph target.
  std::vector<std::map<std::string, int>> targets;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  /// Of morph targets, where a node has none of its own.
  std::vector<double> weights;
};

struct GltfNode {
  std::string name;
  int mesh = -1;
  int camera = -1;
  int skin = -1;
  std::vector<int> children;
  /// Of its mesh's morph targets.
  std::optional<std::vector<double>> weights;
};

/// Whether some weight of a morph target is another than 0.
bool has_morph(const std::vector<double>& weights);

/// The bytes of a document's buffers. Not to be copied: one part points into another.
struct GltfBuffers {
  GltfBuffers() = default;
  GltfBuffers(GltfBuffers&&) = default;
  GltfBuffers& operator=(GltfBuffers&&) = default;

  /// The bytes of each buffer; empty where nothing reads it. They are views into `own` and into GltfDocument::glb.
  std::vector<std::span<const std::byte>> bytes;
  std::vector<std::vector<std::byte>> own;
};

/// A glTF file, read, checked and decompressed: every index, type, range and length in it can be relied on. What only
/// one reader needs (materials, cameras, extensions) it takes from `json`.
struct GltfDocument {
  nlohmann::json json;
  std::vector<GltfBufferView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  /// See check_gltf_extensions.
  std::vector<FileExtension> extensions;
  /// The scene that is shown, if there are any.
  size_t scene = 0;
  GltfBuffers buffers;
  /// The bytes of a GLB file, whose binary chunk is a buffer; empty for a text file.
  std::vector<std::byte> glb;
};

/// The bytes of a buffer view that is needed (find_needed_views), decompressed once the document is.
std::span<const std::byte> bytes_of_view(const GltfDocument& document, int view);

/// Reads the file that the report is about. Checks come in three rounds (the file's frame, the schema, what the
/// schema cannot say); each throws InputError with all of its problems.
GltfDocument read_gltf_document(const LoadOptions& options, LoadReport& report);

}  // namespace promin
