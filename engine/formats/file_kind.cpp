// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "formats/file_kind.h"

#include <algorithm>
#include <cstring>
#include <fstream>

#include "core/file.h"
#include "core/stand_in.h"
#include "formats/text_lines.h"

namespace promin {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kUnpack = "unpack it and give the scene's file";
constexpr std::string_view kBlender = "open it in Blender and export glTF";
constexpr std::string_view kCad = "open it in FreeCAD and export glTF or STL";
constexpr std::string_view kPoints = "make a mesh of its points (by CloudCompare, say) and export PLY";
constexpr std::string_view kMeshLab = "convert it to PLY by MeshLab";

struct Magic {
  std::string_view bytes;
  std::string_view name;
  std::string_view cure;
  /// Position of the bytes in the file.
  size_t offset = 0;
};

/// Archive formats, recognised by bytes that every such file has.
constexpr Magic kArchives[] = {
    {"PK\x03\x04"sv, "a zip archive", kUnpack},
    {"PK\x05\x06"sv, "a zip archive", kUnpack},
    {"\x1F\x8B"sv, "compressed by gzip", "unpack it by gunzip"},
    {"\x28\xB5\x2F\xFD"sv, "compressed by Zstandard", "unpack it by unzstd"},
    {"BZh"sv, "compressed by bzip2", "unpack it by bunzip2"},
    {"\xFD\x37zXZ\0"sv, "compressed by xz", "unpack it by unxz"},
    {"7z\xBC\xAF\x27\x1C"sv, "a 7z archive", kUnpack},
    {"Rar!\x1A\x07"sv, "a rar archive", kUnpack},
    {"ustar"sv, "a tar archive", kUnpack, 257},
};

/// Formats that promin does not read, recognised by bytes that every such file has.
constexpr Magic kMagics[] = {
    {"Kaydara FBX Binary"sv, "FBX", kBlender},
    {"; FBX "sv, "FBX", kBlender},
    {"PXR-USDC"sv, "USD", kBlender},
    {"#usda"sv, "USD", kBlender},
    {"BLENDER"sv, "a Blender file", kBlender},
    {"ISO-10303-21"sv, "STEP", kCad},
    {"S      1"sv, "IGES", kCad, 72},
    {"#VRML"sv, "VRML", kMeshLab},
    {"#X3D"sv, "X3D", kMeshLab},
    {"Ogawa\xFF"sv, "Alembic", kBlender},
    {"\x89HDF\r\n\x1A\n"sv, "HDF5, as in old Alembic files", kBlender},
    {"LASF"sv, "LAS, a point cloud", kPoints},
    {"ASTM-E57"sv, "E57, a point cloud", kPoints},
    {"# .PCD"sv, "PCD, a point cloud", kPoints},
    {"# vtk DataFile"sv, "VTK", "open it in ParaView and export glTF or PLY"},
};

/// File name extensions of other programs' scenes that are archives.
constexpr Magic kEndings[] = {{".usdz", "USD", kBlender},
                              {".blend", "a compressed Blender file", kBlender},
                              {".3mf", "3MF", "export STL by the program that wrote it"}};

/// Kinds of XML files, recognised by the root element.
constexpr Magic kRoots[] = {{"<COLLADA", "COLLADA", kBlender}, {"<X3D", "X3D", kMeshLab}};

constexpr Magic kOffWords[] = {
    {"OFF", "", ""}, {"COFF", "", ""}, {"NOFF", "", ""}, {"CNOFF", "", ""}, {"STOFF", "", ""}};

FileKind kind_of(const Magic& magic) {
  return {.name = std::string(magic.name), .cure = std::string(magic.cure)};
}

FileKind readable_kind(const std::string& name, const std::string& ending) {
  return {.name = name, .cure = "give its name the ending " + ending, .ending = ending};
}

bool has_at(std::string_view bytes, const Magic& magic) {
  return bytes.size() >= magic.offset && bytes.substr(magic.offset).starts_with(magic.bytes);
}

uint32_t read_u32(std::string_view bytes, size_t offset) {
  uint32_t number = 0;
  for (size_t i = 0; i < 4; ++i) number |= uint32_t{static_cast<uint8_t>(bytes[offset + i])} << (8 * i);
  return number;
}

/// Returns whether the file is a 3DS scene: a chunk 0x4D4D that is the whole file and begins with one of the usual
/// first chunks.
bool is_3ds(std::string_view bytes, uint64_t size_bytes) {
  if (bytes.size() < 8 || !bytes.starts_with("MM") || read_u32(bytes, 2) != size_bytes) return false;
  return bytes.substr(6, 2) == "\x02\0"sv || bytes.substr(6, 2) == "\x3D\x3D"sv;
}

bool is_binary_stl(std::string_view bytes, uint64_t size_bytes) {
  if (bytes.size() < 84) return false;
  const uint64_t count = read_u32(bytes, 80);
  return count > 0 && size_bytes == 84 + 50 * count;
}

bool has_three_numbers(std::string_view line) {
  for (int i = 0; i < 3; ++i) {
    if (!parse_number(take_word(line))) return false;
  }
  return true;
}

/// Returns the kind of a text file, from the first line that is neither empty nor a comment; for NFF also from the next
/// line.
FileKind kind_of_text(std::string_view text) {
  TextLines lines(text);
  std::string_view keyword;
  while (keyword.empty() && lines.advance()) {
    std::string_view line = lines.line();
    keyword = take_word(line);
    if (std::ranges::find(kOffWords, keyword, &Magic::bytes) != std::end(kOffWords)) {
      return {.name = "OFF", .cure = std::string(kMeshLab)};
    }
    const bool has_numbers = has_three_numbers(line);
    if (keyword == "mtllib" || ((keyword == "v" || keyword == "vn") && has_numbers))
      return readable_kind("OBJ", ".obj");
    if (keyword == "b" && has_numbers) return readable_kind("NFF", ".nff");
    // A group or object statement is not enough to recognise OBJ.
    if (keyword == "o" || keyword == "g" || keyword == "s") keyword = {};
  }
  if (keyword != "v" || !lines.advance()) return {};
  std::string_view line = lines.line();
  return take_word(line) == "from" ? readable_kind("NFF", ".nff") : FileKind{};
}

/// Returns the kind of a file that promin can read; an unknown kind for other files.
FileKind find_readable_kind(std::string_view bytes, uint64_t size_bytes) {
  const std::string_view text = skip_to_text(bytes);
  if (bytes.starts_with("glTF")) return readable_kind("glTF", ".glb");
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return readable_kind("PLY", ".ply");
  if (is_binary_stl(bytes, size_bytes)) return readable_kind("STL", ".stl");
  if (text.starts_with("solid") && text.find("facet") != std::string_view::npos) return readable_kind("STL", ".stl");
  if (text.starts_with('{') && text.find("\"asset\"") != std::string_view::npos) return readable_kind("glTF", ".gltf");
  return bytes.find('\0') == std::string_view::npos ? kind_of_text(text) : FileKind{};
}

}  // namespace

FileKind find_file_kind(std::string_view first_bytes, std::string_view ending, uint64_t size_bytes) {
  if (const StandIn* stand_in = find_stand_in(first_bytes)) return {.name = stand_in->what, .cure = stand_in->cure};
  for (const Magic& magic : kArchives) {
    if (!has_at(first_bytes, magic)) continue;
    const auto* const scene = std::ranges::find(kEndings, ending, &Magic::bytes);
    return kind_of(scene == std::end(kEndings) ? magic : *scene);
  }
  for (const Magic& magic : kMagics) {
    if (has_at(first_bytes, magic)) return kind_of(magic);
  }
  const std::string_view text = skip_to_text(first_bytes);
  if (text.starts_with('<')) {
    for (const Magic& root : kRoots) {
      if (text.find(root.bytes) != std::string_view::npos) return kind_of(root);
    }
  }
  if (is_3ds(first_bytes, size_bytes)) return {.name = "3DS", .cure = std::string(kMeshLab)};
  return find_readable_kind(first_bytes, size_bytes);
}

FileKind find_file_kind(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return {};
  std::string first_bytes(std::min<uint64_t>(size, kKindBytes), '\0');
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(first_bytes.data(), static_cast<std::streamsize>(first_bytes.size()))) return {};
  return find_file_kind(first_bytes, lower_case_ending(file), size);
}

}  // namespace promin
