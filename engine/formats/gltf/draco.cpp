// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/gltf/draco.h"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

#include <limits>
#include <memory>
#include <string>

#include "core/parallel.h"
#include "formats/gltf/checks.h"
#include "formats/gltf/json_lookup.h"

namespace promin {
namespace {

using nlohmann::json;
using Bytes = std::vector<std::byte>;

// The bitstream, version 2.2: https://google.github.io/draco/spec
constexpr uint8_t kMeshType = 1;
constexpr uint8_t kSequential = 0;
constexpr uint8_t kEdgebreaker = 1;
constexpr uint16_t kHasMetadata = 0x8000;

/// The largest plausible number of triangles or vertices per byte: a regular grid with 14 bits in the tightest coding
/// has 8 triangles per byte. The decoder allocates about 24 bytes per triangle in advance.
constexpr uint64_t kSmallMesh = uint64_t{1} << 19;
constexpr uint64_t kMostPerByte = 16;

/// Thrown if a stream cannot be used; the message is the reason.
struct DracoError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The numbers that a stream's header declares.
struct Promise {
  uint64_t faces = 0;
  /// The smallest number of vertices.
  uint64_t vertices = 0;
};

draco::DecoderBuffer buffer_of(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  return buffer;
}

template <typename Number>
Number read(draco::DecoderBuffer& buffer) {
  Number number{};
  if (!buffer.Decode(&number)) throw DracoError("it ends within its header");
  return number;
}

uint64_t read_count(draco::DecoderBuffer& buffer) {
  uint32_t count = 0;
  if (!draco::DecodeVarint(&count, &buffer)) throw DracoError("it ends within its header");
  return count;
}

Promise read_promise(std::span<const std::byte> stream) {
  draco::DecoderBuffer buffer = buffer_of(stream);
  for (const char letter : std::string_view("DRACO")) {
    if (read<char>(buffer) != letter) throw DracoError("it does not begin as Draco data does");
  }
  const auto major = read<uint8_t>(buffer);
  const auto minor = read<uint8_t>(buffer);
  if (major != 2 || minor != 2) {
    throw DracoError("its version is " + std::to_string(major) + "." + std::to_string(minor) + " and not 2.2");
  }
  buffer.set_bitstream_version(static_cast<uint16_t>(major << 8 | minor));
  if (read<uint8_t>(buffer) != kMeshType) throw DracoError("it holds no mesh");
  const auto method = read<uint8_t>(buffer);
  if ((read<uint16_t>(buffer) & kHasMetadata) != 0) {
    draco::GeometryMetadata skipped;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &skipped))
      throw DracoError("its metadata is damaged");
  }
  Promise promise;
  if (method == kSequential) {
    promise.faces = read_count(buffer);
    promise.vertices = read_count(buffer);
  } else if (method == kEdgebreaker) {
    read<uint8_t>(buffer);  // The method of traversing triangles; not needed here.
    promise.vertices = read_count(buffer);
    promise.faces = read_count(buffer);
  } else {
    throw DracoError("its encoding method is unknown");
  }
  return promise;
}

/// One compressed mesh primitive of a document.
struct Task {
  size_t mesh = 0;
  size_t primitive = 0;
  const json* extension = nullptr;
  std::string problem;
  /// The indices of the triangles, and the attributes by name, each in the format of its accessor.
  Bytes indices;
  std::vector<std::pair<std::string, Bytes>> attributes;
};

std::string say(uint64_t count, const char* noun) {
  return std::to_string(count) + " " + noun;
}

/// Decodes one stream to the formats of the primitive's accessors.
class PrimitiveDecoder {
 public:
  PrimitiveDecoder(const GltfDocument& document, Task& task)
      : document_(document), task_(task), primitive_(document.meshes[task.mesh].primitives[task.primitive]) {}

  void decode() {
    const std::span<const std::byte> stream = bytes_of_view(document_, (*task_.extension)["bufferView"]);
    check_promise(read_promise(stream), stream.size());
    draco::DecoderBuffer buffer = buffer_of(stream);
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) throw DracoError("it is damaged");
    mesh_ = std::move(decoded).value();
    check_counts();
    take_indices();
    for (const auto& [name, id] : (*task_.extension)["attributes"].items()) {
      if (is_read_attribute(name)) take_attribute(name, id.get<uint32_t>());
    }
  }

 private:
  const GltfAccessor& accessor(int index) const { return document_.accessors[static_cast<size_t>(index)]; }
  uint64_t vertex_count() const { return accessor(primitive_.attributes.begin()->second).count; }
  uint64_t face_count() const {
    return primitive_.indices < 0 ? std::numeric_limits<uint64_t>::max() : accessor(primitive_.indices).count / 3;
  }

  void check_promise(const Promise& promise, uint64_t bytes) const {
    if (promise.faces > face_count()) {
      throw DracoError("it has " + say(promise.faces, "triangles") + ", the accessor of indices " +
                       std::to_string(face_count()));
    }
    if (promise.vertices > vertex_count()) {
      throw DracoError("it has " + say(promise.vertices, "vertices") + ", the accessors " +
                       std::to_string(vertex_count()));
    }
    const uint64_t most = kSmallMesh + kMostPerByte * bytes;
    if (promise.faces > most || promise.vertices > most) {
      throw DracoError("its " + say(bytes, "bytes") + " are too few for " + say(promise.faces, "triangles"));
    }
  }

  void check_counts() const {
    if (mesh_->num_points() != vertex_count()) {
      throw DracoError("it has " + say(mesh_->num_points(), "vertices") + ", the accessors " +
                       std::to_string(vertex_count()));
    }
    if (mesh_->num_faces() > face_count()) throw DracoError("it has more triangles than the accessor of indices");
  }

  void take_indices() {
    std::vector<uint32_t> corners;
    corners.reserve(3 * size_t{mesh_->num_faces()});
    for (uint32_t i = 0; i < mesh_->num_faces(); ++i) {
      for (const draco::PointIndex& corner : mesh_->face(draco::FaceIndex(i))) corners.push_back(corner.value());
    }
    const auto bytes = std::as_bytes(std::span(corners));
    task_.indices.assign(bytes.begin(), bytes.end());
  }

  void take_attribute(const std::string& name, uint32_t id) {
    const auto used = primitive_.attributes.find(name);
    if (used == primitive_.attributes.end()) return;
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
    if (attribute == nullptr) throw DracoError("it has no attribute " + std::to_string(id) + " for " + name);
    const GltfAccessor& to = accessor(used->second);
    if (attribute->num_components() != static_cast<int>(to.component_count)) {
      throw DracoError("its " + name + " has " + say(static_cast<uint64_t>(attribute->num_components()), "components"));
    }
    switch (to.component_type) {
      case kGltfByte:
        return take_numbers<int8_t>(name, *attribute);
      case kGltfUnsignedByte:
        return take_numbers<uint8_t>(name, *attribute);
      case kGltfShort:
        return take_numbers<int16_t>(name, *attribute);
      case kGltfUnsignedShort:
        return take_numbers<uint16_t>(name, *attribute);
      case kGltfUnsignedInt:
        return take_numbers<uint32_t>(name, *attribute);
      default:
        return take_numbers<float>(name, *attribute);
    }
  }

  template <typename Number>
  void take_numbers(const std::string& name, const draco::PointAttribute& attribute) {
    const auto components = static_cast<int8_t>(attribute.num_components());
    std::vector<Number> numbers(size_t{mesh_->num_points()} * static_cast<size_t>(components));
    for (uint32_t i = 0; i < mesh_->num_points(); ++i) {
      const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
      Number* to = &numbers[size_t{i} * static_cast<size_t>(components)];
      if (value.value() >= attribute.size() || !attribute.ConvertValue(value, components, to)) {
        throw DracoError("its " + name + " cannot be read");
      }
    }
    const auto bytes = std::as_bytes(std::span(numbers));
    task_.attributes.emplace_back(name, Bytes(bytes.begin(), bytes.end()));
  }

  const GltfDocument& document_;
  Task& task_;
  const GltfPrimitive& primitive_;
  std::unique_ptr<draco::Mesh> mesh_;
};

/// Adds an accessor with the format of `like` and its own bytes. Returns its index.
int add_accessor(GltfDocument& document, const GltfAccessor& like, Bytes bytes) {
  GltfBufferView view;
  view.buffer = static_cast<int>(document.buffers.bytes.size());
  view.byte_length = bytes.size();
  document.buffers.bytes.emplace_back(document.buffers.own.emplace_back(std::move(bytes)));
  GltfAccessor accessor = like;
  accessor.view = static_cast<int>(document.views.size());
  accessor.byte_offset = 0;
  accessor.sparse.reset();
  document.views.push_back(view);
  document.accessors.push_back(accessor);
  return static_cast<int>(document.accessors.size() - 1);
}

void take_result(GltfDocument& document, Task& task) {
  GltfPrimitive& primitive = document.meshes[task.mesh].primitives[task.primitive];
  GltfAccessor indices;
  indices.component_type = kGltfUnsignedInt;
  indices.component_count = 1;
  indices.count = task.indices.size() / sizeof(uint32_t);
  primitive.indices = add_accessor(document, indices, std::move(task.indices));
  primitive.mode = kGltfTriangles;
  for (auto& [name, bytes] : task.attributes) {
    int& index = primitive.attributes[name];
    const GltfAccessor like = document.accessors[static_cast<size_t>(index)];
    index = add_accessor(document, like, std::move(bytes));
  }
}

std::vector<Task> find_tasks(const GltfDocument& document) {
  std::vector<Task> tasks;
  for (size_t m = 0; m < document.meshes.size(); ++m) {
    const json& primitives = document.json["meshes"][m]["primitives"];
    for (size_t p = 0; p < primitives.size(); ++p) {
      const json* extension = find_draco(primitives[p]);
      if (extension != nullptr && !document.meshes[m].primitives[p].attributes.empty()) {
        tasks.push_back({m, p, extension, {}, {}, {}});
      }
    }
  }
  return tasks;
}

}  // namespace

const json* find_draco(const json& primitive) {
  return find_extension(primitive, "KHR_draco_mesh_compression");
}

void decode_gltf_draco(GltfDocument& document, LoadReport& report) {
  std::vector<Task> tasks = find_tasks(document);
  for_each_index(tasks.size(), 0, [&](size_t i) {
    try {
      PrimitiveDecoder(document, tasks[i]).decode();
    } catch (const DracoError& error) {
      tasks[i].problem = error.what();
    }
  });
  for (Task& task : tasks) {
    if (task.problem.empty()) {
      take_result(document, task);
      continue;
    }
    report.refuse("gltf.draco.damaged", "the Draco stream cannot be used: " + task.problem,
                  "meshes[" + std::to_string(task.mesh) + "].primitives[" + std::to_string(task.primitive) +
                      "].extensions.KHR_draco_mesh_compression",
                  "compress the file again");
  }
}

}  // namespace promin
