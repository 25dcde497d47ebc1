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

/// Modes of a mesh primitive. Modes 0...3 are points and lines; 6 is a fan.
inline constexpr int kGltfTriangles = 4;
inline constexpr int kGltfTriangleStrip = 5;

struct GltfBufferView {
  int buffer = -1;
  size_t byte_offset = 0;
  size_t byte_length = 0;
  /// Distance between elements in bytes; 0 if the elements are tightly packed.
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
  /// Number of components of an element.
  size_t component_count = 0;
  size_t count = 0;
  bool is_normalized = false;
  std::optional<GltfSparse> sparse;
};

struct GltfPrimitive {
  /// The index of the accessor of each attribute.
  std::map<std::string, int> attributes;
  int indices = -1;
  int material = -1;
  int mode = kGltfTriangles;
  /// For each morph target, the indices of its accessors by attribute.
  std::vector<std::map<std::string, int>> targets;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  /// Weights of the morph targets, for nodes that have no weights.
  std::vector<double> weights;
};

struct GltfNode {
  std::string name;
  int mesh = -1;
  int camera = -1;
  int skin = -1;
  std::vector<int> children;
  /// Weights of the morph targets of the node's mesh.
  std::optional<std::vector<double>> weights;
};

/// Returns whether at least one weight of a morph target is not 0.
bool has_morph(const std::vector<double>& weights);

/// The bytes of a document's buffers. It must not be copied, because one part points into another.
struct GltfBuffers {
  GltfBuffers() = default;
  GltfBuffers(GltfBuffers&&) = default;
  GltfBuffers& operator=(GltfBuffers&&) = default;

  /// The bytes of each buffer; empty if nothing reads the buffer. The spans point into `own` and GltfDocument::glb.
  std::vector<std::span<const std::byte>> bytes;
  std::vector<std::vector<std::byte>> own;
};

/// A glTF file after reading, checking and decompressing. Every index, type, range and length in it is valid. Data that
/// only one reader needs (materials, cameras, extensions) is in `json`.
struct GltfDocument {
  nlohmann::json json;
  std::vector<GltfBufferView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  /// The extensions of the file; see check_gltf_extensions().
  std::vector<FileExtension> extensions;
  /// Index of the scene to show, if the file has one.
  size_t scene = 0;
  GltfBuffers buffers;
  /// The bytes of a GLB file, whose binary chunk is one of the buffers; empty for a text file.
  std::vector<std::byte> glb;
};

/// Returns the bytes of a needed buffer view (find_needed_views). After the document is decompressed, they are the
/// decompressed bytes.
std::span<const std::byte> bytes_of_view(const GltfDocument& document, int view);

/// Reads and checks the file of the report. There are three rounds of checks: of the container, of the schema, and of
/// rules that the schema cannot express. Each round throws InputError with all of its problems.
GltfDocument read_gltf_document(const LoadOptions& options, LoadReport& report);

}  // namespace promin
