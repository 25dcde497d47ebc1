// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
// These tests load compressed meshes of glTF: EXT_meshopt_compression and KHR_draco_mesh_compression.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <gmock/gmock.h>
#include <meshoptimizer.h>

#include <random>

#include "promin/validate.h"
#include "support/gltf_builder.h"
#include "support/other_values.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

using Stream = std::vector<unsigned char>;

/// Returns the corners of a square of `side` x `side` cells in the plane z = 0.
std::vector<float> grid_positions(uint32_t side) {
  std::vector<float> positions;
  for (uint32_t y = 0; y <= side; ++y) {
    for (uint32_t x = 0; x <= side; ++x) {
      positions.insert(positions.end(), {static_cast<float>(x), static_cast<float>(y), 0.0F});
    }
  }
  return positions;
}

std::vector<uint32_t> grid_indices(uint32_t side) {
  std::vector<uint32_t> indices;
  for (uint32_t y = 0; y < side; ++y) {
    for (uint32_t x = 0; x < side; ++x) {
      const uint32_t i = y * (side + 1) + x;
      indices.insert(indices.end(), {i, i + 1, i + side + 2, i, i + side + 2, i + side + 1});
    }
  }
  return indices;
}

/// Returns the triangles in an order that depends neither on their order in the mesh nor on that of their corners.
std::vector<std::vector<float>> sorted_triangles(const Mesh& mesh) {
  std::vector<std::vector<float>> triangles;
  for (const uvec3& triangle : mesh.triangles) {
    std::vector<std::vector<float>> corners;
    for (int i = 0; i < 3; ++i) {
      const vec3& p = mesh.positions.at(triangle[i]);
      corners.push_back({p.x, p.y, p.z});
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    triangles.emplace_back();
    for (const std::vector<float>& corner : corners) {
      triangles.back().insert(triangles.back().end(), corner.begin(), corner.end());
    }
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

Mesh grid_mesh(uint32_t side) {
  Mesh mesh;
  const std::vector<float> positions = grid_positions(side);
  for (size_t i = 0; i < positions.size(); i += 3) {
    mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
  }
  const std::vector<uint32_t> indices = grid_indices(side);
  for (size_t i = 0; i < indices.size(); i += 3) {
    mesh.triangles.emplace_back(indices[i], indices[i + 1], indices[i + 2]);
  }
  return mesh;
}

class GltfCompressionTest : public SceneFolder {
 protected:
  std::string refusal_of(GltfBuilder& gltf) const { return refusal("scene.gltf", gltf.text()); }

  /// Changes bytes from `first` to `last` of the scene's buffer in `count` ways. Each changed file must load or be
  /// refused.
  void expect_mutants_to_load_or_be_refused(const GltfBuilder& good, size_t first, size_t last, int count) const {
    std::mt19937 random(20240607);
    int refused = 0;
    for (int i = 0; i < count; ++i) {
      GltfBuilder gltf = good;
      for (size_t change = 0; change < 1 + random() % 3; ++change) {
        gltf.bytes[first + random() % (last - first)] = static_cast<char>(random());
      }
      try {
        ASSERT_EQ(validate(load_scene(write("mutant.gltf", gltf.text()))).size(), 0U) << "mutant " << i;
      } catch (const InputError& error) {
        ++refused;
        ASSERT_NE(std::string(error.what()), "");
      }
    }
    EXPECT_GT(refused, count / 10) << "the mutations do nothing";
  }
};

// The next tests check streams of meshoptimizer.

Stream compress_attributes(const void* elements, size_t count, size_t stride) {
  Stream stream(meshopt_encodeVertexBufferBound(count, stride));
  stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), elements, count, stride));
  return stream;
}

Stream compress_triangles(const std::vector<uint32_t>& indices, size_t vertex_count) {
  Stream stream(meshopt_encodeIndexBufferBound(indices.size(), vertex_count));
  stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
  return stream;
}

Stream compress_indices(const std::vector<uint32_t>& indices, size_t vertex_count) {
  Stream stream(meshopt_encodeIndexSequenceBound(indices.size(), vertex_count));
  stream.resize(meshopt_encodeIndexSequence(stream.data(), stream.size(), indices.data(), indices.size()));
  return stream;
}

/// Appends an accessor over a compressed view, whose decoded bytes would lie in buffer 1. Returns its index.
size_t add_compressed(GltfBuilder& gltf, const Stream& stream, size_t count, size_t stride, const std::string& mode,
                      const json& accessor, const std::string& filter = "NONE") {
  const size_t view = gltf.add_view(stream);
  json extension = gltf.json["bufferViews"][view];
  extension.update({{"count", count}, {"byteStride", stride}, {"mode", mode}, {"filter", filter}});
  gltf.json["bufferViews"][view] = {
      {"buffer", 1}, {"byteLength", count * stride}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
  if (mode == "ATTRIBUTES") gltf.json["bufferViews"][view]["byteStride"] = stride;
  json& added = gltf.json["accessors"].emplace_back(accessor);
  added["bufferView"] = view;
  added["count"] = count;
  return gltf.json["accessors"].size() - 1;
}

const json kPositions = {{"componentType", 5126}, {"type", "VEC3"}};
const json kIndices = {{"componentType", 5125}, {"type", "SCALAR"}};

/// Returns the text of a document whose buffer 1 has no bytes.
std::string packed_text(GltfBuilder& gltf) {
  gltf.text();
  gltf.json["buffers"].push_back(
      {{"byteLength", 1 << 30}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  return gltf.json.dump();
}

GltfBuilder packed_grid(uint32_t side, const std::string& mode) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"EXT_meshopt_compression"};
  gltf.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const std::vector<float> positions = grid_positions(side);
  const std::vector<uint32_t> indices = grid_indices(side);
  const size_t vertex_count = positions.size() / 3;
  const size_t position = add_compressed(gltf, compress_attributes(positions.data(), vertex_count, 12), vertex_count,
                                         12, "ATTRIBUTES", kPositions);
  const Stream stream =
      mode == "TRIANGLES" ? compress_triangles(indices, vertex_count) : compress_indices(indices, vertex_count);
  const size_t index = add_compressed(gltf, stream, indices.size(), 4, mode, kIndices);
  gltf.show({{"attributes", {{"POSITION", position}}}, {"indices", index}});
  return gltf;
}

TEST_F(GltfCompressionTest, MeshoptGivesWhatWasCompressed) {
  for (const char* mode : {"TRIANGLES", "INDICES"}) {
    GltfBuilder gltf = packed_grid(40, mode);
    const LoadedScene scene = load("scene.gltf", packed_text(gltf));
    EXPECT_THAT(scene.warnings, IsEmpty()) << "buffer 1 needs no bytes";
    EXPECT_EQ(sorted_triangles(mesh_of(scene)), sorted_triangles(grid_mesh(40))) << mode;
  }
}

TEST_F(GltfCompressionTest, MeshoptIndicesMayHaveTwoBytes) {
  GltfBuilder gltf = packed_grid(4, "TRIANGLES");
  json& view = gltf.json["bufferViews"][1];
  const size_t count = view["extensions"]["EXT_meshopt_compression"]["count"];
  view["extensions"]["EXT_meshopt_compression"]["byteStride"] = 2;
  view["byteLength"] = 2 * count;
  gltf.json["accessors"][1]["componentType"] = 5123;
  EXPECT_EQ(sorted_triangles(mesh_of(load("scene.gltf", packed_text(gltf)))), sorted_triangles(grid_mesh(4)));
}

TEST_F(GltfCompressionTest, MeshoptFiltersGiveUnitVectorsAndFloats) {
  const std::vector<float> normals = {0, 0, 1, 0, 0.6F, 0, 0.8F, 0, 0, 1, 0, 0};
  const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1.5F, -0.25F};
  GltfBuilder gltf;
  std::vector<int8_t> packed_normals(12);
  meshopt_encodeFilterOct(packed_normals.data(), 3, 4, 8, normals.data());
  const size_t normal = add_compressed(gltf, compress_attributes(packed_normals.data(), 3, 4), 3, 4, "ATTRIBUTES",
                                       {{"componentType", 5120}, {"type", "VEC3"}, {"normalized", true}}, "OCTAHEDRAL");
  std::vector<uint32_t> packed_positions(9);
#if MESHOPTIMIZER_VERSION >= 200
  meshopt_encodeFilterExp(packed_positions.data(), 3, 12, 15, positions.data(), meshopt_EncodeExpSharedVector);
#else
  meshopt_encodeFilterExp(packed_positions.data(), 3, 12, 15, positions.data());
#endif
  const size_t position = add_compressed(gltf, compress_attributes(packed_positions.data(), 3, 12), 3, 12, "ATTRIBUTES",
                                         kPositions, "EXPONENTIAL");
  gltf.show({{"attributes", {{"POSITION", position}, {"NORMAL", normal}}}});
  const LoadedScene scene = load("scene.gltf", packed_text(gltf));
  const Mesh& mesh = mesh_of(scene);
  ASSERT_EQ(mesh.positions.size(), 3U);
  ASSERT_EQ(mesh.normals.size(), 3U);
  for (size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(mesh.positions[i], vec3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]));
    EXPECT_LT(
        glm::distance(glm::normalize(mesh.normals[i]), vec3(normals[4 * i], normals[4 * i + 1], normals[4 * i + 2])),
        0.02F);
  }
}

TEST_F(GltfCompressionTest, MeshoptFilterOfQuaternionsTurnsInstances) {
  const auto half = static_cast<float>(std::sqrt(0.5));
  const std::vector<float> rotations = {0, 0, half, half};
  std::vector<int16_t> packed(4);
  meshopt_encodeFilterQuat(packed.data(), 1, 8, 16, rotations.data());
  GltfBuilder gltf = triangle_gltf();
  const size_t rotation =
      add_compressed(gltf, compress_attributes(packed.data(), 1, 8), 1, 8, "ATTRIBUTES",
                     {{"componentType", 5122}, {"type", "VEC4"}, {"normalized", true}}, "QUATERNION");
  gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["ROTATION"] = rotation;
  const Scene scene = load_scene(write("scene.gltf", packed_text(gltf)));
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_LT(glm::distance(dvec3(scene.objects[0].world_from_object * dvec4(1, 0, 0, 1)), dvec3(0, 1, 0)), 1e-3);
}

TEST_F(GltfCompressionTest, MeshoptThatLiesIsRefused) {
  struct Lie {
    const char* pointer;
    json value;
    const char* what;
  };
  const std::string extension = "/bufferViews/0/extensions/EXT_meshopt_compression";
  const Lie lies[] = {
      {"/byteLength", 1 << 30, "gltf.meshopt.short"},
      {"/byteOffset", 1 << 30, "gltf.meshopt.short"},
      {"/count", 26, "gltf.meshopt.count 300 26 12"},
      {"/byteStride", 16, "gltf.meshopt.count 25 16"},
      {"/byteStride", 13, "gltf.meshopt.stride 4"},
      {"/byteStride", 1000, "json.range"},
      {"/mode", "TRIANGLES", "gltf.meshopt.stride 2"},
      {"/mode", "POINTS", "json.choice"},
      {"/filter", "COLOR", "json.choice"},
      {"/filter", "OCTAHEDRAL", "gltf.meshopt.stride octahedral"},
      {"/filter", "QUATERNION", "gltf.meshopt.stride quaternions"},
      {"/buffer", 7, "json.index"},
  };
  for (const Lie& lie : lies) {
    GltfBuilder gltf = packed_grid(4, "INDICES");
    packed_text(gltf);
    gltf.json[json::json_pointer(extension + lie.pointer)] = lie.value;
    EXPECT_THAT(refusal("scene.gltf", gltf.json.dump()), HasProblem(lie.what)) << lie.pointer << lie.value;
  }
}

TEST_F(GltfCompressionTest, MeshoptThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  GltfBuilder gltf = packed_grid(4, "INDICES");
  packed_text(gltf);
  // A few hundred compressed bytes declare 24 GB of data.
  const uint64_t count = uint64_t{2'000'000'000};
  json& view = gltf.json["bufferViews"][0];
  view["extensions"]["EXT_meshopt_compression"]["count"] = count;
  view["byteLength"] = 12 * count;
  gltf.json["buffers"][1]["byteLength"] = 12 * count;
  EXPECT_THAT(refusal("scene.gltf", gltf.json.dump()), HasProblem("gltf.meshopt.ratio 24000000000"));
}

TEST_F(GltfCompressionTest, MeshoptStreamsNamedManyTimesAreRefused) {
  GltfBuilder gltf;
  const std::vector<float> zeros(3 * 65536, 0.0F);
  const Stream stream = compress_attributes(zeros.data(), 65536, 12);
  const size_t first = add_compressed(gltf, stream, 65536, 12, "ATTRIBUTES", kPositions);
  for (int i = 0; i < 8; ++i) {
    gltf.json["bufferViews"].push_back(gltf.json["bufferViews"][0]);
    json accessor = gltf.json["accessors"][first];
    accessor["bufferView"] = gltf.json["bufferViews"].size() - 1;
    gltf.json["accessors"].push_back(accessor);
    gltf.show({{"attributes", {{"POSITION", gltf.json["accessors"].size() - 1}}}});
  }
  EXPECT_THAT(refusal("scene.gltf", packed_text(gltf)), HasProblem("gltf.meshopt.ratio"));
}

TEST_F(GltfCompressionTest, MeshoptOfALaterVersionIsSaidToBe) {
  GltfBuilder gltf = packed_grid(4, "INDICES");
  const size_t offset = gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteOffset"];
  gltf.bytes[offset] = static_cast<char>(0xAF);
  EXPECT_THAT(refusal("scene.gltf", packed_text(gltf)), HasProblem("gltf.meshopt.damaged"));
}

TEST_F(GltfCompressionTest, BrokenMeshoptLoadsOrIsRefused) {
  GltfBuilder gltf = packed_grid(4, "TRIANGLES");
  // Buffer 1 must be removed before text() is called again.
  for (json& view : gltf.json["bufferViews"]) view["buffer"] = 0;
  gltf.json["bufferViews"][0]["byteLength"] = 300;
  const size_t first = gltf.bytes.size();
  gltf.bytes.resize(first + 1000);
  expect_mutants_to_load_or_be_refused(gltf, 0, first, 1000);
}

// The next tests check streams of Draco.

struct Compressed {
  std::string bytes;
  uint32_t vertex_count = 0;
  uint32_t triangle_count = 0;
  uint32_t position_id = 0;
};

/// Compresses the triangles of a grid, without loss.
Compressed compress_grid(uint32_t side, int method) {
  const Mesh grid = grid_mesh(side);
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(grid.triangles.size()));
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  for (size_t i = 0; i < grid.triangles.size(); ++i) {
    const uvec3& t = grid.triangles[i];
    builder.SetAttributeValuesForFace(id, draco::FaceIndex(static_cast<uint32_t>(i)), &grid.positions[t.x],
                                      &grid.positions[t.y], &grid.positions[t.z]);
  }
  const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());
  return {{buffer.data(), buffer.size()}, mesh->num_points(), mesh->num_faces(), mesh->attribute(id)->unique_id()};
}

GltfBuilder draco_grid(const Compressed& grid) {
  GltfBuilder gltf;
  gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  gltf.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  const size_t view = gltf.add_view(std::vector<char>(grid.bytes.begin(), grid.bytes.end()));
  gltf.json["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", grid.vertex_count}},
                            {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 3 * grid.triangle_count}}};
  gltf.show(
      {{"attributes", {{"POSITION", 0}}},
       {"indices", 1},
       {"extensions",
        {{"KHR_draco_mesh_compression", {{"bufferView", view}, {"attributes", {{"POSITION", grid.position_id}}}}}}}});
  return gltf;
}

constexpr int kMethods[] = {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING};

TEST_F(GltfCompressionTest, DracoGivesWhatWasCompressed) {
  for (const int method : kMethods) {
    GltfBuilder gltf = draco_grid(compress_grid(20, method));
    const LoadedScene scene = load("scene.gltf", gltf.text());
    EXPECT_THAT(scene.warnings, IsEmpty());
    EXPECT_EQ(sorted_triangles(mesh_of(scene)), sorted_triangles(grid_mesh(20))) << method;
  }
}

TEST_F(GltfCompressionTest, DracoThatLiesIsRefused) {
  struct Lie {
    const char* pointer;
    json value;
    const char* what;
  };
  const std::string extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
  const Lie lies[] = {
      {"/accessors/0/count", 10, "gltf.draco.damaged 10"},
      {"/accessors/0/count", 26, "gltf.draco.damaged 25 26"},
      {"/accessors/1/count", 9, "gltf.draco.damaged indices 3"},
      {"/accessors/0/type", "VEC2", "gltf.accessor.format"},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView", 7, "json.index"},
      {"/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION", 7,
       "gltf.draco.damaged attribute 7"},
      {"/bufferViews/0/byteLength", 20, "gltf.draco.damaged"},
  };
  for (const int method : kMethods) {
    for (const Lie& lie : lies) {
      GltfBuilder gltf = draco_grid(compress_grid(4, method));
      gltf.json[json::json_pointer(lie.pointer)] = lie.value;
      EXPECT_THAT(refusal_of(gltf), HasProblem(lie.what)) << lie.pointer << lie.value;
    }
  }
}

/// Returns a header of version 2.2 that declares 2^31 triangles.
std::string absurd_header(int method) {
  std::string bytes = "DRACO\x02\x02\x01";
  bytes += static_cast<char>(method);
  bytes += std::string(2, '\0');
  const std::string many = "\xFF\xFF\xFF\xFF\x07";
  if (method == draco::MESH_EDGEBREAKER_ENCODING) bytes += std::string(1, '\0') + many;
  return bytes + many + many + std::string(100, '\x01');
}

TEST_F(GltfCompressionTest, DracoThatPromisesTooMuchIsRefusedBeforeMemoryIsTaken) {
  for (const int method : kMethods) {
    Compressed grid{absurd_header(method), 25, 32, 0};
    GltfBuilder small = draco_grid(grid);
    EXPECT_THAT(refusal_of(small), HasProblem("gltf.draco.damaged 32"));
    // The accessors may be wrong as well.
    GltfBuilder large = draco_grid(grid);
    large.json["accessors"][0]["count"] = 2147483647;
    large.json["accessors"][1]["count"] = 2147483647;
    EXPECT_NE(refusal_of(large), "");
    std::string bytes = absurd_header(method);
    // The stream declares 2^29 triangles and vertices, which is within the counts of both accessors.
    for (size_t at = bytes.find("\xFF\xFF\xFF\xFF\x07"); at != std::string::npos;
         at = bytes.find("\xFF\xFF\xFF\xFF\x07")) {
      bytes.replace(at, 5, "\x80\x80\x80\x80\x02");
    }
    GltfBuilder fitting = draco_grid({bytes, 25, 32, 0});
    fitting.json["accessors"][0]["count"] = 2147483647;
    fitting.json["accessors"][1]["count"] = 2147483647;
    EXPECT_THAT(refusal_of(fitting), HasProblem("gltf.draco.damaged bytes few"));
  }
}

TEST_F(GltfCompressionTest, OtherVersionsOfDracoAreRefused) {
  Compressed grid = compress_grid(4, draco::MESH_EDGEBREAKER_ENCODING);
  grid.bytes[6] = 1;
  GltfBuilder gltf = draco_grid(grid);
  EXPECT_THAT(refusal_of(gltf), HasProblem("gltf.draco.damaged 2.1 2.2"));
}

/// The test replaces each value of the documents by values of all other kinds.
TEST_F(GltfCompressionTest, DocumentsWithOtherValuesLoadOrAreRefused) {
  GltfBuilder packed = packed_grid(2, "TRIANGLES");
  packed_text(packed);
  GltfBuilder draco = draco_grid(compress_grid(2, draco::MESH_EDGEBREAKER_ENCODING));
  draco.text();
  for (const json& good : {packed.json.flatten(), draco.json.flatten()}) {
    int refused = 0;
    int total = 0;
    for (const auto& [pointer, old] : good.items()) {
      for (const json& value : kOtherValues) {
        json document = good.unflatten();
        document[json::json_pointer(pointer)] = value;
        ++total;
        try {
          const Scene loaded = load_scene(write("a.gltf", document.dump()));
          ASSERT_EQ(validate(loaded).size(), 0U) << pointer << " = " << value;
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
    EXPECT_GT(refused, total / 3);
    EXPECT_LT(refused, total);
  }
}

TEST_F(GltfCompressionTest, BrokenDracoLoadsOrIsRefused) {
  for (const int method : kMethods) {
    const GltfBuilder gltf = draco_grid(compress_grid(4, method));
    expect_mutants_to_load_or_be_refused(gltf, 0, gltf.bytes.size(), 1000);
  }
}

}  // namespace
}  // namespace promin
