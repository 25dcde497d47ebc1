// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <limits>

#include "bvh/builder.h"
#include "bvh/bvh_file.h"
#include "core/file.h"
#include "core/parallel.h"
#include "device_scene/collect_primitives.h"
#include "device_scene/pack_scene.h"
#include "environment/read_panorama.h"
#include "messages/message_cases.h"
#include "promin/compare.h"
#include "promin/framing.h"
#include "promin/image.h"
#include "promin/motion.h"
#include "promin/motion_vectors.h"
#include "promin/validate.h"
#include "rays/npy.h"
#include "scene/copies.h"
#include "scene/world_scene.h"
#include "support/bvh_bytes.h"
#include "support/valid_scene.h"
#include "textures/pack_images.h"
#include "trace/kernels/cut_loops.h"

namespace promin {
namespace {

const float kNan = std::nanf("");

MessageCase spoil(std::string_view code, const std::function<void(Scene& scene)>& fault) {
  return {code, [=] {
            Scene scene = make_valid_scene();
            fault(scene);
            throw_if_invalid(scene);
          }};
}

/// Poses a scene of one node, which an animation moves, with a fault of its motion or of the choice of the pose.
MessageCase spoil_motion(std::string_view code, const std::function<void(Motion& motion, PoseChoice& choice)>& fault) {
  return {code, [=] {
            Scene scene;
            Mesh board;
            board.positions = {vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)};
            board.triangles = {{0, 1, 2}};
            scene.add("board", std::move(board));
            scene.materials.resize(1);
            Motion motion;
            motion.nodes.resize(1);
            motion.objects.push_back({.node = 0, .geometry = 0});
            Animation& animation = motion.animations.emplace_back();
            animation.samplers.push_back({Interpolation::kLinear, {0.0, 1.0}, {0, 0, 0, 1, 1, 1}});
            animation.channels.emplace_back();
            PoseChoice choice{.animations = {0}, .time_s = 0.5};
            fault(motion, choice);
            scene.motion = std::make_shared<const Motion>(std::move(motion));
            static_cast<void>(scene_at(std::move(scene), choice));
          }};
}

std::vector<MessageCase> cases_of_motion() {
  return {
      {"motion.scene.none", [] { static_cast<void>(pose_of(Scene{})); }},
      {"motion.aovs",
       [] {
         Aovs aovs;
         add_motion(Scene{}, View{}, Scene{}, Camera{}, aovs);
       }},
      {"motion.next.other",
       [] {
         AovSet set;
         set.position = set.object = set.primitive = true;
         View view;
         view.size = uvec2(1);
         Aovs aovs;
         aovs.resize(1, set);
         aovs.object[0] = 0;
         add_motion(Scene{}, view, Scene{}, Camera{}, aovs);
       }},
      spoil_motion("motion.reference.range", [](auto& motion, auto&) { motion.objects[0].node = 7; }),
      spoil_motion("motion.reference.range", [](auto& motion, auto&) { motion.nodes[0].same_as = 0; }),
      spoil_motion("motion.reference.range", [](auto& motion, auto&) { motion.meshes.resize(1); }),
      spoil_motion("motion.count.wrong",
                   [](auto& motion, auto&) { motion.animations[0].samplers[0].values.pop_back(); }),
      spoil_motion("motion.keys.order",
                   [](auto& motion, auto&) {
                     motion.animations[0].samplers[0].times = {1, 1};
                   }),
      spoil_motion("motion.node.cycle", [](auto& motion, auto&) { motion.nodes[0].parent = 0; }),
      spoil_motion("motion.animation.missing", [](auto&, auto& choice) { choice.animations = {3}; }),
      spoil_motion("motion.time.range", [](auto&, auto& choice) { choice.time_s = static_cast<double>(kNan); }),
      spoil_motion("motion.position.far", [](auto& motion, auto&) { motion.nodes[0].trs.scale = dvec3(1e20); }),
      spoil_motion(
          "motion.node.far",
          [](auto& motion, auto&) { motion.nodes[0].matrix = dmat4(std::numeric_limits<double>::infinity()); }),
      spoil_motion("motion.reference.range",
                   [](auto& motion, auto&) {
                     auto mesh = std::make_shared<DeformingMesh>();
                     mesh->base.positions.resize(1);
                     mesh->influences = {.per_vertex = 1, .joints = {4}, .weights = {1.0F}};
                     motion.meshes = {mesh};
                     motion.skins.push_back({.name = {}, .joints = {0}, .inverse_bind = {}});
                     motion.objects[0].mesh = motion.objects[0].skin = 0;
                   }),
  };
}

MessageCase spoil_view(std::string_view code, const std::function<void(View& view)>& fault) {
  return {code, [=] {
            View view;
            fault(view);
            throw UsageError(validate(view));
          }};
}

Mesh& mesh_of(Scene& scene) {
  return std::get<Mesh>(scene.geometries[0]);
}

MetallicRoughness& metal_of(Scene& scene) {
  return std::get<MetallicRoughness>(scene.materials[1].model);
}

void add_image(Scene& scene, const TextureImage& image) {
  scene.images.push_back(std::make_shared<const TextureImage>(image));
}

std::shared_ptr<const Image> make_picture(const uvec2& size, size_t pixels, const vec3& pixel) {
  return std::make_shared<const Image>(Image{size, std::vector<vec3>(pixels, pixel)});
}

std::vector<MessageCase> cases_of_scenes() {
  return {
      spoil("scene.color.range", [](Scene& s) { s.materials[0].phong().ambient.r = -1; }),
      spoil("scene.color.range", [](Scene& s) { mesh_of(s).colors[2].r = -1; }),
      spoil("scene.weight.range", [](Scene& s) { metal_of(s).roughness = 2; }),
      spoil("scene.number.range", [](Scene& s) { metal_of(s).ior = -1; }),
      spoil("scene.number.range", [](Scene& s) { s.environment.intensity = -1; }),
      spoil("scene.environment.up", [](Scene& s) { s.environment.up = vec3(0, 0, 2); }),
      spoil("scene.texture.set",
            [](Scene& s) {
              add_image(s, {});
              s.textures.resize(1);
              s.materials[0].phong().normal_texture.texture = 0;
              s.materials[0].phong().normal_texture.uv_set = 2;
            }),
      spoil("scene.texture.transform",
            [](Scene& s) {
              add_image(s, {});
              s.textures.resize(1);
              s.materials[0].phong().normal_texture.texture = 0;
              s.materials[0].phong().normal_texture.to_u.x = kNan;
            }),
      spoil("scene.choice.unknown", [](Scene& s) { s.lights[0].kind = static_cast<LightKind>(99); }),
      spoil("scene.image.missing", [](Scene& s) { s.images.resize(1); }),
      spoil("scene.image.size",
            [](Scene& s) { add_image(s, {.name = {}, .size = uvec2(kMaxTextureSide + 1, 1), .texels = {0}}); }),
      spoil("scene.image.texels", [](Scene& s) { add_image(s, {.name = {}, .size = uvec2(2, 2), .texels = {0}}); }),
      spoil("scene.reference.range", [](Scene& s) { s.objects[1].geometry = 77; }),
      spoil("scene.reference.range", [](Scene& s) { mesh_of(s).triangles[0].z = 3; }),
      spoil("scene.position.range", [](Scene& s) { mesh_of(s).positions[1].y = kNan; }),
      spoil("scene.position.far", [](Scene& s) { s.objects[0].world_from_object[3][0] = 2e15; }),
      spoil("scene.light.direction", [](Scene& s) { s.lights[0].direction = vec3(0, 0, 2); }),
      spoil("scene.light.range", [](Scene& s) { s.lights[0].range = kNan; }),
      spoil("scene.light.cone", [](Scene& s) { s.lights[0].inner_cone_angle = 1; }),
      spoil("scene.light.size", [](Scene& s) { s.lights[0].radius = -1; }),
      spoil("scene.light.size", [](Scene& s) { s.lights[0].angle = 4; }),
      spoil("scene.panorama.missing", [](Scene& s) { s.environment.sky = Panorama(); }),
      spoil("scene.panorama.size",
            [](Scene& s) {
              s.environment.sky = Panorama{make_picture({2, 2}, 1, vec3(0))};
            }),
      spoil("scene.panorama.pixel",
            [](Scene& s) {
              s.environment.sky = Panorama{make_picture({2, 1}, 2, vec3(0, -1, 0))};
            }),
      spoil("scene.camera.eye", [](Scene& s) { s.cameras[0].eye.x = 2e15F; }),
      spoil("scene.camera.resolution", [](Scene& s) { s.cameras[0].resolution = uvec2(512, 0); }),
      spoil("scene.camera.basis", [](Scene& s) { s.cameras[0].up = vec3(0, 0, 1); }),
      spoil("scene.camera.range", [](Scene& s) { s.cameras[0].yfov = 4; }),
      spoil("scene.camera.lens", [](Scene& s) { s.cameras[0].aperture_radius = -1; }),
      spoil("scene.camera.lens", [](Scene& s) { s.cameras[0].aperture_radius = 1; }),
      spoil("scene.transform.range", [](Scene& s) { s.objects[1].world_from_object[3][0] = kNan; }),
      spoil("scene.transform.affine", [](Scene& s) { s.objects[1].world_from_object[0][3] = 1; }),
      spoil("scene.transform.singular", [](Scene& s) { s.objects[0].world_from_object[2] = dvec4(0); }),
      spoil("scene.shape.distorted", [](Scene& s) { s.objects[1].world_from_object[2][2] = 2; }),
      spoil("scene.shape.size", [](Scene& s) { std::get<Sphere>(s.geometries[1]).radius = 0; }),
      spoil("scene.normal.range", [](Scene& s) { mesh_of(s).normals[1] = vec3(0); }),
      spoil("scene.uv.range", [](Scene& s) { mesh_of(s).uvs.assign(3, vec4(kNan)); }),
      spoil("scene.tangent.range", [](Scene& s) { mesh_of(s).tangents.assign(3, vec4(0)); }),
      spoil("scene.array.count", [](Scene& s) { mesh_of(s).normals.pop_back(); }),
      {"scene.size.limit",
       [] {
         world::Scene scene;
         scene.file = "a.ply";
         check_at_most(1, 2, scene, "the scene has", "primitives");
       }},
      {"scene.size.limit", [] { check_copies({.triangles = 1'200'000'000}, std::nullopt, "a.glb"); }},
      {"scene.memory.short",
       [] { check_copies({.triangles = 120'000'000, .bytes = 14'000'000'000}, 8'000'000'000, "a.glb"); }},
      {"textures.memory.short",
       [] {
         std::vector<std::shared_ptr<const TextureImage>> images(
             3, std::make_shared<const TextureImage>(TextureImage{.name = {}, .size = uvec2(1, 1), .texels = {0}}));
         for (auto& image : images) image = std::make_shared<const TextureImage>(*image);
         static_cast<void>(pack_images(images, {}, 1));
       }},
  };
}

std::vector<MessageCase> cases_of_views() {
  return {
      spoil_view("view.size.range", [](View& v) { v.size.y = 0; }),
      spoil_view("view.size.range", [](View& v) { v.size = uvec2(1U << 30); }),
      spoil_view("view.samples.range", [](View& v) { v.samples_per_pixel = 0; }),
      spoil_view("view.filter.range", [](View& v) { v.filter_width = 0; }),
      spoil_view("view.occlusion.range", [](View& v) { v.occlusion_distance = -1; }),
      spoil_view("view.depth.range", [](View& v) { v.max_depth = kMaxDepth + 1; }),
      spoil_view("view.crop.empty",
                 [](View& v) {
                   v.crop = PixelWindow{{4, 4}, {4, 8}};
                 }),
      spoil_view("view.crop.outside",
                 [](View& v) {
                   v.crop = PixelWindow{{0, 0}, {1281, 8}};
                 }),
      spoil_view("view.target.range", [](View& v) { v.error_target = ErrorTarget{.error = 0}; }),
      spoil_view("view.target.debug",
                 [](View& v) {
                   v.error_target = ErrorTarget{};
                   v.mode.debug_view = static_cast<DebugView>(1);
                 }),
      {"framing.aspect", [] { static_cast<void>(frame_scene(make_valid_scene(), 0.0F)); }},
      {"framing.up", [] { static_cast<void>(frame_scene(make_valid_scene(), 1.0F, {.up = vec3(0)})); }},
      {"framing.fit", [] { static_cast<void>(frame_scene(make_valid_scene(), 1.0F, {.fit = 2.0F})); }},
      {"device.loops.cut", [] { refuse_cut_loops(true); }},
      {"threads.refused", [] { throw RunError(explain_no_threads()); }},
      {"work.cancelled", [] { throw Cancelled(); }},
  };
}

const Image kFlatPicture = {{2, 2}, std::vector<vec3>(4, vec3(0.5F))};

std::vector<MessageCase> cases_of_pictures() {
  return {
      {"picture.empty", [] { write_image("a.exr", {}); }},
      {"picture.empty", [] { static_cast<void>(compare_pictures({}, {})); }},
      {"picture.size",
       [] {
         write_image("a.exr", {{2, 2}, std::vector<vec3>(3)});
       }},
      {"picture.size",
       [] {
         const std::vector<Channel> channels = {{"Z", false, {1}}};
         write_image("a.exr", kFlatPicture, {}, std::nullopt, channels);
       }},
      {"picture.crop",
       [] {
         write_image("a.exr", kFlatPicture, {}, CropPlacement{{1, 1}, {2, 2}});
       }},
      {"output.extension", [] { write_image("a.gif", kFlatPicture); }},
      {"picture.pair.sizes",
       [] {
         static_cast<void>(compare_pictures(kFlatPicture, {{1, 2}, std::vector<vec3>(2)}));
       }},
      {"file.missing", [] { static_cast<void>(read_image("none.exr")); }},
      {"picture.format",
       [] {
         write_case("a.exr", "text");
         static_cast<void>(read_image("a.exr"));
       },
       true},
      {"picture.large",
       [] {
         write_case("a.ppm", "P6 65536 65536 255\n");
         static_cast<void>(read_image("a.ppm"));
       }},
      {"picture.damaged",
       [] {
         Image picture = {{64, 64}, std::vector<vec3>(4096)};
         for (size_t i = 0; i < 4096; ++i) picture.pixels[i] = vec3(std::sin(static_cast<float>(i)));
         write_image("a.exr", picture);
         std::filesystem::resize_file("a.exr", std::filesystem::file_size("a.exr") / 2);
         static_cast<void>(read_image("a.exr"));
       },
       true},
      {"scene.panorama.pixel",
       [] {
         write_image("a.exr", {{2, 1}, std::vector<vec3>(2, vec3(2e15F))});
         std::vector<std::string> warnings;
         static_cast<void>(read_panorama("a.exr", warnings));
       }},
      {"picture.large",
       [] {
         write_image("a.exr", {{16385, 1}, std::vector<vec3>(16385, vec3(1.0F))});
         std::vector<std::string> warnings;
         static_cast<void>(read_panorama("a.exr", warnings));
       }},
  };
}

std::string npy(std::string header, size_t data_bytes) {
  header += '\n';
  return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0' + header +
         std::string(data_bytes, '\0');
}

MessageCase read_rays(std::string_view code, const std::string& bytes) {
  return {code, [=] {
            write_case("rays.npy", bytes);
            const RayReader reader("rays.npy");
          }};
}

std::vector<MessageCase> cases_of_rays() {
  const std::string good = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 8), }";
  return {
      read_rays("rays.kind", "no array"),
      read_rays("rays.header", npy("{'descr': }", 0)),
      read_rays("rays.short", npy(good, 0).substr(0, 30)),
      read_rays("rays.short", npy(good, 32)),
      read_rays("rays.type", npy("{'descr': '<i4', 'fortran_order': False, 'shape': (1, 8), }", 32)),
      read_rays("rays.order", npy("{'descr': '<f4', 'fortran_order': True, 'shape': (1, 8), }", 32)),
      read_rays("rays.shape", npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 6), }", 32)),
      {"file.kind", [] { const RayReader reader("."); }},
      {"bvh.builder.unknown", [] { static_cast<void>(build_bvh("saah", {})); }},
  };
}

/// Reads a BVH file after a change of its bytes, which get the checksum of their content if `is_sealed`.
MessageCase spoil_tree(std::string_view code, const std::function<void(Bytes& bytes)>& fault, bool is_sealed) {
  return {code, [=] {
            const world::Scene scene = world::flatten(make_valid_scene());
            write_bvh_file("a.pbvh", pack_scene(scene, "median").tree());
            Bytes bytes = read_file("a.pbvh");
            fault(bytes);
            if (is_sealed) bytes = sealed(std::move(bytes));
            write_case("a.pbvh", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
            const BvhFile file("a.pbvh");
          }};
}

std::vector<MessageCase> cases_of_trees() {
  return {
      spoil_tree(
          "bvh.file.kind", [](Bytes& b) { b[0] = std::byte{0}; }, false),
      spoil_tree(
          "bvh.file.short", [](Bytes& b) { b.resize(50); }, false),
      spoil_tree(
          "bvh.file.short", [](Bytes& b) { b.push_back(std::byte{0}); }, false),
      spoil_tree(
          "bvh.file.version", [](Bytes& b) { b[kByteOrderPlace] = std::byte{9}; }, true),
      spoil_tree(
          "bvh.file.header", [](Bytes& b) { b[kBuilderPlace] = std::byte{1}; }, true),
      spoil_tree(
          "bvh.file.damaged", [](Bytes& b) { b.back() ^= std::byte{1}; }, false),
      spoil_tree(
          "bvh.file.tree", [](Bytes& b) { b[kPrimitiveCountPlace] = std::byte{255}; }, true),
      {"bvh.file.stale",
       [] {
         write_bvh_file("a.pbvh", pack_scene(world::flatten(make_valid_scene()), "median").tree());
         Scene other = make_valid_scene();
         std::get<Mesh>(other.geometries[0]).positions[0].x = 5;
         static_cast<void>(pack_scene_with("a.pbvh", world::flatten(other)));
       }},
  };
}

}  // namespace

std::vector<MessageCase> cases_of_values() {
  std::vector<MessageCase> all = cases_of_scenes();
  for (const auto& cases :
       {cases_of_views(), cases_of_pictures(), cases_of_rays(), cases_of_trees(), cases_of_motion()}) {
    all.insert(all.end(), cases.begin(), cases.end());
  }
  return all;
}

}  // namespace promin
