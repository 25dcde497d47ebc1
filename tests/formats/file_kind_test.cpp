// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/file_kind.h"

#include <gmock/gmock.h>

#include "support/gltf_builder.h"
#include "support/scene_folder.h"
#include "support/stl_builder.h"

namespace promin {
namespace {

using namespace std::string_literals;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const std::string kPointer =
    "version https://git-lfs.github.com/spec/v1\noid sha256:"
    "4d7a214614ab2935c943f9e0ff69d22eadbb8f32b1258daaa5e2ca24d17e2393\nsize 132735\n";
const std::string kPage = "\xEF\xBB\xBF\n<!DOCTYPE html>\n<html><head></head></html>\n";
const std::string kObj = "# a comment\no thing\n\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const std::string kNff = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 8 8\ns 0 0 0 1\n";

std::string binary_stl() {
  StlBuilder stl;
  stl.add({vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)});
  return stl.bytes();
}

/// Returns a chunk that contains a version. The chunk has the length that its header declares.
std::string small_3ds() {
  return "MM\x10\0\0\0\x02\0\x0A\0\0\0\x03\0\0\0"s;
}

struct Kind {
  const char* name;
  /// The extension that a file with these bytes should have; empty if promin does not read it.
  const char* ending;
  std::string bytes;
  const char* what;
  const char* cure;
};

std::ostream& operator<<(std::ostream& stream, const Kind& kind) {
  return stream << kind.name;
}

class FileKindTest : public SceneFolder, public testing::WithParamInterface<Kind> {};

/// The file has the extension of another kind of scene, or an unknown extension.
TEST_P(FileKindTest, IsSaidWhereItIsNotWhatTheNameSays) {
  for (const std::string other : {".obj", ".ply", ".stl", ".nff", ".gltf"}) {
    const std::string name = "scene" + other;
    const bool is_own = GetParam().ending == other || (GetParam().ending == ".glb"s && other == ".gltf");
    const std::string message = refusal(name, GetParam().bytes);
    if (is_own) {
      EXPECT_EQ(message, "");
    } else {
      EXPECT_THAT(message, AllOf(HasProblem("scene.file.extension"), HasSubstr("the file is "s + GetParam().what),
                                 HasSubstr(name + ": "), HasSubstr(GetParam().cure)));
    }
  }
  EXPECT_THAT(refusal("scene.unknown", GetParam().bytes),
              AllOf(HasProblem("scene.file.extension \".unknown\""), HasSubstr("the file is "s + GetParam().what),
                    HasSubstr(GetParam().cure)));
}

const Kind kKinds[] = {
    {"LfsPointer", "", kPointer, "a Git LFS pointer", "git lfs pull"},
    {"Page", "", kPage, "an HTML page", "download the file itself"},
    {"PageWithoutDoctype", "", " \r\n<HTML lang=en>", "an HTML page", "download"},
    {"Zip", "", "PK\x03\x04\x14\0\0\0"s, "a zip archive", "unpack"},
    {"Gzip", "", "\x1F\x8B\x08\0"s, "compressed by gzip", "gunzip"},
    {"Zstandard", "", "\x28\xB5\x2F\xFD...", "compressed by Zstandard", "unzstd"},
    {"Bzip2", "", "BZh91AY&SY", "compressed by bzip2", "bunzip2"},
    {"Xz", "", "\xFD\x37zXZ\0\0"s, "compressed by xz", "unxz"},
    {"SevenZip", "", "7z\xBC\xAF\x27\x1C...", "a 7z archive", "unpack"},
    {"Rar", "", "Rar!\x1A\x07\0"s, "a rar archive", "unpack"},
    {"Tar", "", "a.obj" + std::string(252, '\0') + "ustar\0"s, "a tar archive", "unpack"},
    {"FbxBinary", "", "Kaydara FBX Binary  \0"s, "FBX", "Blender"},
    {"FbxText", "", "; FBX 7.4.0 project file\n", "FBX", "Blender"},
    {"UsdBinary", "", "PXR-USDC\0"s, "USD", "Blender"},
    {"UsdText", "", "#usda 1.0\n", "USD", "Blender"},
    {"Blend", "", "BLENDER-v300", "a Blender file", "export glTF"},
    {"Step", "", "ISO-10303-21;\nHEADER;\n", "STEP", "FreeCAD"},
    {"Iges", "", std::string(72, ' ') + "S      1\n", "IGES", "FreeCAD"},
    {"Collada", "", "<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">", "COLLADA", "Blender"},
    {"X3dXml", "", "<?xml version=\"1.0\"?>\n<!DOCTYPE X3D PUBLIC>\n<X3D>", "X3D", "MeshLab"},
    {"X3dText", "", "#X3D V3.0 utf8\n", "X3D", "MeshLab"},
    {"Vrml", "", "#VRML V2.0 utf8\n", "VRML", "MeshLab"},
    {"ThreeDs", "", small_3ds(), "3DS", "MeshLab"},
    {"Off", "", "OFF\n3 1 0\n0 0 0\n", "OFF", "MeshLab"},
    {"ColoredOff", "", "# made\nCOFF 3 1 0\n", "OFF", "MeshLab"},
    {"Alembic", "", "Ogawa\xFF\0"s, "Alembic", "Blender"},
    {"Hdf5", "", "\x89HDF\r\n\x1A\n", "HDF5", "Blender"},
    {"Las", "", "LASF\0\0"s, "LAS", "CloudCompare"},
    {"E57", "", "ASTM-E57\0"s, "E57", "CloudCompare"},
    {"Pcd", "", "# .PCD v0.7\n", "PCD", "CloudCompare"},
    {"Vtk", "", "# vtk DataFile Version 3.0\n", "VTK", "ParaView"},
    {"Obj", ".obj", kObj, "OBJ", "the ending .obj"},
    {"Ply", ".ply", kPly, "PLY", "the ending .ply"},
    {"StlText", ".stl", kStl, "STL", "the ending .stl"},
    {"StlBinary", ".stl", binary_stl(), "STL", "the ending .stl"},
    {"Nff", ".nff", kNff, "NFF", "the ending .nff"},
    {"NffOfBackground", ".nff", "b 1 1 1\ns 0 0 0 1\n", "NFF", "the ending .nff"},
    {"Gltf", ".gltf", triangle_gltf().text(), "glTF", "the ending .gltf"},
    {"Glb", ".glb", triangle_gltf().glb(), "glTF", "the ending .glb"},
};

INSTANTIATE_TEST_SUITE_P(Table, FileKindTest, testing::ValuesIn(kKinds),
                         [](const testing::TestParamInfo<Kind>& kind) { return kind.param.name; });

class FilesOfScenesTest : public SceneFolder {};

TEST_F(FilesOfScenesTest, ArchivesAreScenesBySomeEndings) {
  EXPECT_THAT(refusal("a.usdz", "PK\x03\x04"), HasProblem("scene.file.extension USD"));
  EXPECT_THAT(refusal("a.3MF", "PK\x03\x04"), HasProblem("scene.file.extension 3MF"));
  EXPECT_THAT(refusal("a.blend", "\x28\xB5\x2F\xFD"), HasProblem("scene.file.extension compressed Blender"));
  EXPECT_THAT(refusal("a.blend", "\x1F\x8B"), HasProblem("scene.file.extension compressed Blender"));
  EXPECT_THAT(refusal("a.blend", "BLENDER-v300"), HasProblem("scene.file.extension Blender"));
}

TEST_F(FilesOfScenesTest, AFolderNamesItsScenes) {
  const std::string where = "file.folder " + folder_.string() + ": ";
  EXPECT_THAT(refusal(folder_),
              AllOf(StartsWith(where), HasSubstr("; use a file with one of the extensions .gltf, .glb")));
  write("notes.txt", "");
  write("c.nff", "");
  EXPECT_THAT(refusal(folder_), HasSubstr("; it contains c.nff; give a file"));
  write("b.GLB", "");
  write("a.obj", "");
  EXPECT_THAT(refusal(folder_), HasSubstr("; it contains a.obj and b.GLB; give a file"));
  std::filesystem::create_directory(folder_ / "d.gltf");
  EXPECT_THAT(refusal(folder_ / "d.gltf"), HasProblem("file.folder"));
}

TEST_F(FilesOfScenesTest, WhatSaysNothingIsSaidToBeNothing) {
  EXPECT_THAT(refusal("a.obj", "hello\n"), Not(HasSubstr("the file is")));
  EXPECT_THAT(refusal("a.txt", "hello\n"), HasProblem("scene.file.format \".txt\""));
  EXPECT_THAT(refusal(folder_ / "missing.txt"), HasProblem("scene.file.format \".txt\""));
  EXPECT_THAT(refusal("a.PNG", "hello\n"), HasProblem("scene.file.picture .png"));
  EXPECT_THAT(refusal(folder_ / "missing.exr"), HasProblem("scene.file.picture .exr"));
  EXPECT_THAT(refusal("a.stl", std::string(20, '\0')), HasProblem("stl.file.kind"));
  EXPECT_EQ(find_file_kind("", "", 0).name, "");
}

TEST_F(FilesOfScenesTest, WhatASceneNamesMayBeAPointerToo) {
  GltfBuilder gltf = triangle_gltf();
  gltf.text();
  gltf.json["buffers"][0] = {{"uri", "a.bin"}, {"byteLength", 8}};
  write("a.bin", kPointer);
  EXPECT_THAT(refusal("a.gltf", gltf.json.dump()), AllOf(HasProblem("file.placeholder"), HasSubstr("a.bin: ")));
  write("a.png", kPointer);
  write("b.png", kPage);
  write("a.mtl", "newmtl m\nmap_Kd a.png\nmap_Ks b.png\n");
  EXPECT_THAT(load("a.obj", "mtllib a.mtl\nusemtl m\n" + kObj).warnings,
              AllOf(Contains(HasSubstr("image \"a.png\": the file is a Git LFS pointer")),
                    Contains(HasSubstr("image \"b.png\": the file is an HTML page"))));
}

}  // namespace
}  // namespace promin
