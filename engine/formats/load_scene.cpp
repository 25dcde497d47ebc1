// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/load_scene.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <string>
#include <string_view>

#include "core/count_of.h"
#include "core/file.h"
#include "core/rounding.h"
#include "core/utf8.h"
#include "formats/far_scene.h"
#include "formats/file_kind.h"
#include "formats/gltf/load_gltf.h"
#include "formats/load_report.h"
#include "formats/nff/load_nff.h"
#include "formats/obj/load_obj.h"
#include "formats/ply/load_ply.h"
#include "formats/source_file.h"
#include "formats/stl/load_stl.h"
#include "promin/error.h"
#include "promin/image.h"
#include "scene/glass.h"
#include "scene/stray_geometry.h"
#include "scene/turned_normals.h"

namespace promin {
namespace {

struct SceneFormat {
  std::string_view ending;
  Scene (*load)(const LoadOptions&, LoadReport&);
  bool has_variants = false;
  /// True if files of the format contain only a mesh.
  bool is_mesh = false;
};

bool has_anything_to_draw(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return primitive_count(scene, object) > 0; });
}

/// The smallest size of a mesh that rays can hit. A triangle's area in the sheared plane must be a normal float
/// (shaders/trace/primitives/triangle.glsl).
constexpr float kSmallestMesh = 1e-18F;

/// Warns of meshes that are large enough to be loaded but too small to be hit.
void warn_of_tiny_meshes(const VertexBounds& bounds, Scene& scene) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (primitive_count(scene, object) == 0) continue;
    const bool is_mesh = std::holds_alternative<Mesh>(scene.geometries[object.geometry]);
    if (!is_mesh || max_component(bounds.of_objects[i].extent()) >= kSmallestMesh) continue;
    scene.warnings.push_back("object " + std::to_string(i) +
                             " is smaller than 1e-18, so fp32 cannot represent its triangles");
  }
}

/// Warns of triangles whose normals scene/turned_normals.h reverses.
void warn_of_turned_normals(Scene& scene) {
  std::vector<bool> is_shown(scene.geometries.size(), false);
  for (const Object& object : scene.objects) {
    if (object.geometry != Object::kNoGeometry) is_shown[object.geometry] = true;
  }
  uint64_t count = 0;
  for (size_t i = 0; i < scene.geometries.size(); ++i) {
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[i]);
    if (is_shown[i] && mesh != nullptr) count += find_turned_triangles(*mesh).size();
  }
  if (count == 0) return;
  scene.warnings.push_back(
      std::to_string(count) +
      (count == 1 ? " triangle has vertex normals that point against its winding; promin reverses the normals"
                  : " triangles have vertex normals that point against their winding; promin reverses the normals"));
}

std::vector<bool> find_shown_materials(const Scene& scene) {
  std::vector<bool> is_shown(scene.materials.size(), false);
  for (const Object& object : scene.objects) {
    if (primitive_count(scene, object) == 0) continue;
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
    if (mesh == nullptr || mesh->triangle_materials.empty()) {
      is_shown[object.material] = true;
    } else {
      for (const uint32_t material : mesh->triangle_materials) is_shown[material] = true;
    }
  }
  return is_shown;
}

/// Returns whether a channel of a texture is above 0 anywhere; true without a texture. The channel starts at bit `bit`
/// of a texel.
bool has_any(const Scene& scene, const TextureSlot& slot, int bit) {
  if (!slot.exists()) return true;
  const std::vector<uint32_t>& texels = scene.images[scene.textures[slot.texture].image]->texels;
  return texels.empty() || std::ranges::any_of(texels, [&](uint32_t texel) { return (texel >> bit & 0xFF) != 0; });
}

bool is_rough_glass(const Scene& scene, const Material& material) {
  const auto* model = std::get_if<MetallicRoughness>(&material.model);
  return model != nullptr && is_clear(material) && model->roughness > 0.0F &&
         has_any(scene, model->metallic_roughness_texture, 8) && has_any(scene, model->transmission_texture, 0);
}

/// Warns of glass that blurs only the sky (docs/model.md, "Glass").
void warn_of_rough_glass(Scene& scene) {
  const std::vector<bool> is_shown = find_shown_materials(scene);
  size_t first = 0;
  uint64_t count = 0;
  for (size_t i = 0; i < is_shown.size(); ++i) {
    if (!is_shown[i] || !is_rough_glass(scene, scene.materials[i])) continue;
    if (count == 0) first = i;
    ++count;
  }
  if (count == 0) return;
  const std::string& name = scene.materials[first].name;
  const std::string other = count == 1 ? "" : " and " + count_of(count - 1, "other") + " like it";
  scene.warnings.push_back("material " + (name.empty() ? std::to_string(first) : quote(name)) + other +
                           (count == 1 ? " is" : " are") +
                           " rough glass, which blurs only the sky; objects behind it look sharp");
}

/// Warns of geometry outside the view of a camera that frames the scene.
void warn_of_stray_geometry(Scene& scene) {
  if (!scene.cameras.empty()) return;
  const uint64_t count = find_main_part(scene).stray_count;
  if (count == 0) return;
  scene.warnings.push_back((count == 1 ? "1 primitive lies" : std::to_string(count) + " primitives lie") +
                           " far from nearly all of the surface: the camera that frames the scene leaves " +
                           (count == 1 ? "it" : "them") + " out");
}

/// Converts names that are not UTF-8, because JSON, EXR files and Python need UTF-8.
void show_names_in_utf8(Scene& scene) {
  const auto show = [](auto& parts) {
    for (auto& part : parts) part.name = to_utf8(part.name);
  };
  show(scene.objects);
  show(scene.materials);
  show(scene.lights);
  show(scene.cameras);
}

constexpr SceneFormat kFormats[] = {{".gltf", load_gltf, true},      {".glb", load_gltf, true},
                                    {".obj", load_obj, false, true}, {".ply", load_ply, false, true},
                                    {".stl", load_stl, false, true}, {".nff", load_nff}};

const SceneFormat* find_by_ending(const std::filesystem::path& file) {
  const auto* const found = std::ranges::find(kFormats, lower_case_ending(file), &SceneFormat::ending);
  return found == std::end(kFormats) ? nullptr : found;
}

std::string name_endings() {
  std::string known;
  for (const SceneFormat& format : kFormats) known.append(known.empty() ? "" : ", ").append(format.ending);
  return "a file with one of the extensions " + known;
}

/// Throws InputError if the path is a folder. The message names the first scenes in the folder.
void refuse_folder(const std::filesystem::path& file) {
  constexpr size_t kMostNamed = 2;
  std::error_code error;
  if (!is_directory(file, error)) return;
  std::set<std::string> scenes;
  for (std::filesystem::directory_iterator each(file, error), end; !error && each != end; each.increment(error)) {
    if (find_by_ending(each->path()) != nullptr) scenes.insert(each->path().filename().string());
    if (scenes.size() > kMostNamed) scenes.erase(std::prev(scenes.end()));
  }
  std::string names;
  for (const std::string& name : scenes) names.append(names.empty() ? "it contains " : " and ").append(name);
  throw InputError({"file.folder", "the scene is a folder, not a file", file.string(),
                    names.empty() ? "use " + name_endings() : names + "; give a file"});
}

const SceneFormat& find_format(const std::filesystem::path& file) {
  refuse_folder(file);
  if (const SceneFormat* const format = find_by_ending(file)) return *format;
  const std::string ending = lower_case_ending(file);
  const std::string what = "the scene format " + quote(ending) + " is unknown";
  const FileKind kind = find_file_kind(file);
  if (kind.name.empty() && is_writable_format(file)) {
    throw InputError({"scene.file.picture", "a " + ending + " file is a picture, not a scene", file.string(),
                      "use " + name_endings()});
  }
  if (kind.name.empty()) throw InputError({"scene.file.format", what, file.string(), "use " + name_endings()});
  throw InputError({"scene.file.extension", what + ", and the file is " + kind.name, file.string(), kind.cure});
}

/// Throws InputError if the first bytes of a file that cannot be loaded show that its extension is wrong.
void refuse_wrong_ending(const std::filesystem::path& file, const SceneFormat& format) {
  const FileKind kind = find_file_kind(file);
  const auto has_ending = [&](const SceneFormat& other) { return kind.ending == other.ending; };
  const auto* const own = std::ranges::find_if(kFormats, has_ending);
  const bool is_right = own != std::end(kFormats) && own->load == format.load;
  if (kind.name.empty() || is_right) return;
  throw InputError({"scene.file.extension", "the file is " + kind.name, file.string(), kind.cure});
}

/// Checks that there is something to draw, because an empty picture could be mistaken for a picture of the scene.
/// Throws InputError if a mesh has nothing to draw, or if a scene cannot draw any of its visible parts. A scene without
/// visible parts gets a warning.
void check_geometry(const SceneFormat& format, const LoadReport& report, Scene& scene) {
  if (has_anything_to_draw(scene)) return;
  refuse_wrong_ending(report.file(), format);
  const std::string what(kNothingToDraw);
  if (!format.is_mesh && !report.has_lost_geometry()) return scene.warnings.push_back(what);
  const std::string reason = scene.warnings.empty() ? "" : " (" + scene.warnings.front() + ")";
  throw InputError({"scene.geometry.none", what + reason, report.file().string(), "export it with triangles"});
}

void check_root(const std::filesystem::path& root) {
  std::error_code error;
  if (root.empty() || is_directory(root, error)) return;
  throw UsageError(
      {"scene.root.folder", "the path of --root is not a folder", root.string(), "give an existing folder"});
}

Scene load_by_format(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report) {
  const SceneFormat& format = find_format(file);
  check_root(options.root);
  if (!options.material_variant.empty() && !format.has_variants) {
    throw UsageError({"scene.variant.unknown",
                      "files with the extension " + std::string(format.ending) + " have no material variants",
                      file.string(), "remove the variant"});
  }
  // The program could wait forever for the data of a pipe, so pipes are refused.
  if (!is_regular_file(find_input(file))) {
    throw InputError({"file.kind", "the scene is not a regular file", file.string(), "give the scene's file"});
  }
  try {
    Scene scene = format.load(options, report);
    scene.center = report.center();
    check_geometry(format, report, scene);
    return scene;
  } catch (const InputError&) {
    refuse_wrong_ending(file, format);
    throw;
  }
}

/// The largest number of times that a file is read again. Each time, fp32 coordinates near the new center can be up to
/// 2^24 times as fine.
constexpr int kMostMoves = 3;

/// Reads a file, and reads it again around a center if its coordinates are too coarse in fp32. Adds the warnings that
/// depend on bounds.
Scene load_near_center(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report) {
  Scene scene = load_by_format(file, options, report);
  VertexBounds bounds = bounds_of_vertices(scene);
  for (int i = 0; i < kMostMoves && is_too_coarse(bounds.all); ++i) {
    scene = {};
    report = LoadReport(file, options.is_strict, options.root, report.center() + round_middle(bounds.all));
    report.add_source(file);
    scene = load_by_format(file, options, report);
    bounds = bounds_of_vertices(scene);
  }
  warn_of_coarse_coordinates(bounds, report.has_rounded_coordinates(), scene);
  warn_of_tiny_meshes(bounds, scene);
  return scene;
}

}  // namespace

void check_scene_name(const std::filesystem::path& file) {
  find_format(file);
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  std::vector<SourceFile> sources;
  return load_scene(file, options, sources);
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options, std::vector<SourceFile>& sources) {
  LoadReport report(file, options.is_strict, options.root);
  report.add_source(file);
  try {
    Scene scene = load_near_center(file, options, report);
    sources = report.sources();
    warn_of_turned_normals(scene);
    warn_of_rough_glass(scene);
    warn_of_stray_geometry(scene);
    show_names_in_utf8(scene);
    return scene;
  } catch (...) {
    sources = report.sources();
    throw;
  }
}

}  // namespace promin
