// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "messages/message_cases.h"
#include "promin/load_scene.h"
#include "promin/motion.h"
#include "support/moving_gltf.h"
#include "support/rich_gltf.h"

namespace promin {
namespace {

using nlohmann::json;
using Spoil = std::function<void(GltfBuilder& gltf)>;

void load_text(const std::string& text, bool is_strict = false) {
  write_case("a.gltf", text);
  static_cast<void>(load_scene("a.gltf", {.is_strict = is_strict}));
}

MessageCase refuse_document(std::string_view code, const std::string& text, bool quotes_others = false) {
  return {code, [=] { load_text(text); }, quotes_others};
}

/// Loads the rich scene with a fault.
MessageCase spoil_document(std::string_view code, const Spoil& fault, bool is_strict = false) {
  return {code, [=] {
            GltfBuilder gltf = rich_gltf();
            fault(gltf);
            load_text(gltf.text(), is_strict);
          }};
}

MessageCase spoil_strictly(std::string_view code, const Spoil& fault) {
  return spoil_document(code, fault, true);
}

/// Loads the document of rich_gltf.h with a fault that causes only a warning.
MessageCase warn(std::string_view code, const Spoil& fault) {
  return {code, [=] {
            GltfBuilder gltf = rich_gltf();
            fault(gltf);
            write_case("a.gltf", gltf.text());
            throw Warned{load_scene("a.gltf").warnings};
          }};
}

/// Loads a triangle whose document, with its buffer, has a fault.
MessageCase spoil_buffers(std::string_view code, const Spoil& fault, bool is_strict = false) {
  return {code, [=] {
            GltfBuilder gltf = triangle_gltf();
            gltf.text();
            fault(gltf);
            load_text(gltf.json.dump(), is_strict);
          }};
}

/// Loads a triangle with another URI of its buffer.
MessageCase name_buffer(std::string_view code, const std::string& uri) {
  return spoil_buffers(code, [=](GltfBuilder& gltf) { gltf.json["buffers"][0]["uri"] = uri; });
}

/// Loads a GLB after a change of its bytes.
MessageCase spoil_glb(std::string_view code, const std::function<void(std::string& bytes)>& fault,
                      bool is_strict = false) {
  return {code, [=] {
            std::string bytes = triangle_gltf().glb();
            fault(bytes);
            write_case("a.glb", bytes);
            static_cast<void>(load_scene("a.glb", {.is_strict = is_strict}));
          }};
}

/// Loads a triangle with a skin of two joints and a fault.
MessageCase spoil_skin(std::string_view code, const Spoil& fault, bool is_strict = false) {
  return {code, [=] {
            GltfBuilder gltf = triangle_gltf();
            primitive(gltf)["attributes"]["JOINTS_0"] = gltf.add<uint8_t>({0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
            primitive(gltf)["attributes"]["WEIGHTS_0"] =
                gltf.add<float>({1, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4");
            gltf.add_node({{"translation", {0, 0, 2}}});
            gltf.add_node({{"translation", {0, 4, 0}}});
            gltf.json["nodes"][0]["skin"] = 0;
            gltf.json["skins"] = {{{"joints", {1, 2}}}};
            fault(gltf);
            load_text(gltf.text(), is_strict);
          }};
}

/// Loads instances of a triangle with an attribute of these numbers.
MessageCase add_instances(std::string_view code, const char* name, const std::vector<float>& numbers, bool is_strict) {
  return {code, [=] {
            GltfBuilder gltf = triangle_gltf();
            gltf.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
            const char* type = numbers.size() % 4 == 0 ? "VEC4" : "VEC3";
            gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"][name] =
                gltf.add<float>(numbers, type);
            load_text(gltf.text(), is_strict);
          }};
}

/// Loads a view that claims to be a stream of meshoptimizer.
MessageCase compress(std::string_view code, const json& changes) {
  return {code, [=] {
            GltfBuilder gltf = triangle_gltf();
            gltf.json["extensionsUsed"] = {"EXT_meshopt_compression"};
            json extension = {{"buffer", 0},      {"byteOffset", 0}, {"byteLength", 36},
                              {"byteStride", 12}, {"count", 3},      {"mode", "ATTRIBUTES"}};
            extension.update(changes);
            gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = extension;
            load_text(gltf.text());
          }};
}

/// Loads a triangle that an animation moves, strictly and with a fault.
MessageCase spoil_animation(std::string_view code, const Spoil& fault) {
  return {code, [=] {
            GltfBuilder gltf = triangle_gltf();
            test::animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
            fault(gltf);
            load_text(gltf.text(), true);
          }};
}

/// Returns the first channel of the first animation.
json& channel(GltfBuilder& gltf) {
  return gltf.json["animations"][0]["channels"][0];
}

/// Returns the first sampler of the first animation.
json& sampler(GltfBuilder& gltf) {
  return gltf.json["animations"][0]["samplers"][0];
}

void point_to(GltfBuilder& gltf, const std::string& pointer) {
  channel(gltf)["target"] = {{"path", "pointer"}, {"extensions", {{"KHR_animation_pointer", {{"pointer", pointer}}}}}};
}

std::vector<MessageCase> cases_of_animations() {
  constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
  return {
      spoil_animation("gltf.animation.times",
                      [](auto& g) {
                        sampler(g)["input"] = g.template add<float>({0, kNotANumber}, "SCALAR");
                      }),
      spoil_animation("gltf.animation.order",
                      [](auto& g) {
                        sampler(g)["input"] = g.template add<float>({1, 1}, "SCALAR");
                      }),
      spoil_animation("gltf.animation.format",
                      [](auto& g) {
                        sampler(g)["input"] = g.template add<uint8_t>({0, 1}, "SCALAR");
                      }),
      spoil_animation("gltf.animation.format",
                      [](auto& g) {
                        sampler(g)["output"] = g.template add<float>({0, 1, 2, 3}, "VEC2");
                      }),
      spoil_animation("gltf.animation.values",
                      [](auto& g) {
                        sampler(g)["output"] = g.template add<float>({0, 0, 0, kNotANumber, 0, 0}, "VEC3");
                      }),
      spoil_animation("gltf.animation.count",
                      [](auto& g) {
                        sampler(g)["output"] = g.template add<float>({0, 0, 0}, "VEC3");
                      }),
      {"gltf.animation.count",
       [] {
         GltfBuilder gltf = triangle_gltf();
         test::animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0}, "VEC3");
         write_case("a.gltf", gltf.text());
         static_cast<void>(scene_at(load_scene("a.gltf"), {.animations = {0}}));
       }},
      spoil_animation("gltf.rotation.zero",
                      [](auto& g) {
                        channel(g)["target"]["path"] = "rotation";
                        sampler(g)["output"] = g.template add<float>({0, 0, 0, 1, 0, 0, 0, 0}, "VEC4");
                      }),
      spoil_animation("gltf.animation.target", [](auto& g) { channel(g)["target"]["path"] = "colour"; }),
      spoil_animation("gltf.animation.target", [](auto& g) { channel(g)["target"]["path"] = "weights"; }),
      spoil_animation("gltf.animation.target", [](auto& g) { point_to(g, "/materials/3/emissiveFactor"); }),
      spoil_animation("gltf.animation.sampler", [](auto& g) { channel(g)["sampler"] = 3; }),
      spoil_animation("gltf.animation.matrix",
                      [](auto& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }),
      spoil_animation("gltf.animation.twice",
                      [](auto& g) {
                        test::animate(g, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
                      }),
      spoil_animation("gltf.animation.step",
                      [](auto& g) {
                        point_to(g, "/nodes/0/extensions/KHR_node_visibility/visible");
                        sampler(g)["output"] = g.template add<uint8_t>({0, 1}, "SCALAR");
                      }),
      {"gltf.animation.missing",
       [] {
         GltfBuilder gltf = triangle_gltf();
         test::animate(gltf, 0, "/nodes/0/translation", {0, 1}, {0, 0, 0, 1, 0, 0}, "VEC3");
         gltf.text();
         gltf.json["buffers"].push_back({{"byteLength", 24}, {"uri", "none.bin"}});
         gltf.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 24}});
         gltf.json["accessors"].back()["bufferView"] = gltf.json["bufferViews"].size() - 1;
         write_case("a.gltf", gltf.json.dump());
         throw Warned{load_scene("a.gltf").warnings};
       }},
      {"gltf.animation.pointer",
       [] {
         GltfBuilder gltf = triangle_gltf();
         test::animate(gltf, 0, "/extras/age", {0, 1}, {0, 0}, "SCALAR");
         write_case("a.gltf", gltf.text());
         throw Warned{load_scene("a.gltf").warnings};
       }},
      spoil_strictly("gltf.morph.range",
                     [](auto& g) {
                       primitive(g)["targets"] = {
                           {{"POSITION", g.template add<float>({0, 0, kNotANumber, 0, 0, 0, 0, 0, 0}, "VEC3")}}};
                       g.json["meshes"][0]["weights"] = {1};
                     }),
  };
}

std::vector<MessageCase> cases_of_documents() {
  return {
      refuse_document("json.syntax", "{ not json", true),
      refuse_document("json.depth", std::string(20'000, '[')),
      refuse_document("json.type", "[]"),
      spoil_document("json.type", [](auto& g) { g.json["nodes"] = 3; }),
      spoil_document("json.missing", [](auto& g) { primitive(g).erase("attributes"); }),
      spoil_strictly("json.missing", [](auto& g) { g.json["cameras"][0].erase("perspective"); }),
      spoil_document("json.index", [](auto& g) { g.json["nodes"][0]["mesh"] = 9; }),
      spoil_document("json.range", [](auto& g) { primitive(g)["mode"] = 7; }),
      spoil_document("json.choice", [](auto& g) { g.json["accessors"][0]["type"] = "VEC5"; }),
      spoil_document("gltf.version", [](auto& g) { g.json["asset"]["version"] = "1.0"; }),
      spoil_document("gltf.version", [](auto& g) { g.json["asset"]["version"] = "3.0"; }),
      spoil_document("gltf.version", [](auto& g) { g.json["asset"]["minVersion"] = "2.1"; }),
      spoil_strictly("gltf.version", [](auto& g) { g.json.erase("asset"); }),
      spoil_strictly("gltf.version", [](auto& g) { g.json["asset"]["version"] = 2; }),
      spoil_strictly("gltf.extension.required", [](auto& g) { g.json["extensionsRequired"] = {"KHR_materials_foo"}; }),
      spoil_document("gltf.extension.required",
                     [](auto& g) {
                       g.json["extensionsRequired"] = {"EXT_splats"};
                       primitive(g)["extensions"]["EXT_splats"] = json::object();
                     }),
      {"scene.variant.unknown",
       [] {
         write_case("a.gltf", triangle_gltf().text());
         static_cast<void>(load_scene("a.gltf", {.material_variant = "red"}));
       }},
      {"scene.variant.unknown",
       [] {
         GltfBuilder gltf = triangle_gltf();
         gltf.json["extensions"]["KHR_materials_variants"]["variants"] = {{{"name", "noon"}}, {{"name", "dawn"}}};
         write_case("a.gltf", gltf.text());
         static_cast<void>(load_scene("a.gltf", {.material_variant = "dusk"}));
       }},
      {"problems.more",
       [] {
         GltfBuilder gltf = triangle_gltf();
         for (int i = 0; i < 100; ++i) gltf.add_node({{"mesh", 1000 + i}});
         load_text(gltf.text());
       }},
      spoil_glb("glb.short", [](std::string& bytes) { bytes.resize(10); }),
      spoil_glb("glb.short", [](std::string& bytes) { bytes.resize(bytes.size() - 20); }),
      spoil_glb(
          "glb.length", [](std::string& bytes) { bytes[8] = static_cast<char>(bytes[8] + 4); }, true),
      spoil_glb("glb.chunks", [](std::string& bytes) { bytes[16] = 'X'; }),
      spoil_glb("gltf.version", [](std::string& bytes) { bytes[4] = 3; }),
  };
}

std::vector<MessageCase> cases_of_bytes() {
  return {
      name_buffer("scene.name.wrong", ""),
      name_buffer("scene.name.wrong", "a%00b"),
      name_buffer("scene.name.outside", "../a.bin"),
      name_buffer("scene.name.outside", "http://localhost/a.bin"),
      name_buffer("file.missing", "none.bin"),
      name_buffer("file.folder", "."),
      name_buffer("gltf.uri.broken", "a%2"),
      name_buffer("gltf.uri.broken", "data:application/octet-stream,abc"),
      name_buffer("gltf.uri.broken", "data:application/octet-stream;base64,ab*d"),
      name_buffer("gltf.buffer.short", "data:application/octet-stream;base64,AAAA"),
      spoil_buffers(
          "gltf.buffer.short", [](auto& g) { g.json["buffers"][0]["byteLength"] = 100; }, true),
      spoil_buffers("gltf.buffer.missing", [](auto& g) { g.json["buffers"][0].erase("uri"); }),
      spoil_buffers(
          "gltf.buffer.empty",
          [](auto& g) {
            g.json["buffers"].push_back({{"byteLength", 0}});
          },
          true),
      spoil_buffers(
          "gltf.buffer.unreadable",
          [](auto& g) {
            g.json["buffers"].push_back({{"byteLength", 36}, {"uri", "none.bin"}});
            g.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 36}});
            g.json["images"] = {{{"bufferView", 2}, {"mimeType", "image/png"}}};
          },
          true),
      spoil_document("gltf.view.short", [](auto& g) { g.json["bufferViews"][1]["byteLength"] = 999; }),
      spoil_strictly("gltf.view.short",
                     [](auto& g) {
                       const size_t view = g.template add_view<uint8_t>({0});
                       g.json["bufferViews"][view]["byteLength"] = 11;
                       g.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
                     }),
      spoil_strictly("gltf.view.stride",
                     [](auto& g) {
                       g.json["bufferViews"][0]["byteStride"] = 14;
                       g.json["bufferViews"][0]["byteLength"] = 40;
                     }),
      spoil_strictly("gltf.view.empty",
                     [](auto& g) {
                       g.template add<float>({}, "VEC3");
                       g.json["bufferViews"].back()["byteLength"] = 0;
                     }),
      spoil_strictly("gltf.accessor.empty",
                     [](auto& g) {
                       g.template add<float>({}, "VEC3");
                       g.json["bufferViews"].back()["byteLength"] = 0;
                     }),
      spoil_document("gltf.accessor.short", [](auto& g) { g.json["accessors"][0]["count"] = 4; }),
      spoil_document("gltf.accessor.large",
                     [](auto& g) {
                       g.json["accessors"][0].erase("bufferView");
                       g.json["accessors"][0]["count"] = 2000000000;
                     }),
      spoil_document("gltf.accessor.stride", [](auto& g) { g.json["bufferViews"][0]["byteStride"] = 8; }),
      spoil_document("gltf.accessor.index",
                     [](auto& g) {
                       const size_t view = g.template add_view<uint8_t>({3});
                       g.json["accessors"][0]["sparse"] = {{"count", 1},
                                                           {"indices", {{"bufferView", view}, {"componentType", 5121}}},
                                                           {"values", {{"bufferView", 0}}}};
                     }),
      spoil_document("gltf.accessor.format",
                     [](auto& g) {
                       primitive(g)["indices"] = g.template add<float>({0, 1, 2}, "SCALAR");
                     }),
      spoil_strictly(
          "gltf.accessor.format",
          [](auto& g) {
            primitive(g)["attributes"]["TEXCOORD_0"] = g.template add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
          }),
      spoil_strictly("gltf.accessor.format", [](auto& g) { g.json["accessors"][1]["normalized"] = true; }),
      spoil_strictly("gltf.accessor.count",
                     [](auto& g) {
                       primitive(g)["attributes"]["NORMAL"] = g.template add<float>({0, 0, 1}, "VEC3");
                     }),
      {"gltf.accessor.count",
       [] {
         GltfBuilder gltf = triangle_gltf();
         json& attributes = gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
         attributes["SCALE"] = gltf.add<float>({1, 1, 1}, "VEC3");
         attributes["TRANSLATION"] = gltf.add<float>({1, 1, 1, 2, 2, 2}, "VEC3");
         load_text(gltf.text());
       }},
      compress("gltf.meshopt.short", {{"byteLength", 1 << 20}}),
      compress("gltf.meshopt.stride", {{"byteStride", 13}}),
      compress("gltf.meshopt.stride", {{"mode", "TRIANGLES"}}),
      compress("gltf.meshopt.stride", {{"filter", "OCTAHEDRAL"}}),
      compress("gltf.meshopt.stride", {{"filter", "QUATERNION"}}),
      compress("gltf.meshopt.count", {{"count", 4}}),
      compress("gltf.meshopt.damaged", json::object()),
      {"gltf.meshopt.ratio",
       [] {
         GltfBuilder gltf = triangle_gltf();
         gltf.json["extensionsUsed"] = {"EXT_meshopt_compression"};
         gltf.json["bufferViews"][0]["byteLength"] = 12'000'000'000;
         gltf.json["accessors"][0]["count"] = 1'000'000'000;
         gltf.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"] = {
             {"buffer", 0},      {"byteOffset", 0},        {"byteLength", 36},
             {"byteStride", 12}, {"count", 1'000'000'000}, {"mode", "ATTRIBUTES"}};
         gltf.json["bufferViews"][0]["buffer"] = 1;
         gltf.text();
         gltf.json["buffers"].push_back(
             {{"byteLength", 12'000'000'000}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
         load_text(gltf.json.dump());
       }},
      {"gltf.draco.damaged",
       [] {
         GltfBuilder gltf = triangle_gltf();
         gltf.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
         primitive(gltf)["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0},
                                                                        {"attributes", {{"POSITION", 0}}}};
         load_text(gltf.text());
       },
       true},
  };
}

/// Changes the node of the camera and the light, and adds a parent of it.
void move_last_node(GltfBuilder& gltf, const json& changes, json parent) {
  gltf.json["nodes"][3].update(changes);
  parent["children"] = {3};
  gltf.add_node(parent);
}

std::vector<MessageCase> cases_of_geometry() {
  const auto set_positions = [](const std::vector<float>& positions) {
    return [=](GltfBuilder& g) { primitive(g)["attributes"]["POSITION"] = g.add<float>(positions, "VEC3"); };
  };
  return {
      spoil_document("gltf.position.range", set_positions({2e15F, 0, 0, 1, 0, 0, 0, 1, 0})),
      spoil_document("gltf.position.far",
                     [](auto& g) {
                       g.json["nodes"][0]["scale"] = {1e16, 1, 1};
                     }),
      spoil_document("gltf.indices.range",
                     [](auto& g) {
                       primitive(g)["indices"] = g.template add<uint8_t>({0, 1, 3}, "SCALAR");
                     }),
      spoil_strictly(
          "gltf.color.range",
          [](auto& g) {
            primitive(g)["attributes"]["COLOR_0"] = g.template add<float>({0, 0, 0, 0, -1, 0, 0, 0, 0}, "VEC3");
          }),
      spoil_strictly(
          "gltf.uv.range",
          [](auto& g) {
            primitive(g)["attributes"]["TEXCOORD_0"] = g.template add<float>({0, 0, 1, std::nanf(""), 0, 1}, "VEC2");
          }),
      warn("gltf.normals.zero",
           [](auto& g) {
             primitive(g)["attributes"]["NORMAL"] = g.template add<float>({0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
           }),
      warn("gltf.tangents.zero",
           [](auto& g) {
             json& attributes = primitive(g)["attributes"];
             attributes["NORMAL"] = g.template add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
             attributes["TEXCOORD_0"] = g.template add<float>({0, 0, 1, 0, 0, 1}, "VEC2");
             attributes["TANGENT"] = g.template add<float>(std::vector<float>(12, 0.0F), "VEC4");
             g.json["images"] = {{{"uri", "data:image/png;base64,"}}};
             g.json["textures"] = {{{"source", 0}}};
             g.json["materials"][0]["normalTexture"] = {{"index", 0}};
             primitive(g)["material"] = 0;
           }),
      warn("gltf.primitive.lines",
           [](auto& g) {
             g.show({{"attributes", {{"POSITION", 0}}}, {"mode", 1}});
           }),
      warn("gltf.primitive.positions",
           [](auto& g) {
             g.show({{"attributes", json::object()}});
           }),
      warn("gltf.primitive.short",
           [](auto& g) {
             g.show({{"attributes", {{"POSITION", g.template add<float>({0, 0, 0}, "VEC3")}}}});
           }),
      warn("gltf.primitive.incomplete",
           [](auto& g) {
             primitive(g)["indices"] = g.template add<uint8_t>({0, 1, 2, 0}, "SCALAR");
           }),
      warn("gltf.morph.count",
           [](auto& g) {
             primitive(g)["targets"] = {{{"POSITION", g.template add<float>({0, 0, 1}, "VEC3")}}};
             g.json["meshes"][0]["weights"] = {1};
           }),
      warn("gltf.camera.far",
           [](auto& g) {
             g.json["nodes"][3].erase("extensions");
             move_last_node(g, {{"translation", {1e15, 0, 0}}}, {{"scale", {2, 2, 2}}});
           }),
      warn("gltf.camera.direction",
           [](auto& g) {
             g.json["nodes"][3].erase("extensions");
             move_last_node(g, json::object(), {{"matrix", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}});
           }),
      warn("gltf.light.far",
           [](auto& g) {
             g.json["nodes"][3].erase("camera");
             move_last_node(g, {{"translation", {1e15, 0, 0}}}, {{"scale", {2, 2, 2}}});
           }),
      warn("gltf.light.direction",
           [](auto& g) {
             g.json["nodes"][3].erase("camera");
             move_last_node(g, json::object(), {{"matrix", {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1}}});
           }),
      warn("gltf.skin.instances",
           [](auto& g) {
             json& node = g.json["nodes"][0];
             primitive(g)["attributes"]["JOINTS_0"] =
                 g.template add<uint8_t>({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC4");
             primitive(g)["attributes"]["WEIGHTS_0"] =
                 g.template add<float>({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, "VEC4");
             node["skin"] = 0;
             g.json["skins"] = {{{"joints", {3}}}};
             node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
                 g.template add<float>({0, 0, 0}, "VEC3");
           }),
      spoil_strictly("gltf.node.twice",
                     [](auto& g) {
                       g.json["nodes"][0]["children"] = {2, 2};
                     }),
      spoil_strictly("gltf.node.twice",
                     [](auto& g) {
                       g.json["scenes"] = {{{"nodes", {0, 1, 0, 2}}}};
                     }),
      spoil_strictly("gltf.node.parents",
                     [](auto& g) {
                       g.json["nodes"][0]["children"] = {2};
                       g.json["nodes"][1]["children"] = {2};
                     }),
      spoil_document("gltf.node.cycle", [](auto& g) { g.json["nodes"][0]["children"] = {0}; }),
      spoil_strictly("gltf.node.root",
                     [](auto& g) {
                       g.json["nodes"][3]["children"] = {1};
                       g.json["scenes"] = {{{"nodes", {0, 1, 2}}}};
                     }),
      spoil_strictly("gltf.node.root",
                     [](auto& g) {
                       g.json["nodes"][0]["children"] = {1};
                       g.json["scenes"] = {{{"nodes", {0, 1, 2, 3}}}};
                     }),
      spoil_strictly("gltf.node.transform",
                     [](auto& g) {
                       g.json["nodes"][0].update(
                           {{"scale", {1, 1, 1}}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
                     }),
      spoil_strictly(
          "gltf.matrix.affine",
          [](auto& g) { g.json["nodes"][0]["matrix"] = {1, 0, 0, 0.5, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }),
      spoil_strictly("gltf.rotation.zero",
                     [](auto& g) {
                       g.json["nodes"][0]["rotation"] = {0, 0, 0, 0};
                     }),
      spoil_document("gltf.node.far",
                     [](auto& g) {
                       for (size_t i = 4; i < 20; ++i) {
                         g.add_node({{"scale", {1e25, 1e25, 1e25}}, {"children", {i == 4 ? 0 : i - 1}}});
                       }
                     }),
      spoil_strictly("gltf.light.cone",
                     [](auto& g) {
                       light(g)["spot"] = {{"innerConeAngle", 1.0}, {"outerConeAngle", 0.5}};
                     }),
      spoil_document("gltf.shape.size", [](auto& g) { shape(g, 1)["cylinder"]["radiusTop"] = 1e-30; }),
      spoil_document("gltf.shape.size",
                     [](auto& g) {
                       shape(g, 1)["cylinder"].update({{"radiusTop", 0}, {"radiusBottom", 0}});
                     }),
      spoil_document("gltf.shape.far",
                     [](auto& g) {
                       g.json["nodes"][1]["translation"] = {1e15, 0, 0};
                       g.add_node({{"children", {1}}, {"scale", {2, 2, 2}}});
                     }),
      spoil_document("gltf.shape.flat",
                     [](auto& g) {
                       shape(g, 0) = {{"type", "plane"}, {"plane", json::object()}};
                       g.json["nodes"][1]["scale"] = {0, 1, 1};
                     }),
      add_instances("gltf.rotation.zero", "ROTATION", {0, 0, 0, 0}, true),
      add_instances("gltf.number.range", "TRANSLATION", {0, std::nanf(""), 0}, false),
      {"gltf.instances.missing",
       [] {
         GltfBuilder gltf = triangle_gltf();
         gltf.json["accessors"].push_back({{"componentType", 5126}, {"count", 16}, {"type", "VEC3"}});
         gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
             gltf.json["accessors"].size() - 1;
         load_text(gltf.text());
       }},
      {"scene.size.limit",
       [] {
         GltfBuilder gltf = triangle_gltf();
         json& primitives = gltf.json["meshes"][0]["primitives"];
         primitives = std::vector<json>((1 << 12) + 1, primitives[0]);
         gltf.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["SCALE"] =
             gltf.add(std::vector<float>(3 << 12, 1.0F), "VEC3");
         load_text(gltf.text());
       }},
      spoil_strictly("gltf.image.missing",
                     [](auto& g) {
                       g.json["images"] = {json::object()};
                       g.json["textures"] = {{{"source", 0}}};
                       g.json["materials"][0]["normalTexture"] = {{"index", 0}};
                       primitive(g)["material"] = 0;
                     }),
      spoil_skin("gltf.skin.joint",
                 [](auto& g) {
                   primitive(g)["attributes"]["JOINTS_0"] =
                       g.template add<uint8_t>({0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0}, "VEC4");
                 }),
      spoil_skin("gltf.skin.count",
                 [](auto& g) {
                   g.json["skins"][0]["inverseBindMatrices"] =
                       g.template add<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4");
                 }),
      spoil_skin(
          "gltf.skin.empty", [](auto& g) { g.json["skins"][0]["joints"] = json::array(); }, true),
      spoil_skin(
          "gltf.skin.weights", [](auto& g) { primitive(g)["attributes"].erase("JOINTS_0"); }, true),
      spoil_skin(
          "gltf.skin.weights",
          [](auto& g) {
            primitive(g)["attributes"]["WEIGHTS_0"] =
                g.template add<float>({0, 0, 0, 0, 1, 0, 0, 0, 0.5F, 0.5F, 0, 0}, "VEC4");
          },
          true),
  };
}

}  // namespace

std::vector<MessageCase> cases_of_gltf() {
  std::vector<MessageCase> all = cases_of_documents();
  for (const auto& cases : {cases_of_bytes(), cases_of_geometry(), cases_of_animations()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

}  // namespace promin
