// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/load_scene.h"

#include <algorithm>
#include <string>

#include "core/file.h"
#include "core/rounding.h"
#include "core/utf8.h"
#include "formats/far_scene.h"
#include "formats/gltf/load_gltf.h"
#include "formats/load_report.h"
#include "formats/nff/load_nff.h"
#include "formats/obj/load_obj.h"
#include "formats/ply/load_ply.h"
#include "formats/source_file.h"
#include "formats/stl/load_stl.h"
#include "promin/error.h"

namespace promin {
namespace {

struct SceneFormat {
  const char* ending;
  Scene (*load)(const LoadOptions&, LoadReport&);
  bool has_variants = false;
};

bool has_anything_to_draw(const Scene& scene) {
  return std::any_of(scene.objects.begin(), scene.objects.end(),
                     [&](const Object& object) { return primitive_count(scene, object) > 0; });
}

/// A triangle's area in the sheared plane must be a normal float (shaders/primitives/triangle.glsl).
constexpr float kSmallestMesh = 1e-18F;

/// Warns of meshes that are not refused for their size, but are too small to be hit.
void warn_of_tiny_meshes(Scene& scene) {
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (primitive_count(scene, object) == 0) continue;
    const auto* mesh = std::get_if<Mesh>(&scene.geometries[object.geometry]);
    if (mesh == nullptr) continue;
    Bounds bounds;
    for (const vec3& position : mesh->positions) bounds.extend(vec3(object.world_from_object * dvec4(position, 1.0)));
    if (max_component(bounds.extent()) >= kSmallestMesh) continue;
    scene.warnings.push_back("object " + std::to_string(i) + " is smaller than 1e-18: fp32 cannot show its triangles");
  }
}

/// What else goes into JSON, EXR files and Python.
void show_names_in_utf8(Scene& scene) {
  const auto show = [](auto& parts) {
    for (auto& part : parts) part.name = to_utf8(part.name);
  };
  show(scene.objects);
  show(scene.materials);
  show(scene.lights);
  show(scene.cameras);
}

constexpr SceneFormat kFormats[] = {{".gltf", load_gltf, true}, {".glb", load_gltf, true}, {".obj", load_obj},
                                    {".ply", load_ply},         {".stl", load_stl},        {".nff", load_nff}};

const SceneFormat& find_format(const std::filesystem::path& file) {
  const std::string ending = lower_case_ending(file);
  std::string known;
  for (const SceneFormat& format : kFormats) {
    if (ending == format.ending) return format;
    known += known.empty() ? format.ending : std::string(", ") + format.ending;
  }
  throw InputError({"unknown scene format " + quote(ending), file.string(), "use a file that ends in " + known});
}

Scene load_by_format(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report) {
  const SceneFormat& format = find_format(file);
  if (!options.material_variant.empty() && !format.has_variants) {
    throw UsageError({std::string("files that end in ") + format.ending + " have no variants of materials",
                      file.string(), "ask for none"});
  }
  // A pipe might be waited for without end. A folder is refused where it is read.
  const std::filesystem::file_status status = find_input(file);
  if (!is_regular_file(status) && !is_directory(status)) {
    throw InputError({"not a regular file", file.string(), "name the scene's file"});
  }
  Scene scene = format.load(options, report);
  scene.center = report.center();
  return scene;
}

/// Each time that a file is read again, fp32 resolves what lies around its center 2^24 times as finely.
constexpr int kMostMoves = 3;

/// Reads a file, and again around a center where its coordinates are too coarse in fp32.
Scene load_near_center(const std::filesystem::path& file, const LoadOptions& options, LoadReport& report) {
  Scene scene = load_by_format(file, options, report);
  for (int i = 0; i < kMostMoves; ++i) {
    const Bounds bounds = bounds_of_vertices(scene);
    if (!is_too_coarse(bounds)) break;
    scene = {};
    report = LoadReport(file, options.is_strict, report.center() + round_middle(bounds));
    report.add_source(file);
    scene = load_by_format(file, options, report);
  }
  warn_of_coarse_coordinates(report.has_rounded_coordinates(), scene);
  return scene;
}

}  // namespace

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  std::vector<SourceFile> sources;
  return load_scene(file, options, sources);
}

Scene load_scene(const std::filesystem::path& file, const LoadOptions& options, std::vector<SourceFile>& sources) {
  LoadReport report(file, options.is_strict);
  report.add_source(file);
  try {
    Scene scene = load_near_center(file, options, report);
    sources = report.sources();
    warn_of_tiny_meshes(scene);
    show_names_in_utf8(scene);
    if (!has_anything_to_draw(scene)) scene.warnings.push_back("the scene holds nothing to draw");
    return scene;
  } catch (...) {
    sources = report.sources();
    throw;
  }
}

}  // namespace promin
