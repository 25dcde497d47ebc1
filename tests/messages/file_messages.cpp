// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <sys/stat.h>

#include <filesystem>

#include "core/file.h"
#include "core/mapped_file.h"
#include "messages/message_cases.h"
#include "promin/load_scene.h"

namespace promin {
namespace {

namespace fs = std::filesystem;

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kVertexLines = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFaceLines = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kPoints = "0 0 0\n1 0 0\n0 1 0\n";

std::string ply(const std::string& elements, const std::string& body) {
  return "ply\nformat ascii 1.0\n" + elements + "end_header\n" + body;
}

MessageCase load(std::string_view code, const std::string& name, const std::string& bytes) {
  return {code, [=] {
            write_case(name, bytes);
            static_cast<void>(load_scene(name));
          }};
}

MessageCase load_strictly(std::string_view code, const std::string& name, const std::string& bytes) {
  return {code, [=] {
            write_case(name, bytes);
            static_cast<void>(load_scene(name, {.is_strict = true}));
          }};
}

/// Loads a material "m" with these lines.
MessageCase load_material(std::string_view code, const std::string& lines) {
  return {code, [=] {
            write_case("m.mtl", "newmtl m\n" + lines);
            write_case("a.obj", kTriangle + "mtllib m.mtl\nusemtl m\nf 1 2 3\n");
            static_cast<void>(load_scene("a.obj", {.is_strict = true}));
          }};
}

std::vector<MessageCase> cases_of_obj() {
  return {
      load("obj.face.corner", "a.obj", kTriangle + "f a b c\n"),
      load("obj.face.index", "a.obj", kTriangle + "f 1 2 5\n"),
      load_strictly("obj.face.corners", "a.obj", kTriangle + "f 1 2\nf 1 2 3\n"),
      load("obj.faces.none", "a.obj", kTriangle),
      load("obj.faces.none", "a.obj", "# nothing\n"),
      load("obj.faces.none", "a.obj", kTriangle + "l 1 2\n"),
      load("obj.faces.none", "a.obj", kTriangle + "f 1 2\n"),
      load("obj.file.kind", "a.obj", std::string("v 0 0\0 0", 8)),
      load_strictly("obj.vertex.numbers", "a.obj", "v 0 0 0 1 1 1 1\n" + kTriangle + "f 1 2 3\n"),
      load_strictly("obj.vertex.numbers", "a.obj", "v 0 0 0 1 1\n" + kTriangle + "f 1 2 3\n"),
      load_strictly("obj.color.range", "a.obj", "v 0 0 0 1 x 1\n" + kTriangle + "f 1 2 3\n"),
      load_strictly("obj.uv.range", "a.obj", kTriangle + "vt nan 0\nf 1 2 3\n"),
      load_strictly("obj.uv.index", "a.obj", kTriangle + "f 1/1 2/1 3/1\n"),
      load_strictly("obj.normal.range", "a.obj", kTriangle + "vn nan 0 1\nf 1//1 2//1 3//1\n"),
      load_strictly("obj.normal.numbers", "a.obj", kTriangle + "vn 0 0 1 1\nf 1//1 2//1 3//1\n"),
      load_strictly("obj.normal.index", "a.obj", kTriangle + "f 1//1 2//1 3//1\n"),
      load_strictly("obj.position.range", "a.obj", "v nan 0 0\n" + kTriangle + "f 1 2 3\nf 2 3 4\n"),
      load_strictly("obj.position.range", "a.obj", "v nan 0 0\n" + kTriangle + "f 2 3 4\n"),
      load_material("mtl.number.range", "Kd 1 x 1\n"),
      load_material("mtl.number.range", "Kd 1 -1 1\n"),
      load_material("file.missing", "map_Kd none.png\n"),
      load_material("picture.unusable", "map_Kd m.mtl\n"),
      load_material("scene.name.outside", "map_Kd ../none.png\n"),
      load_material("scene.name.outside", "map_Kd /none.png\n"),
  };
}

std::vector<MessageCase> cases_of_ply() {
  const std::string triangle = kVertexLines + kFaceLines;
  return {
      load("ply.file.kind", "a.ply", "solid x\n"),
      load("ply.header.short", "a.ply", "ply\nformat ascii 1.0\n"),
      load("ply.header.format", "a.ply", "ply\nelement vertex 0\nend_header\n"),
      load("ply.header.format", "a.ply", "ply\nformat binary 1.0\nend_header\n"),
      load("ply.header.count", "a.ply", ply("element vertex -1\n", "")),
      load("ply.header.twice", "a.ply", ply("element vertex 0\nelement vertex 0\n", "")),
      load("ply.header.twice", "a.ply", ply("element vertex 0\nproperty int x\nproperty float x\n", "")),
      load("ply.header.order", "a.ply", ply("property int x\n", "")),
      load("ply.header.type", "a.ply", ply("element vertex 3\nproperty half x\n", "")),
      {"ply.header.large",
       [] {
         std::string lines;
         for (int i = 0; i < 2000; ++i) lines += "element e" + std::to_string(i) + " 0\n";
         write_case("a.ply", ply(lines, ""));
         static_cast<void>(load_scene("a.ply"));
       }},
      load("ply.file.short", "a.ply", ply("element vertex 1000\nproperty float x\n", kPoints)),
      load("ply.vertices.missing", "a.ply", ply(kFaceLines, "3 0 1 2\n")),
      load("ply.vertices.missing", "a.ply", ply("element vertex 0\nproperty float x\n", "")),
      load("ply.vertices.many", "a.ply", ply("element vertex 4294967295\n" + kFaceLines, "3 0 1 2\n")),
      load("ply.faces.missing", "a.ply", ply(kVertexLines, kPoints)),
      load("ply.row.wrong", "a.ply", ply(triangle, kPoints + "3 0 1 x\n")),
      load("ply.row.wrong", "a.ply", ply(triangle, kPoints + "3 0 1 7\n")),
      load("ply.row.wrong", "a.ply", ply(triangle, kPoints + "9 0 1 2\n")),
      load("ply.row.wrong", "a.ply", ply(triangle, kPoints + "3 0 1\n3 0 1 2\n")),
      load_strictly("ply.face.corners", "a.ply", ply(triangle, kPoints + "2 0 1\n")),
      load_strictly("ply.position.range", "a.ply", ply(triangle, "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
      load_strictly("ply.normal.zero", "a.ply",
                    ply(kVertexLines + "property float nx\nproperty float ny\nproperty float nz\n" + kFaceLines,
                        "0 0 0 0 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n")),
      load_strictly("ply.color.range", "a.ply",
                    ply(kVertexLines + "property float red\nproperty float green\nproperty float blue\n" + kFaceLines,
                        "0 0 0 nan 0 0\n1 0 0 0 0 0\n0 1 0 0 0 0\n3 0 1 2\n")),
      load_strictly(
          "ply.uv.range", "a.ply",
          ply("comment TextureFile a.png\n" + kVertexLines + "property float u\nproperty float v\n" + kFaceLines,
              "0 0 0 nan 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n")),
      load_strictly("ply.uv.count", "a.ply",
                    ply("comment TextureFile a.png\n" + triangle + "property list uchar float texcoord\n",
                        kPoints + "3 0 1 2 4 0 0 1 1\n")),
      load_strictly(
          "ply.texture.index", "a.ply",
          ply("comment TextureFile a.png\n" + triangle + "property list uchar float texcoord\nproperty int texnumber\n",
              kPoints + "3 0 1 2 6 0 0 1 0 0 1 7\n")),
  };
}

std::vector<MessageCase> cases_of_stl_and_nff() {
  std::string never_counted(84 + 50, '\0');
  for (int i = 80; i < 84; ++i) never_counted[static_cast<size_t>(i)] = '\xff';
  return {
      load("stl.file.kind", "a.stl", "stl"),
      load("stl.file.short", "a.stl", std::string(80, ' ') + std::string("\3\0\0\0", 4) + std::string(50, '\0')),
      load("stl.file.short", "a.stl", "solid\nfacet\nvertex 0 0 0\n"),
      load("stl.number.wrong", "a.stl", "solid\nfacet\nvertex 0 x 0\n"),
      load("stl.facet.nested", "a.stl", "solid\nvertex 0 0 0\n"),
      load("stl.facet.nested", "a.stl", "solid\nendfacet\n"),
      load("stl.facet.nested", "a.stl", "solid\nfacet\nfacet\n"),
      load_strictly("stl.facet.corners", "a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n"),
      load_strictly("stl.position.range", "a.stl",
                    "solid\nfacet\nvertex 0 0 nan\nvertex 0 0 0\nvertex 1 1 1\nendfacet\n"),
      load_strictly("stl.count.missing", "a.stl", never_counted),
      load("nff.statement.unknown", "a.nff", "q 1 2 3\n"),
      load("nff.number.wrong", "a.nff", "s 0 0\nx 1\n"),
      load("nff.corners.count", "a.nff", "p 3.5 0 0 0\n"),
      load("nff.file.short", "a.nff", "s 0 0 0\n"),
      load("nff.file.short", "a.nff", "p"),
      load_strictly("nff.numbers.few", "a.nff", "f 1 1\ns 0 0 0 1\n"),
      load_strictly("nff.numbers.many", "a.nff", "f 1 1 1 1 1 1 0 0 1\ns 0 0 0 1\n"),
      load_strictly("nff.number.range", "a.nff", "f -1 1 1 1 1 1 0 0\ns 0 0 0 1\n"),
      load_strictly("nff.position.range", "a.nff", "l nan 0 0\ns 0 0 0 1\n"),
      load_strictly("nff.size.range", "a.nff", "s 0 0 0 0\ns 0 0 0 1\n"),
      load_strictly("nff.size.range", "a.nff", "c 1 2 3 1\n1 2 3 2\ns 0 0 0 1\n"),
      load_strictly("nff.resolution", "a.nff",
                    "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 1.5 3\ns 0 0 0 1\n"),
      load_strictly("nff.view.incomplete", "a.nff", "v\nfrom 0 0 5\ns 0 0 0 1\n"),
      load_strictly("nff.view.direction", "a.nff",
                    "v\nfrom 0 0 5\nat 0 0 5\nup 0 1 0\nangle 40\nhither 1\nresolution 4 3\ns 0 0 0 1\n"),
      load_strictly("nff.normal.zero", "a.nff", "pp 3\n0 0 0 0 0 0\n1 0 0 0 0 1\n0 1 0 0 0 1\n"),
  };
}

std::vector<MessageCase> cases_of_any_file() {
  return {
      {"file.missing", [] { static_cast<void>(load_scene("none.obj")); }},
      {"file.folder",
       [] {
         fs::create_directory("scenes");
         write_case("scenes/a.obj", "x");
         static_cast<void>(load_scene("scenes"));
       }},
      {"file.folder",
       [] {
         fs::create_directory("scenes");
         static_cast<void>(load_scene("scenes"));
       }},
      {"file.folder",
       [] {
         fs::create_directory("a.txt");
         static_cast<void>(read_file("a.txt"));
       }},
      {"file.kind",
       [] {
         ::mkfifo("pipe.obj", 0600);
         static_cast<void>(load_scene("pipe.obj"));
       }},
      {"file.kind", [] { const MappedFile file("/dev/null"); }},
      load("file.empty", "a.obj", ""),
      {"file.empty",
       [] {
         write_case("a.bin", "");
         const MappedFile file("a.bin");
       }},
      {"file.placeholder",
       [] {
         write_case("a.bin", "version https://git-lfs.github.com/spec/v1\n");
         static_cast<void>(read_file("a.bin"));
       }},
      load("scene.file.format", "a.txt", "hello\n"),
      load("scene.file.picture", "a.png", "hello\n"),
      load("scene.file.extension", "a.unknown", "BLENDER-v300"),
      load("scene.file.extension", "a.obj", "BLENDER-v300"),
      load("scene.geometry.none", "a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n"),
      {"scene.root.folder",
       [] {
         write_case("a.obj", kTriangle + "f 1 2 3\n");
         static_cast<void>(load_scene("a.obj", {.root = "none"}));
       }},
      {"scene.variant.unknown",
       [] {
         write_case("a.obj", kTriangle + "f 1 2 3\n");
         static_cast<void>(load_scene("a.obj", {.material_variant = "red"}));
       }},
      {"output.folder.missing", [] { write_text_file("none/a.txt", "x"); }},
      {"output.kind",
       [] {
         fs::create_directory("a.txt");
         write_text_file("a.txt", "x");
       }},
      {"output.kind", [] { write_text_file("/dev/null", "x"); }},
      {"folder.lost",
       [] {
         const fs::path old_folder = fs::current_path();
         fs::create_directory("lost");
         fs::current_path("lost");
         fs::remove(old_folder / "lost");
         try {
           static_cast<void>(read_file("a.obj"));
         } catch (...) {
           fs::current_path(old_folder);
           throw;
         }
       }},
  };
}

}  // namespace

std::vector<MessageCase> cases_of_files() {
  std::vector<MessageCase> all = cases_of_any_file();
  for (const auto& cases : {cases_of_obj(), cases_of_ply(), cases_of_stl_and_nff()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

}  // namespace promin
