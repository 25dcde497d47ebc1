// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <bit>
#include <random>
#include <sstream>

#include "promin/motion.h"
#include "promin/validate.h"
#include "support/gltf_builder.h"
#include "support/make_png.h"
#include "support/moving_gltf.h"
#include "support/other_values.h"
#include "support/ply_builder.h"
#include "support/scene_folder.h"
#include "support/stl_builder.h"
#include "support/thorough.h"

namespace promin {
namespace {

using nlohmann::json;

/// Returns a small document that uses most features.
GltfBuilder small_gltf() {
  GltfBuilder gltf = triangle_gltf();
  auto& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  primitive["attributes"]["COLOR_0"] = gltf.add<uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC4", true);
  primitive["material"] = 0;
  const size_t indices = gltf.add_view<uint8_t>({1});
  const size_t values = gltf.add_view<float>({2, 0, 0});
  gltf.json["accessors"][0]["sparse"] = {{"count", 1},
                                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                                         {"values", {{"bufferView", values}}}};
  gltf.json["materials"] = {{{"name", "m"}, {"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}}};
  gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  gltf.json["extensions"] = {
      {"KHR_lights_punctual", {{"lights", {{{"type", "spot"}, {"spot", {{"outerConeAngle", 0.5}}}}}}}},
      {"KHR_implicit_shapes", {{"shapes", {{{"type", "cylinder"}, {"cylinder", {{"radiusTop", 0}}}}}}}},
      {"OMI_environment_sky", {{"skies", {{{"type", "plain"}, {"plain", {{"color", {1, 1, 1}}}}}}}}}};
  gltf.show(
      {{"attributes", json::object()}, {"extensions", {{"PROMIN_mesh_primitive_implicit_shape", {{"shape", 0}}}}}});
  gltf.add_node({{"camera", 0},
                 {"children", {0, 1}},
                 {"scale", {2, 2, 2}},
                 {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf.json["scenes"] = {{{"nodes", {2}}}};

  gltf.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = {
      {"diffuseFactor", {1, 0, 0, 1}}, {"specularGlossinessTexture", {{"index", 0}}}};
  gltf.json["textures"] = {{{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}}};
  gltf.json["images"] = {{{"bufferView", 0}}};
  gltf.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "v"}}};
  json& varied = gltf.json["meshes"][0]["primitives"][0];
  varied["extensions"]["KHR_materials_variants"]["mappings"] = {{{"material", 0}, {"variants", {0}}}};
  varied["targets"] = {{{"POSITION", 0}, {"NORMAL", 2}}};
  gltf.json["meshes"][0]["weights"] = {0.5};
  gltf.json["nodes"][0]["weights"] = {0.25};
  json& instances = gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
  instances["TRANSLATION"] = gltf.add<float>({0, 0, 0, 1, 1, 1}, "VEC3");
  instances["ROTATION"] = gltf.add<int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, "VEC4", true);
  return gltf;
}

/// Returns a small document that uses every feature of motion.
GltfBuilder moving_gltf() {
  GltfBuilder gltf = triangle_gltf();
  json& primitive = gltf.json["meshes"][0]["primitives"][0];
  primitive["attributes"]["NORMAL"] = gltf.add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
  primitive["attributes"]["TEXCOORD_0"] = gltf.add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
  primitive["attributes"]["COLOR_0"] = gltf.add<uint8_t>({1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12}, "VEC4", true);
  primitive["attributes"]["JOINTS_0"] = gltf.add<uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
  primitive["attributes"]["WEIGHTS_0"] = gltf.add<float>({0.5F, 0.5F, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
  primitive["targets"] = {{{"POSITION", 0}, {"NORMAL", 2}, {"TEXCOORD_0", 3}, {"COLOR_0", 4}}};
  primitive["material"] = 0;
  gltf.json["meshes"][0]["weights"] = {0.5};
  gltf.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0, 0, 1}}}}}};
  gltf.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  gltf.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {{{"type", "spot"}}}}}},
                             {"KHR_implicit_shapes", {{"shapes", {{{"type", "sphere"}}}}}}};
  gltf.show(
      {{"attributes", {{"POSITION", 0}}}, {"extensions", {{"PROMIN_mesh_primitive_implicit_shape", {{"shape", 0}}}}}});
  gltf.add_node({{"children", {1, 3}}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
  gltf.add_node({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  gltf.json["nodes"][0]["skin"] = 0;
  const size_t bind = gltf.add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,  //
                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 2, 3, 1},
                                      "MAT4");
  gltf.json["skins"] = {{{"joints", {2, 3}}, {"inverseBindMatrices", bind}}};
  using test::animate;
  animate(gltf, 0, "/nodes/2/rotation", {0, 1}, gltf.add<int16_t>({0, 0, 0, 32767, 0, 19660, 0, 26214}, "VEC4", true));
  animate(gltf, 0, "/nodes/3/translation", {0, 2}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 0, 0, 0}, "VEC3",
          "CUBICSPLINE");
  animate(gltf, 0, "/nodes/1/scale", {0, 2}, {1, 1, 1, -1, 1, 0}, "VEC3");
  animate(gltf, 0, "/nodes/0/weights", {0, 1, 2}, {0, 1, 0.5F}, "SCALAR", "STEP");
  animate(gltf, 1, "/nodes/0/weights/0", {0, 1}, {0, 1}, "SCALAR");
  animate(gltf, 1, "/nodes/2/extensions/KHR_node_visibility/visible", {0, 1}, gltf.add<uint8_t>({0, 1}, "SCALAR"),
          "STEP");
  animate(gltf, 1, "/materials/0/pbrMetallicRoughness/baseColorFactor", {0, 1}, {0, 0, 0, 0, 1, 1, 1, 1}, "VEC4");
  animate(gltf, 1, "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle", {0, 1}, {0, 1}, "SCALAR");
  animate(gltf, 1, "/cameras/0/perspective/yfov", {0, 1}, {0.5F, 1}, "SCALAR");
  return gltf;
}

/// Checks that each pose of a scene is valid, or that promin refuses it.
void check_poses(const Scene& scene) {
  if (scene.motion == nullptr) return;
  for (uint32_t animation = 0; animation < scene.motion->animations.size(); ++animation) {
    for (const double time_s : {0.0, 0.7, 3.0}) {
      try {
        const Scene posed = scene_at(scene, {.animations = {animation}, .time_s = time_s});
        world::flatten(posed);
        ASSERT_EQ(validate(posed).size(), 0U) << "animation " << animation << " at " << time_s << " is not valid";
      } catch (const InputError& error) {
        ASSERT_NE(std::string(error.what()), "");
      }
    }
  }
}

const std::string kSmallObj =
    "mtllib a.mtl\nv 0 0 0\nv 1 0 0 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0.5 0\nvn 0 0 1\no one\nusemtl red\n"
    "f 1 2 3 4\nf 1//1 2//1 3//-1\ng two\nf -5 -4 -3 -2 -1\nl 1 2\nvt 0 1\nvt 1 0.5\nf 1/1/1 2/2/1 3/-1/1\n"
    "usemtl metal\nf 1/1 2/2 3/2\n";
const std::string kSmallMtl =
    "newmtl red\nKa 0 0 0\nKd 1 0 0\nKs 1 1 1\nNs 10\nillum 3\nd 0.5\nmap_Kd -s 1 1 1 a.png\nnorm -bm 2 a.png\n"
    "newmtl metal\nPr 0.5\nPm 1\nmap_Pr -clamp on -o 0 1 a.png\nmap_Pm a.png\nmap_Ke a.png\nbump -bm 2 -imfchan r "
    "a.png\n";

/// Returns a square with normals and colours, a strip, and elements that the loader skips.
std::string small_ply(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty float nx\n"
         "property float ny\nproperty float nz\nproperty uchar red\nproperty ushort green\nproperty float blue\n"
         "element edge 1\nproperty list uchar short ends\nelement face 2\nproperty list uchar int vertex_indices\n"
         "element tristrips 1\nproperty list int char vertex_indices\nend_header\n";
}

/// Returns faces with colours, textures and texture coordinates, after a header with other line ends.
std::string small_textured_ply() {
  return "ply\rformat ascii 1.0\rcomment TextureFile a.png\relement face 3\rproperty uchar red\r"
         "property uchar green\rproperty float blue\rproperty list uchar int vertex_index\r"
         "property list uchar float texcoord\rproperty int texnumber\relement vertex 4\rproperty float s\r"
         "property float t\rproperty float x\rproperty float y\rproperty float z\rproperty float nx\r"
         "property float ny\rproperty float nz\rend_header\r"
         "255 0 0.5 3 0 1 2 6 0 0 1 0 1 1 0\r0 128 0 4 0 1 2 3 0 -1\r0 0 0 3 0 2 3 6 0 0 nan 1 1 0 0\r"
         "0 0 0 0 0 0 0 1\r1 0 1 0 0 0 0 1\r1 1 1 1 0 0 0 nan\r0 1 0 1 0 0 1 0\r";
}

std::string small_text_ply() {
  return small_ply("ascii") +
         "0 0 0 0 0 1 255 0 0.5\n1 0 0 0 0 1 0 65535 1\n1 1 0 0 0 1 0 0 0\n0 1 0 0 0 0 9 9 0.25\n"
         "2 0 1\n4 0 1 2 3\n3 0 1 2\n5 0 1 -1 2 3\n";
}

std::string small_binary_ply(std::endian order) {
  PlyBuilder ply(order);
  std::string header = small_ply("x");
  header.erase(0, header.find("element"));
  header.resize(header.find("end_header"));
  ply.header(header);
  for (int i = 0; i < 4; ++i) {
    for (const char* type : {"float", "float", "double", "float", "float", "float", "uchar", "ushort", "float"}) {
      ply.add(type, i);
    }
  }
  const auto add_list = [&](const char* count_type, const char* type, const std::vector<int>& numbers) {
    ply.add(count_type, static_cast<double>(numbers.size()));
    for (const int number : numbers) ply.add(type, number);
  };
  add_list("uchar", "short", {0, 1});
  add_list("uchar", "int", {0, 1, 2, 3});
  add_list("uchar", "int", {0, 1, 2});
  add_list("int", "char", {0, 1, 2, -1, 1, 2, 3});
  return ply.bytes();
}

const std::string kSmallStl =
    "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1.5e0 0\nendloop\nendfacet\n"
    "endsolid\nsolid b\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid b\n";

const std::string kSmallNff =
    "b 0.1 0.2 0.3 # sky\nv\nfrom 0 1 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 48\nl 1 2 3\n"
    "l 4 5 6 1 0.5 0\nf 1 0.5 0.2 0.7 0.3 20 0.1 1.5\ns 0 0 0 1\nc 0 0 0 1 0 2 0 1\nc 0 0 0 -1 0 2 0 0\n"
    "p 5\n0 0 0\n2 0 0\n2 2 0\n1 1 0\n0 2 0\nf 0 0 1 1 0 0 0 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0.1 1\n0 1 0 0.1 0 1\n";

/// Changes the text at random. Some of the new bytes have a meaning for one of the parsers.
std::string mutate(std::string bytes, std::mt19937& random) {
  static const std::string kTelling = "{}[]\",:-+.eE0123456789/\\# \n\r\tnullvfog\0\xff";
  const size_t changes = 1 + random() % 4;
  for (size_t i = 0; i < changes && !bytes.empty(); ++i) {
    const size_t at = random() % bytes.size();
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes[at] = kTelling[random() % kTelling.size()];
        break;
      case 3:
        bytes.erase(at, 1 + random() % 8);
        break;
      case 4:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 16));
        break;
      default:
        if (random() % 8 == 0) bytes.resize(at);
    }
  }
  return bytes;
}

class LoadFuzzTest : public SceneFolder {
 protected:
  LoadFuzzTest() {
    const std::vector<std::byte> png = make_png({2, 1}, PNG_COLOR_TYPE_RGB, 8, {1, 2, 3, 4, 5, 6});
    write("a.png", {reinterpret_cast<const char*>(png.data()), png.size()});
  }

  /// Loads `scene` with changed forms of the file `name`: 3000 in thorough tests, else the first 600 of them.
  void run(const std::string& name, const std::string& bytes, const std::string& scene,
           const LoadOptions& options = {}) {
    const int count = test::is_thorough() ? 3000 : 600;
    std::mt19937 random(20240607);
    int refused = 0;
    int noticed = 0;
    for (int i = 0; i < count; ++i) {
      const std::string mutant = mutate(bytes, random);
      write(name, mutant);
      try {
        const Scene loaded = load_scene(folder_ / scene, options);
        world::flatten(loaded);
        ASSERT_EQ(validate(loaded).size(), 0U) << "mutant " << i << " loads and is not valid";
        ASSERT_NO_FATAL_FAILURE(check_poses(loaded)) << "mutant " << i;
        if (!loaded.warnings.empty()) ++noticed;
      } catch (const InputError& error) {
        ++refused;
        ASSERT_NE(std::string(error.what()), "");
      } catch (const std::exception& error) {
        FAIL() << "mutant " << i << " throws another error: " << error.what();
      }
    }
    EXPECT_GT(refused + noticed, count / 10) << "the mutations do nothing";
    EXPECT_LT(refused, count) << "nothing loads any more";
  }
};

TEST_F(LoadFuzzTest, GltfLoadsOrIsRefused) {
  run("a.gltf", small_gltf().text(), "a.gltf");
}

TEST_F(LoadFuzzTest, MovingGltfLoadsOrIsRefused) {
  run("a.gltf", moving_gltf().text(), "a.gltf");
  run("a.glb", moving_gltf().glb(), "a.glb");
}

TEST_F(LoadFuzzTest, GlbLoadsOrIsRefused) {
  run("a.glb", small_gltf().glb(), "a.glb");
}

TEST_F(LoadFuzzTest, ObjLoadsOrIsRefused) {
  write("a.mtl", kSmallMtl);
  run("a.obj", kSmallObj, "a.obj");
}

// Only a strict loader refuses an OBJ because of its MTL.
TEST_F(LoadFuzzTest, MtlLoadsOrIsRefused) {
  write("a.obj", kSmallObj);
  run("a.mtl", kSmallMtl, "a.obj", {.is_strict = true});
}

TEST_F(LoadFuzzTest, PlyLoadsOrIsRefused) {
  run("a.ply", small_text_ply(), "a.ply");
  run("a.ply", small_textured_ply(), "a.ply");
  run("a.ply", small_binary_ply(std::endian::little), "a.ply");
  run("a.ply", small_binary_ply(std::endian::big), "a.ply");
}

TEST_F(LoadFuzzTest, StlLoadsOrIsRefused) {
  run("a.stl", kSmallStl, "a.stl");
  StlBuilder stl;
  stl.add({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)});
  stl.add({vec3(0, 0, 1), vec3(1, 0, 1), vec3(0, 1, 1)}, 0x8007);
  run("a.stl", stl.bytes(), "a.stl");
}

TEST_F(LoadFuzzTest, NffLoadsOrIsRefused) {
  run("a.nff", kSmallNff, "a.nff");
}

/// The file ends at any position, lacks one of its words, or contains a word twice.
TEST_F(LoadFuzzTest, NffWithOtherWordsLoadsOrIsRefused) {
  std::vector<std::string> words;
  std::istringstream text(kSmallNff);
  for (std::string word; text >> word;) words.push_back(word);
  const std::string kOthers[] = {"",   "0", "-1", "nan", "1e999",      "1e15",
                                 "-0", "p", "f",  "#",   "resolution", "4294967299"};
  int refused = 0;
  int total = 0;
  for (size_t i = 0; i < words.size(); ++i) {
    for (const std::string& other : kOthers) {
      std::string mutant;
      for (size_t k = 0; k < words.size(); ++k) mutant += (k == i ? other : words[k]) + "\n";
      for (const std::string& file : {mutant, mutant.substr(0, mutant.size() * (i + 1) / words.size())}) {
        ++total;
        write("a.nff", file);
        try {
          const Scene loaded = load_scene(folder_ / "a.nff");
          world::flatten(loaded);
          ASSERT_EQ(validate(loaded).size(), 0U) << file;
        } catch (const InputError& error) {
          ++refused;
          ASSERT_NE(std::string(error.what()).find("a.nff: line "), std::string::npos) << error.what();
        }
      }
    }
  }
  EXPECT_GT(refused, total / 3);
  EXPECT_LT(refused, total);
}

/// These tests do not only change bytes. They replace each value of the document by values of all other kinds.
class OtherValuesTest : public LoadFuzzTest, public testing::WithParamInterface<GltfBuilder (*)()> {};

TEST_P(OtherValuesTest, LoadOrAreRefused) {
  GltfBuilder gltf = GetParam()();
  gltf.text();
  const json good = gltf.json.flatten();
  // The document of motion is large, so its mutants are sampled.
  const int step = GetParam() == &moving_gltf && !test::is_thorough() ? 7 : 1;
  int refused = 0;
  int total = 0;
  int number = 0;
  for (const auto& [pointer, old] : good.items()) {
    for (const json& value : kOtherValues) {
      if (number++ % step != 0) continue;
      json document = good.unflatten();
      document[json::json_pointer(pointer)] = value;
      // The object or array around the value changes, too.
      json parent = good.unflatten();
      parent[json::json_pointer(pointer).parent_pointer()] = value;
      for (const json& mutant : {document, parent}) {
        ++total;
        write("a.gltf", mutant.dump());
        try {
          const Scene loaded = load_scene(folder_ / "a.gltf");
          world::flatten(loaded);
          ASSERT_EQ(validate(loaded).size(), 0U) << pointer << " = " << value;
          ASSERT_NO_FATAL_FAILURE(check_poses(loaded)) << pointer << " = " << value;
        } catch (const InputError&) {
          ++refused;
        }
      }
    }
  }
  EXPECT_GT(refused, total / 5);
  EXPECT_LT(refused, total);
}

INSTANTIATE_TEST_SUITE_P(Documents, OtherValuesTest, testing::Values(&small_gltf, &moving_gltf),
                         [](const auto& row) { return row.index == 0 ? "Still" : "Moving"; });

}  // namespace
}  // namespace promin
