// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <functional>

#include "support/rich_gltf.h"
#include "support/scene_folder.h"

namespace promin {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

const float kNan = std::numeric_limits<float>::quiet_NaN();

/// A change that breaks a valid document, and the words that the refusal must contain.
struct BadGltf {
  const char* name;
  std::function<void(GltfBuilder&)> spoil;
  const char* what;
  const char* where;
};

std::ostream& operator<<(std::ostream& stream, const BadGltf& bad) {
  return stream << bad.name;
}

/// Replaces the positions of the triangle.
void set_positions(GltfBuilder& gltf, const std::vector<float>& positions) {
  primitive(gltf)["attributes"]["POSITION"] = gltf.add<float>(positions, "VEC3");
}

class BadGltfTest : public SceneFolder, public testing::WithParamInterface<BadGltf> {};

TEST_P(BadGltfTest, IsRefusedWithPlaceAndCure) {
  GltfBuilder gltf = rich_gltf();
  ASSERT_EQ(refusal("good.gltf", gltf.text()), "");
  GetParam().spoil(gltf);
  const std::string message = refusal("bad.gltf", gltf.text());
  EXPECT_THAT(message, HasProblem(GetParam().what));
  EXPECT_THAT(message, HasSubstr("bad.gltf: " + std::string(GetParam().where)));
  EXPECT_THAT(message, HasSubstr("; ")) << "no cure";
}

const BadGltf kBadGltf[] = {
    // The next rows are faults of the document.
    {"Version1", [](auto& g) { g.json["asset"]["version"] = "1.0"; }, "gltf.version", "asset.version"},
    {"Version3", [](auto& g) { g.json["asset"]["version"] = "3.0"; }, "gltf.version \"3.0\"", "asset.version"},
    {"MinVersion", [](auto& g) { g.json["asset"]["minVersion"] = "2.1"; }, "gltf.version \"2.1\"", "asset.minVersion"},
    {"RequiredExtension",
     [](auto& g) {
       g.json["extensionsRequired"] = {"EXT_splats"};
       primitive(g)["extensions"]["EXT_splats"] = json::object();
     },
     "gltf.extension.required EXT_splats", "meshes[0].primitives[0]"},
    // The next rows are faults of types.
    {"NodesIsNoArray", [](auto& g) { g.json["nodes"] = 3; }, "json.type 3", "nodes"},
    {"NodeIsNoObject", [](auto& g) { g.json["nodes"][1] = "x"; }, "json.type", "nodes[1]"},
    {"MeshIndexIsText", [](auto& g) { g.json["nodes"][0]["mesh"] = "0"; }, "json.type", "nodes[0].mesh"},
    {"NoAttributes", [](auto& g) { primitive(g).erase("attributes"); }, "json.missing \"attributes\"",
     "meshes[0].primitives[0]"},
    {"ShortMatrix",
     [](auto& g) {
       g.json["nodes"][0]["matrix"] = {1, 2, 3};
     },
     "json.type 16", "nodes[0].matrix"},
    {"TextInVector",
     [](auto& g) {
       g.json["nodes"][0]["scale"] = {1, "1", 1};
     },
     "json.type", "nodes[0].scale[1]"},
    // The next rows are faults of indices.
    {"MeshIndex", [](auto& g) { g.json["nodes"][0]["mesh"] = 9; }, "json.index 9", "nodes[0].mesh"},
    {"NegativeIndex", [](auto& g) { g.json["nodes"][0]["mesh"] = -1; }, "json.index -1", "nodes[0].mesh"},
    {"HugeIndex", [](auto& g) { g.json["nodes"][0]["mesh"] = 1e30; }, "json.index 1e+30", "nodes[0].mesh"},
    {"AttributeIndex", [](auto& g) { primitive(g)["attributes"]["POSITION"] = 9; }, "json.index 9",
     "meshes[0].primitives[0].attributes.POSITION"},
    {"ChildIndex", [](auto& g) { g.json["nodes"][0]["children"] = {7}; }, "json.index 7", "nodes[0].children[0]"},
    {"ShapeIndex",
     [](auto& g) {
       g.json["meshes"][1]["primitives"][0]["extensions"]["PROMIN_mesh_primitive_implicit_shape"]["shape"] = 2;
     },
     "json.index 2", "meshes[1].primitives[0].extensions.PROMIN_mesh_primitive_implicit_shape.shape"},
    {"VertexIndex",
     [](auto& g) {
       primitive(g)["indices"] = g.template add<uint8_t>({0, 1, 3}, "SCALAR");
     },
     "gltf.indices.range 3 3", "meshes[0].primitives[0].indices, element 2"},
    {"RestartIndex",
     [](auto& g) {
       primitive(g)["indices"] = g.template add<uint16_t>({0, 1, 65535}, "SCALAR");
     },
     "gltf.indices.range 65535", "meshes[0].primitives[0].indices"},
    // The next rows are faults of enumerations and ranges.
    {"Mode", [](auto& g) { primitive(g)["mode"] = 7; }, "json.range 7", "meshes[0].primitives[0].mode"},
    {"ComponentType", [](auto& g) { g.json["accessors"][0]["componentType"] = 5124; }, "json.choice",
     "accessors[0].componentType"},
    {"AccessorType", [](auto& g) { g.json["accessors"][0]["type"] = "VEC5"; }, "json.choice \"VEC5\"",
     "accessors[0].type"},
    {"BrokenCount", [](auto& g) { g.json["accessors"][0]["count"] = 1.5; }, "json.type 1.5", "accessors[0].count"},
    // The next rows are faults of shapes.
    {"ZeroRadius", [](auto& g) { shape(g, 0)["sphere"]["radius"] = 0; }, "json.range 0",
     "extensions.KHR_implicit_shapes.shapes[0].sphere.radius"},
    {"NegativeRadius", [](auto& g) { shape(g, 1)["cylinder"]["radiusTop"] = -1; }, "json.range -1",
     "extensions.KHR_implicit_shapes.shapes[1].cylinder.radiusTop"},
    {"TinyRadius", [](auto& g) { shape(g, 0)["sphere"]["radius"] = 1e-23; }, "json.range 1e-23",
     "extensions.KHR_implicit_shapes.shapes[0].sphere.radius"},
    {"HugeRadius", [](auto& g) { shape(g, 0)["sphere"]["radius"] = 1e18; }, "json.range 1e+18",
     "extensions.KHR_implicit_shapes.shapes[0].sphere.radius"},
    {"TinyApexRadius", [](auto& g) { shape(g, 1)["cylinder"]["radiusTop"] = 1e-30; },
     "gltf.shape.size radius shapes[1]", "nodes[2]"},
    {"ZeroHeight", [](auto& g) { shape(g, 1)["cylinder"]["height"] = 0; }, "json.range 0",
     "extensions.KHR_implicit_shapes.shapes[1].cylinder.height"},
    {"NoRadiusAtAll",
     [](auto& g) {
       shape(g, 1)["cylinder"].update({{"radiusTop", 0}, {"radiusBottom", 0}});
     },
     "gltf.shape.size shapes[1]", "extensions.KHR_implicit_shapes.shapes[1].cylinder"},
    {"ScaledTooFar",
     [](auto& g) {
       g.json["nodes"][1]["scale"] = {1e16, 1e16, 1e16};
     },
     "gltf.shape.size 1e+16", "nodes[1]"},
    {"BoxWithoutDepth",
     [](auto& g) {
       shape(g, 0) = {{"type", "box"}, {"box", {{"size", {1, 2, 0}}}}};
     },
     "json.range 0", "extensions.KHR_implicit_shapes.shapes[0].box.size"},
    {"CapsuleOfNegativeHeight",
     [](auto& g) {
       shape(g, 0) = {{"type", "capsule"}, {"capsule", {{"height", -1}}}};
     },
     "json.range -1", "extensions.KHR_implicit_shapes.shapes[0].capsule.height"},
    {"CapsuleWithoutRadii",
     [](auto& g) {
       shape(g, 0) = {{"type", "capsule"}, {"capsule", {{"radiusTop", 0}, {"radiusBottom", 0}}}};
     },
     "gltf.shape.size shapes[0]", "extensions.KHR_implicit_shapes.shapes[0].capsule"},
    {"UnknownShape", [](auto& g) { shape(g, 0)["type"] = "torus"; }, "json.choice \"torus\"",
     "extensions.KHR_implicit_shapes.shapes[0].type"},
    // The next rows are faults of vertices.
    {"NanVertex",
     [](auto& g) {
       set_positions(g, {0, 0, 0, 1, kNan, 0, 0, 1, 0});
     },
     "gltf.position.range", "meshes[0].primitives[0].attributes.POSITION, element 1"},
    {"InfiniteVertex",
     [](auto& g) {
       set_positions(g, {0, 0, 0, 1, 0, 0, 0, INFINITY, 0});
     },
     "gltf.position.range", "meshes[0].primitives[0].attributes.POSITION, element 2"},
    {"FarVertex",
     [](auto& g) {
       set_positions(g, {2e15F, 0, 0, 1, 0, 0, 0, 1, 0});
     },
     "gltf.position.range", "meshes[0].primitives[0].attributes.POSITION, element 0"},
    {"FarNode",
     [](auto& g) {
       g.json["nodes"][0]["scale"] = {1e16, 1, 1};
     },
     "gltf.position.far", "nodes[0]"},
    {"PositionFormat",
     [](auto& g) {
       primitive(g)["attributes"]["POSITION"] = g.template add<float>({0, 0, 0, 0, 0, 0}, "VEC2");
     },
     "gltf.accessor.format VEC2 5126", "meshes[0].primitives[0].attributes.POSITION"},
    {"IndexFormat",
     [](auto& g) {
       primitive(g)["indices"] = g.template add<float>({0, 1, 2}, "SCALAR");
     },
     "gltf.accessor.format SCALAR 5126", "meshes[0].primitives[0].indices"},
    // The next rows are faults of bytes.
    {"ViewPastTheBuffer", [](auto& g) { g.json["bufferViews"][1]["byteLength"] = 999; }, "gltf.view.short",
     "bufferViews[1]"},
    {"ViewOffset", [](auto& g) { g.json["bufferViews"][1]["byteOffset"] = 9007199254740992; }, "gltf.view.short",
     "bufferViews[1]"},
    {"AccessorPastTheView", [](auto& g) { g.json["accessors"][0]["count"] = 4; }, "gltf.accessor.short 48 36",
     "accessors[0]"},
    {"AccessorOffset", [](auto& g) { g.json["accessors"][0]["byteOffset"] = 4; }, "gltf.accessor.short 40",
     "accessors[0]"},
    {"WrappingCount",
     [](auto& g) {
       g.json["bufferViews"][0]["byteStride"] = 252;
       g.json["accessors"][0]["count"] = 2147483647;
     },
     "gltf.accessor.short 541165878804", "accessors[0]"},
    {"CountPastAnyFile", [](auto& g) { g.json["accessors"][0]["count"] = 18446744073709551615ULL; }, "json.range",
     "accessors[0].count"},
    {"HugeZeros",
     [](auto& g) {
       g.json["accessors"][0].erase("bufferView");
       g.json["accessors"][0]["count"] = 2000000000;
     },
     "gltf.accessor.large 2000000000", "accessors[0].count"},
    {"PositionFormatOfNormals",
     [](auto& g) {
       primitive(g)["attributes"]["POSITION"] = g.template add<uint32_t>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
     },
     "gltf.accessor.format VEC3 5125", "meshes[0].primitives[0].attributes.POSITION"},
    {"SmallStride", [](auto& g) { g.json["bufferViews"][0]["byteStride"] = 8; }, "gltf.accessor.stride 12",
     "accessors[0]"},
    {"SparsePastTheView",
     [](auto& g) {
       const size_t view = g.template add_view<uint8_t>({0, 0, 0, 0});
       g.json["accessors"][0]["sparse"] = {
           {"count", 5}, {"indices", {{"bufferView", view}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
     },
     "gltf.accessor.short 5", "accessors[0].sparse.indices"},
    {"SparseIndex",
     [](auto& g) {
       const size_t view = g.template add_view<uint8_t>({3});
       g.json["accessors"][0]["sparse"] = {
           {"count", 1}, {"indices", {{"bufferView", view}, {"componentType", 5121}}}, {"values", {{"bufferView", 0}}}};
     },
     "gltf.accessor.index 3", "accessors[0].sparse.indices, element 0"},
    // The next rows are faults of nodes.
    {"OwnChild", [](auto& g) { g.json["nodes"][0]["children"] = {0}; }, "gltf.node.cycle", "nodes[0]"},
    {"Cycle",
     [](auto& g) {
       g.json["nodes"][0]["children"] = {1};
       g.json["nodes"][1]["children"] = {0};
     },
     "gltf.node.cycle", "nodes[0]"},
    {"OverflowingTree",
     [](auto& g) {
       for (size_t i = 4; i < 20; ++i) {
         g.add_node({{"scale", {1e25, 1e25, 1e25}}, {"children", {i == 4 ? 0 : i - 1}}});
       }
     },
     "gltf.node.far", "nodes["},
};

INSTANTIATE_TEST_SUITE_P(Table, BadGltfTest, testing::ValuesIn(kBadGltf),
                         [](const auto& bad) { return std::string(bad.param.name); });

/// Faults of buffers. The document's own URI is replaced, so these cases do not use text().
struct BadUri {
  const char* name;
  const char* uri;
  const char* what;
};

std::ostream& operator<<(std::ostream& stream, const BadUri& bad) {
  return stream << bad.name;
}

class BadUriTest : public SceneFolder, public testing::WithParamInterface<BadUri> {};

TEST_P(BadUriTest, IsRefusedWithPlaceAndCure) {
  GltfBuilder gltf = triangle_gltf();
  fs::create_directories(folder_ / "scene/sub");
  write("secret.bin", gltf.bytes);
  write("scene/short.bin", "1234");
  write("scene/empty.bin", "");
  fs::create_symlink("../secret.bin", folder_ / "scene/link.bin");
  fs::create_directory_symlink("..", folder_ / "scene/up");
  gltf.json["buffers"] = {{{"byteLength", gltf.bytes.size()}, {"uri", GetParam().uri}}};
  const std::string message = refusal("scene/bad.gltf", gltf.json.dump());
  EXPECT_THAT(message, HasProblem(GetParam().what));
  EXPECT_THAT(message, HasSubstr("; ")) << "no cure";
}

const BadUri kBadUris[] = {
    {"Missing", "none.bin", "file.missing buffers[0].uri"},
    {"Empty", "", "scene.name.wrong"},
    {"EmptyFile", "empty.bin", "file.empty"},
    {"Folder", "sub", "file.folder"},
    {"Short", "short.bin", "gltf.buffer.short 4 42"},
    {"Parent", "../secret.bin", "scene.name.outside"},
    {"ParentInside", "sub/../../secret.bin", "scene.name.outside"},
    {"EscapedParent", "%2e%2e/secret.bin", "scene.name.outside"},
    {"EscapedSlash", "..%2Fsecret.bin", "scene.name.outside"},
    {"Backslash", "..\\secret.bin", "scene.name.outside"},
    {"Absolute", "/etc/passwd", "scene.name.outside"},
    {"EscapedAbsolute", "%2Fetc/passwd", "scene.name.outside"},
    {"FileScheme", "file:///etc/passwd", "scene.name.outside"},
    {"WebScheme", "http://localhost/a.bin", "scene.name.outside"},
    {"Link", "link.bin", "scene.name.outside link"},
    {"LinkedFolder", "up/secret.bin", "scene.name.outside link"},
    {"ZeroByte", "a%00b", "scene.name.wrong"},
    {"BrokenEscape", "a%2", "gltf.uri.broken"},
    {"DataNotBase64", "data:application/octet-stream,abc", "gltf.uri.broken"},
    {"DataBroken", "data:application/octet-stream;base64,ab*d", "gltf.uri.broken"},
    {"DataEmpty", "data:application/octet-stream;base64,", "gltf.buffer.short 0"},
    {"DataShort", "data:application/octet-stream;base64,AAAA", "gltf.buffer.short 3"},
};

INSTANTIATE_TEST_SUITE_P(Table, BadUriTest, testing::ValuesIn(kBadUris),
                         [](const auto& bad) { return std::string(bad.param.name); });

// The next tests check faults of files.

class BadGltfFileTest : public SceneFolder {};

TEST_F(BadGltfFileTest, MissingFoldersAndEmptyFilesSayWhy) {
  EXPECT_THAT(refusal(folder_ / "none.gltf"), HasProblem("file.missing"));
  fs::create_directories(folder_ / "a.glb");
  EXPECT_THAT(refusal(folder_ / "a.glb"), HasProblem("file.folder"));
  EXPECT_THAT(refusal("b.gltf", ""), HasProblem("file.empty"));
}

TEST_F(BadGltfFileTest, UnknownEndingsNameTheKnownOnes) {
  EXPECT_THAT(refusal("scene.fbx", "x"), HasSubstr("\".fbx\""));
  EXPECT_THAT(refusal("scene.fbx", "x"), HasSubstr(".gltf, .glb, .obj"));
}

TEST_F(BadGltfFileTest, BrokenJsonNamesTheLine) {
  EXPECT_THAT(refusal("a.gltf", "{\n\"asset\": ]}"), HasSubstr("line 2"));
  EXPECT_THAT(refusal("a.gltf", "{\"a\": \"\xff\xfe\"}"), HasProblem("json.syntax"));
  EXPECT_THAT(refusal("a.gltf", "[]"), HasProblem("json.type"));
}

TEST_F(BadGltfFileTest, DeepNestingIsRefusedBeforeItIsParsed) {
  EXPECT_THAT(refusal("a.gltf", std::string(20'000, '[')), HasProblem("json.depth 20000"));
  const std::string objects = [] {
    std::string text;
    for (int i = 0; i < 20'000; ++i) text += "{\"a\":";
    return text;
  }();
  EXPECT_THAT(refusal("a.gltf", objects), HasProblem("json.depth 20000"));
  EXPECT_THAT(refusal("a.gltf", "{\"asset\": {\"version\": \"" + std::string(500, '[') + "\"}}"),
              HasProblem("gltf.version"))
      << "brackets in strings do not count";
}

TEST_F(BadGltfFileTest, GlbLengthsAreChecked) {
  const std::string good = triangle_gltf().glb();
  ASSERT_EQ(refusal("a.glb", good), "");
  const auto spoiled = [&](size_t offset, size_t value) {
    std::string bytes = good;
    bytes.replace(offset, 4, GltfBuilder::u32(value));
    return refusal("a.glb", bytes);
  };
  const size_t json_length = static_cast<unsigned char>(good[12]) + 256 * static_cast<unsigned char>(good[13]);
  const size_t binary = 20 + json_length;
  EXPECT_THAT(refusal("a.glb", good.substr(0, 10)), HasProblem("glb.short"));
  EXPECT_THAT(refusal("a.glb", good.substr(0, good.size() - 4)), HasProblem("glb.short 44 40"));
  EXPECT_THAT(spoiled(4, 1), HasSubstr("the file is glTF 1.0"));
  EXPECT_THAT(spoiled(4, 3), HasSubstr("version is 3"));
  EXPECT_THAT(spoiled(12, 0xFFFFFFF0), HasSubstr("chunk declares"));
  EXPECT_THAT(spoiled(12, json_length + 8), testing::Not(""));
  EXPECT_THAT(spoiled(16, 7), HasSubstr("is not JSON"));
  EXPECT_THAT(spoiled(binary, 52), HasSubstr("chunk declares 52 bytes, but only 44 bytes remain"));
  EXPECT_THAT(spoiled(binary + 4, 7), HasSubstr("has no bytes")) << "a chunk of unknown type is skipped";
}

TEST_F(BadGltfFileTest, TheBinaryChunkMayNotBeShorterThanItsViews) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["bufferViews"][1]["byteLength"] = 12;
  std::string bytes = gltf.glb();
  const std::string length = "\"byteLength\":42";
  bytes.replace(bytes.rfind(length), length.size(), "\"byteLength\":48");
  EXPECT_THAT(refusal("a.glb", bytes), HasProblem("gltf.buffer.short 44 48"));
}

/// The bytes of a buffer must exist if a part of the document reads from it.
TEST_F(BadGltfFileTest, BuffersThatAMeshNeedsMayNotLackBytes) {
  const auto refuse_without = [&](const std::function<void(GltfBuilder&)>& use) {
    GltfBuilder gltf = triangle_gltf();
    gltf.text();
    gltf.json["buffers"].push_back({{"byteLength", 36}, {"uri", "none.bin"}});
    gltf.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
    use(gltf);
    return refusal("a.gltf", gltf.json.dump());
  };
  const auto add_vectors = [](GltfBuilder& gltf) {
    gltf.json["accessors"].push_back({{"bufferView", 2}, {"componentType", 5126}, {"count", 3}, {"type", "VEC3"}});
    return gltf.json["accessors"].size() - 1;
  };
  for (const char* attribute : {"POSITION", "NORMAL", "COLOR_0"}) {
    EXPECT_THAT(refuse_without([&](auto& g) { primitive(g)["attributes"][attribute] = add_vectors(g); }),
                HasSubstr("buffers[1].uri"))
        << attribute;
  }
  EXPECT_THAT(refuse_without([](auto& g) { g.json["accessors"][1]["bufferView"] = 2; }), HasSubstr("buffers[1].uri"));
  for (const bool has_indices : {true, false}) {
    EXPECT_THAT(refuse_without([&](auto& g) {
                  g.json["accessors"][0]["sparse"] = {
                      {"count", 1},
                      {"indices", {{"bufferView", has_indices ? 2 : 0}, {"componentType", 5121}}},
                      {"values", {{"bufferView", has_indices ? 0 : 2}}}};
                }),
                HasSubstr("buffers[1].uri"));
  }
}

TEST_F(BadGltfFileTest, AllProblemsOfAFileComeTogether) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["nodes"][0]["mesh"] = 5;
  gltf.json["accessors"][0]["type"] = "VEC9";
  gltf.json["meshes"][0]["primitives"][0]["mode"] = 9;
  const std::string message = refusal("a.gltf", gltf.text());
  EXPECT_EQ(std::ranges::count(message, '\n'), 2);
  EXPECT_THAT(message, HasSubstr("nodes[0].mesh"));
  EXPECT_THAT(message, HasSubstr("accessors[0].type"));
  EXPECT_THAT(message, HasSubstr("meshes[0].primitives[0].mode"));
}

TEST_F(BadGltfFileTest, ManyProblemsAreCutShort) {
  GltfBuilder gltf = triangle_gltf();
  for (int i = 0; i < 1000; ++i) gltf.add_node({{"mesh", 100 + i}});
  const std::string message = refusal("a.gltf", gltf.text());
  EXPECT_THAT(message, HasProblem("problems.more 950"));
  EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 50);
}

TEST_F(BadGltfFileTest, MessagesStayOnTheirLines) {
  GltfBuilder gltf = triangle_gltf();
  gltf.json["meshes"][0]["primitives"][0]["attributes"]["A\nB"] = 99;
  EXPECT_THAT(refusal("a.gltf", gltf.text()), HasSubstr("attributes.A?B"));
}

}  // namespace
}  // namespace promin
