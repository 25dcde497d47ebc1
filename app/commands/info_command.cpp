// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "commands/info_command.h"

#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "core/count_of.h"
#include "device_scene/pack_scene.h"
#include "device_scene/pack_shading.h"
#include "environment/pack_sky.h"
#include "options/load_options.h"
#include "options/render_options.h"
#include "output/console.h"
#include "output/message_of.h"
#include "output/rows.h"
#include "output/scene_json.h"
#include "promin/load_scene.h"
#include "promin/motion.h"
#include "scene/features.h"
#include "scene/upright.h"
#include "textures/pack_images.h"
#include "work/pictures/load_posed.h"
#include "work/pictures/scene_counts.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"
#include "work/spec/check_spec.h"
#include "work/spec/environment_choice.h"

namespace promin::app {
namespace {

std::string describe_objects(const SceneCounts& counts, const Scene& scene) {
  std::vector<std::string> kinds;
  for (size_t i = 0; i < counts.objects.size(); ++i) {
    std::string name(kObjectNames[i]);
    std::replace(name.begin(), name.end(), '_', ' ');
    if (counts.objects[i] > 0) kinds.push_back(fmt::format("{}: {}", name, counts.objects[i]));
  }
  if (kinds.empty()) return "0";
  return fmt::format("{} ({})", scene.objects.size(), fmt::join(kinds, ", "));
}

std::string count_lights(const std::vector<Light>& lights) {
  if (lights.empty()) return "0";
  std::vector<std::string> kinds;
#define PROMIN_LIGHT(KIND, ENUMERATOR, PREFIX, NUMBER, FEATURE, BIT, NAME)                     \
  if (LightKind::ENUMERATOR != LightKind::kHeadlight) {                                        \
    const auto is_it = [](const Light& light) { return light.kind == LightKind::ENUMERATOR; }; \
    kinds.push_back(fmt::format("{}: {}", #PREFIX, std::ranges::count_if(lights, is_it)));     \
  }
#include "promin/kinds/lights.def"
  return fmt::format("{} ({})", lights.size(), fmt::join(kinds, ", "));
}

std::string describe_background(const Environment& environment, const AssumedLight& assumed) {
  if (environment.shows_sky) return "the sky";
  const auto words_of = [](const vec3& color) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", color.r, color.g, color.b);
  };
  if (!environment.backdrop) return words_of(environment.background);
  const Backdrop& backdrop = *environment.backdrop;
  return fmt::format("{} above to {} below, as shown{}", words_of(backdrop.top), words_of(backdrop.bottom),
                     assumed.has_background ? " (assumed)" : "");
}

std::string describe_display(const DisplayTransform& display) {
  return fmt::format("exposure {:+g} EV, tone mapping {}", display.exposure_ev,
                     tone_mapping_names()[static_cast<size_t>(display.tone_mapping)]);
}

/// Returns a place in the scene in world coordinates.
std::string describe_place(const vec3& place, const dvec3& center, int digits) {
  const dvec3 world = center + dvec3(place);
  // Far from the origin the default number of digits would not be enough.
  if (center != dvec3(0.0)) digits = 12;
  return fmt::format("{:.{}g} {:.{}g} {:.{}g}", world.x, digits, world.y, digits, world.z, digits);
}

std::string describe_camera(size_t index, const Camera& camera, const dvec3& center) {
  std::string text = fmt::format("{} {}", index, camera.name.empty() ? "(no name)" : camera.name);
  if (camera.projection == Projection::kPerspective) {
    text += fmt::format(", perspective, vertical field of view {:.4g} degrees", glm::degrees(camera.yfov));
  } else {
    text += fmt::format(", orthographic, {:.4g} units high", 2.0F * camera.ymag);
  }
  if (camera.resolution != uvec2(0)) text += fmt::format(", {}x{}", camera.resolution.x, camera.resolution.y);
  if (camera.aspect_ratio > 0.0F) text += fmt::format(", aspect ratio {:.4g}", camera.aspect_ratio);
  text += fmt::format(", near {:.4g}, eye {}", camera.near, describe_place(camera.eye, center, 4));
  return text;
}

std::vector<std::string> describe_cameras(const Scene& scene) {
  if (scene.cameras.empty()) return {"0; assumed: " + describe_framing(scene, {})};
  std::vector<std::string> rows;
  for (size_t i = 0; i < scene.cameras.size(); ++i) {
    rows.push_back(describe_camera(i, scene.cameras[i], scene.center));
  }
  return rows;
}

struct SkyDescription {
  std::string operator()(std::monostate) const { return "none"; }
  std::string operator()(const Studio&) const { return "studio"; }
  std::string operator()(const GradientSky&) const { return "gradient"; }
  std::string operator()(const Panorama& panorama) const {
    return fmt::format("panorama of {}x{}", panorama.image->size.x, panorama.image->size.y);
  }
};

std::string describe_sky(const Environment& environment) {
  std::string text = std::visit(SkyDescription(), environment.sky);
  if (!environment.has_sky()) return text;
  if (environment.up != kUsualUp) {
    text += fmt::format(", up is {:.4g} {:.4g} {:.4g}", environment.up.x, environment.up.y, environment.up.z);
  }
  if (environment.rotation != 0.0F) {
    text += fmt::format(", turned by {:.4g} degrees", glm::degrees(environment.rotation));
  }
  if (environment.intensity != 1.0F) text += fmt::format(", times {:.4g}", environment.intensity);
  return text;
}

std::string describe_bounds(const Bounds& bounds, const dvec3& center) {
  if (bounds.is_empty()) return "nothing finite";
  return describe_place(bounds.lo, center, 6) + " to " + describe_place(bounds.hi, center, 6);
}

/// Returns the file's extensions, grouped by whether promin uses them.
std::vector<std::string> describe_extensions(const Scene& scene) {
  std::vector<std::string> rows;
  for (const bool is_used : {true, false}) {
    std::vector<std::string> names;
    for (const FileExtension& extension : scene.extensions) {
      if (extension.is_used == is_used) names.push_back(extension.name + (extension.is_required ? " (required)" : ""));
    }
    if (!names.empty()) rows.push_back(fmt::format("{}: {}", is_used ? "used" : "ignored", fmt::join(names, ", ")));
  }
  return rows.empty() ? std::vector<std::string>{"none"} : rows;
}

/// Returns the sizes of images with the number of images of each size, the largest first.
std::vector<std::string> describe_image_sizes(const Scene& scene) {
  std::map<std::pair<uint64_t, uint32_t>, size_t, std::greater<>> counts;
  for (const auto& image : scene.images) ++counts[{uint64_t{image->size.x} * image->size.y, image->size.x}];
  std::vector<std::string> sizes;
  for (const auto& [key, count] : counts) {
    const auto [area, width] = key;
    sizes.push_back(area == 0 ? fmt::format("{} absent", count)
                              : fmt::format("{} of {}x{}", count, width, area / width));
  }
  return sizes;
}

std::string describe_textures(const Scene& scene, uint64_t image_bytes) {
  if (scene.textures.empty()) return "0";
  return fmt::format("{} of {} images ({}), {:.3f} MB on the device{}", scene.textures.size(), scene.images.size(),
                     fmt::join(describe_image_sizes(scene), ", "), 1e-6 * static_cast<double>(image_bytes),
                     image_bytes > kDefaultTextureBytes ? ", more than --texture-memory leaves them by default" : "");
}

/// Returns the properties that an animation changes, with the number of channels of each.
std::string describe_channels(const Animation& animation) {
  std::map<AnimatedProperty, size_t> counts;
  for (const AnimationChannel& channel : animation.channels) ++counts[channel.property];
  std::vector<std::string> properties;
  for (const auto& [property, count] : counts) properties.push_back(fmt::format("{}: {}", name_of(property), count));
  return fmt::format("{}{}", count_of(animation.channels.size(), "channel"),
                     properties.empty() ? "" : fmt::format(" ({})", fmt::join(properties, ", ")));
}

std::vector<std::string> describe_animations(const Motion& motion) {
  std::vector<std::string> rows;
  for (size_t i = 0; i < motion.animations.size(); ++i) {
    const Animation& animation = motion.animations[i];
    rows.push_back(fmt::format("{} {}, {:.6g} s, {}{}", i, animation.name.empty() ? "(no name)" : animation.name,
                               animation.duration_s, describe_channels(animation),
                               animation.problems.empty() ? "" : ", cannot be shown"));
  }
  return rows;
}

/// Prints the skins, morph targets and animations of a file that has them.
void print_motion(const Scene& scene) {
  if (scene.motion == nullptr) return;
  const Motion& motion = *scene.motion;
  size_t joint_count = 0;
  for (const Skin& skin : motion.skins) joint_count += skin.joints.size();
  if (!motion.skins.empty())
    print_row("skins", fmt::format("{} ({})", motion.skins.size(), count_of(joint_count, "joint")));
  const MorphCounts morphs = count_morphs(motion);
  if (morphs.nodes > 0) print_row("targets", fmt::format("{} (nodes: {})", morphs.targets, morphs.nodes));
  if (!motion.animations.empty()) print_rows("animations", describe_animations(motion));
}

struct InfoOptions {
  std::filesystem::path file;
  LoadOptions load;
  MotionOptions motion;
  EnvironmentOptions environment;
  /// True if images are not decoded.
  bool skips_texels = false;
  bool is_json = false;
};

/// Adds the warnings of `promin render` that depend on the whole scene and that the loader does not give.
void add_warnings_of_pictures(Scene& scene, const EnvironmentChoice& surroundings) {
  for (const std::string& warning : surroundings.warnings()) scene.warnings.push_back(warning);
  const std::optional<Problem> halved = warn_of(fit_images(scene.images, scene.textures, kDefaultTextureBytes));
  if (halved) scene.warnings.push_back(message_of(*halved));
  if (scene.cameras.empty() || default_size(scene.cameras.front())) return;
  scene.warnings.push_back(
      fmt::format("the camera's aspect ratio of {} is too extreme to compute the width of the picture; give --size",
                  scene.cameras.front().aspect_ratio));
}

/// A scene as `promin render` renders it, with added lights.
struct LitScene {
  AssumedLight assumed;
  Integrator integrator;
  DisplayTransform display;
  FeatureMask features;
  /// The packed scene, without texels.
  PackedScene packed;
};

LitScene light_and_pack(Scene& scene, const EnvironmentChoice& surroundings) {
  surroundings.replace_sky(scene);
  LookOptions look;
  const Integrator integrator = usual_integrator(scene, look.light);
  settle_light(scene, integrator, look);
  LitScene lit{.assumed = light_up(scene, look, surroundings),
               .integrator = integrator,
               .display = choose_display(scene, look, DebugView::kNone),
               .features = {},
               .packed = {}};
  world::Scene flat = world::flatten(scene, world::Purpose::kPictures, Instancing::kAuto);
  for (auto& image : flat.images) {
    image = std::make_shared<const TextureImage>(TextureImage{image->name, image->size, {}, image->use});
  }
  lit.features = features_of(flat);
  lit.packed = pack_scene(std::move(flat), builder_names().front());
  for (const Problem& warning : lit.packed.warnings) scene.warnings.push_back(message_of(warning));
  return lit;
}

void print_scene_json(Scene scene, const EnvironmentChoice& surroundings) {
  nlohmann::json json = json_of(scene);
  const LitScene lit = light_and_pack(scene, surroundings);
  json["counts"]["degenerate_triangles"] = lit.packed.degenerate_count;
  json["environment"] = json_of(scene.environment);
  json["display"] = json_of(lit.display);
  json["assumed"] = list_assumptions(scene, {}, lit.assumed, lit.integrator, lit.display);
  json["counts"]["instances"] = lit.packed.instance_count;
  json["features"] = feature_names(lit.features);
  json["warnings"] = scene.warnings;
  fmt::print("{}", write_json(json));
}

/// Returns the number of materials and the names of the first ones.
std::string describe_materials(const Scene& scene) {
  constexpr size_t kMostNames = 12;
  std::vector<std::string> names;
  for (const Material& material : scene.materials) {
    if (!material.name.empty()) names.push_back(material.name);
  }
  std::string text = std::to_string(scene.materials.size());
  if (names.empty()) return text;
  const bool is_cut = names.size() > kMostNames;
  names.resize(std::min(names.size(), kMostNames));
  return fmt::format("{} ({}{})", text, fmt::join(names, ", "), is_cut ? ", ..." : "");
}

std::string describe_triangles(const SceneCounts& counts, uint64_t degenerate_count) {
  std::string text = fmt::format("{} (degenerate: {}", counts.triangles, degenerate_count);
  if (counts.stored_triangles != counts.triangles) text += fmt::format("; stored: {}", counts.stored_triangles);
  return text + ")";
}

std::string describe_instances(const PackedScene& packed) {
  return fmt::format("{} of meshes with {}", packed.instance_count, count_of(packed.shared_triangle_count, "triangle"));
}

void print_table(Scene scene, const std::filesystem::path& file, const EnvironmentChoice& surroundings) {
  const SceneCounts counts = count_scene(scene);
  const uint64_t image_bytes = packed_image_bytes(scene.images, scene.textures);
  std::string lights = count_lights(scene.lights);
  const LitScene lit = light_and_pack(scene, surroundings);
  if (const std::string light = describe_light(lit.assumed); !light.empty()) lights.append("; assumed: ").append(light);
  const PackedScene& packed = lit.packed;
  print_row("scene", file.string());
  print_row("objects", describe_objects(counts, scene));
  print_row("primitives", std::to_string(counts.primitives));
  print_row("triangles", describe_triangles(counts, packed.degenerate_count));
  if (packed.instance_count > 0) print_row("instances", describe_instances(packed));
  print_row("materials", describe_materials(scene));
  print_row("textures", describe_textures(scene, image_bytes));
  if (!scene.variants.empty()) print_rows("variants", scene.variants);
  print_row("lights", lights);
  print_row("background", describe_background(scene.environment, lit.assumed));
  print_row("sky", describe_sky(scene.environment));
  print_row("display", describe_display(lit.display));
  print_rows("cameras", describe_cameras(scene));
  print_motion(scene);
  print_row("bounds", describe_bounds(bounds_of(scene), scene.center));
  if (scene.center != dvec3(0.0)) print_row("center", describe_place(vec3(0.0F), scene.center, 6));
  print_row("features", fmt::format("{}", fmt::join(feature_names(lit.features), ", ")));
  print_row("BVH", fmt::format("{} nodes by {}, depth {}, SAH cost {:.4g}", packed.bvh.nodes, packed.bvh.builder,
                               packed.bvh.depth, packed.bvh.sah_cost));
  const uint64_t shading_bytes = scene.materials.size() * sizeof(layout::MaterialRecord) +
                                 pack_lights(scene.lights).records.size() * sizeof(layout::LightRecord) +
                                 packed_sky_bytes(scene.environment) + image_bytes;
  print_row("memory", fmt::format("{:.3f} MB of geometry on the host, {:.3f} MB on the device",
                                  1e-6 * static_cast<double>(counts.geometry_bytes),
                                  1e-6 * static_cast<double>(packed.size_bytes() + shading_bytes)));
  print_rows("extensions", describe_extensions(scene));
  print_rows("warnings", scene.warnings.empty() ? std::vector<std::string>{"none"} : scene.warnings);
}

void print_info(const InfoOptions& options) {
  LoadOptions load = options.load;
  load.decodes_images = !options.skips_texels;
  check_motion_options(options.motion);
  std::vector<SourceFile> sources;
  Scene scene = load_posed(options.file, load, options.motion, sources);
  const EnvironmentChoice surroundings(options.environment);
  add_warnings_of_pictures(scene, surroundings);
  if (options.is_json) {
    print_scene_json(std::move(scene), surroundings);
  } else {
    print_table(std::move(scene), options.file, surroundings);
  }
}

}  // namespace

Command add_info_command(CLI::App& program) {
  CLI::App& command =
      add_command(program, "info", "Print the contents of a scene and say which of them promin renders");
  const auto options = std::make_shared<InfoOptions>();
  OptionTable table(command);
  table.add_required("SCENE", "", "Scene file: .gltf, .glb, .obj, .ply, .stl or .nff",
                     [options](const OptionValues& w) { options->file = w.text(); });
  add_strict_option(table, options->load);
  add_root_option(table, options->load);
  add_motion_options(table, options->motion);
  add_variant_option(table, options->load);
  add_environment_options(table, options->environment);
  table.add_flag("--json", "Print JSON (docs/usage.md, \"Scenes as JSON\")", options->is_json);
  table.add_flag("--no-texels", "Read only the sizes of images. This is faster but does not find damaged images",
                 options->skips_texels);
  return {&command, [options] { print_info(*options); }};
}

}  // namespace promin::app
