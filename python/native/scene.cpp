// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "scene.h"

#include <nanobind/ndarray.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <cstring>
#include <map>
#include <utility>

#include "bind.h"
#include "command_line.h"
#include "matrices.h"
#include "promin/error.h"
#include "promin/framing.h"
#include "promin/instances.h"
#include "promin/lighting.h"
#include "promin/load_scene.h"
#include "promin/motion.h"
#include "promin/validate.h"
#include "records.h"
#include "watched.h"
#include "work/pictures/camera_choice.h"
#include "work/pictures/load_posed.h"
#include "work/pictures/moving_scene.h"
#include "work/pictures/usual_integrator.h"
#include "work/pictures/view_setup.h"
#include "work/spec/check_spec.h"
#include "work/spec/environment_choice.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

template <typename T, int Columns>
using Rows = nb::ndarray<const T, nb::shape<-1, Columns>, nb::c_contig, nb::device::cpu>;

/// Returns the rows of an array; empty if there is no array. The array's shape ensures that its rows have the type Row.
template <typename Row, typename Array>
std::vector<Row> copy_rows(const std::optional<Array>& rows) {
  std::vector<Row> result;
  if (!rows || rows->shape(0) == 0) return result;
  result.resize(rows->shape(0));
  std::memcpy(result.data(), rows->data(), result.size() * sizeof(Row));
  return result;
}

Scene load_model(const std::filesystem::path& file, bool is_strict, const std::string& variant,
                 const std::filesystem::path& root) {
  Scene scene;
  run_watched(nb::none(), [&](const ProgressCallback&) {
    scene = load_scene(file, {.is_strict = is_strict, .root = root, .material_variant = variant});
  });
  return scene;
}

/// Returns the scene in the pose of these animations, by name or number.
Scene pose(const Scene& scene, double time_s, const std::vector<std::string>& animations, bool loops) {
  Scene posed;
  run_watched(nb::none(), [&](const ProgressCallback&) {
    PoseChoice choice = with_keywords([&] {
      const work::MotionOptions options{.animations = animations, .time_s = time_s, .loops = loops};
      work::check_motion_options(options);
      return work::choose_pose(scene, options);
    });
    posed = scene_at(scene, choice);
  });
  return posed;
}

nb::list describe_animations(const Scene& scene) {
  nb::list animations;
  if (scene.motion == nullptr) return animations;
  for (const Animation& animation : scene.motion->animations) {
    std::map<std::string, size_t> channels;
    for (const AnimationChannel& channel : animation.channels) ++channels[std::string(name_of(channel.property))];
    nb::dict counts;
    for (const auto& [property, count] : channels) counts[property.c_str()] = count;
    animations.append(nb::make_tuple(animation.name, animation.duration_s, counts));
  }
  return animations;
}

void add_mesh(Scene& scene, const std::string& name, const std::optional<Rows<float, 3>>& positions,
              const std::optional<Rows<uint32_t, 3>>& triangles, const std::optional<Rows<float, 3>>& normals,
              const std::optional<Rows<float, 4>>& colors, uint32_t material, const Matrix& matrix) {
  Mesh mesh;
  mesh.positions = copy_rows<vec3>(positions);
  mesh.triangles = copy_rows<uvec3>(triangles);
  mesh.normals = copy_rows<vec3>(normals);
  mesh.colors = copy_rows<vec4>(colors);
  scene.add(name, std::move(mesh), material, read_matrix(matrix.data()));
}

void add_shape(Scene& scene, const std::string& name, const std::string& kind, const nb::dict& record,
               uint32_t material, const Matrix& matrix) {
  scene.add(name, read_shape(kind, record), material, read_matrix(matrix.data()));
}

void add_all_instances(Scene& scene, uint32_t object, const Matrices& matrices) {
  std::vector<dmat4> transforms;
  transforms.reserve(matrices.shape(0));
  for (size_t i = 0; i < matrices.shape(0); ++i) transforms.push_back(read_matrix(matrices.data() + 16 * i));
  add_instances(scene, object, transforms);
}

/// Returns the scene with other transforms of some objects. The objects exist.
Scene move(const Scene& scene, const std::vector<uint32_t>& objects, const Matrices& matrices) {
  Scene moved = scene;
  for (const auto& [object, transform] : read_transforms(objects, matrices)) {
    moved.objects.at(object).world_from_object = transform;
  }
  return moved;
}

/// Returns the scene with what light() has added to the same scene in another pose.
Scene light_like(const Scene& posed, const Scene& lit) {
  return work::with_light_of(posed, lit, work::find_ground(lit, posed.objects.size()));
}

template <typename T>
nb::list write_all(const std::vector<T>& values) {
  nb::list records;
  for (const T& value : values) records.append(write(value));
  return records;
}

LightChoice read_choice(const std::string& name) {
  return static_cast<LightChoice>(find_name(light_choice_names(), name, "light"));
}

/// Returns a copy of the scene with the light that `choice` adds for pictures of an integrator, and with the background
/// and the surroundings of this specification; and the display transform of its pictures. The file of the panorama has
/// an argument of its own, because its name need not be UTF-8.
nb::tuple light(const Scene& scene, const std::string& choice, const std::string& integrator, const std::string& spec,
                const std::optional<std::filesystem::path>& panorama) {
  work::ViewOptions options = read_spec(spec).view;
  options.look.light = read_choice(choice);
  const auto settled = static_cast<Integrator>(find_name(names_of(Integrator()), integrator, "integrator"));
  options.environment.panorama = panorama;
  Scene lit = scene;
  run_watched(nb::none(), [&](const ProgressCallback&) {
    const work::EnvironmentChoice surroundings(options.environment);
    surroundings.replace_sky(lit);
    work::settle_light(lit, settled, options.look);
    work::light_up(lit, options.look, surroundings, work::upward_direction(lit, options));
    lit.warnings = surroundings.warnings();
  });
  const DisplayTransform display = work::choose_display(lit, options.look, DebugView::kNone);
  return nb::make_tuple(std::move(lit), write(display));
}

template <typename T, typename Read>
void replace_all(std::vector<T>& values, const nb::list& records, const Read& read) {
  std::vector<T> replaced;
  for (const nb::handle record : records) replaced.push_back(read(nb::cast<nb::dict>(record)));
  values = std::move(replaced);
}

/// Moves a camera, but does not widen it for a picture's size.
Camera pose_exactly(const Scene& scene, Camera camera, const work::PoseOptions& pose) {
  const float aspect_ratio = std::exchange(camera.aspect_ratio, 0.0F);
  camera = work::pose_camera(scene, camera, pose, uvec2(1), work::Messages());
  camera.aspect_ratio = aspect_ratio;
  return camera;
}

/// Returns the camera for a picture with this specification. `given` replaces the scene's cameras and is not widened.
/// If no sides are given, the camera is that of a picture with this aspect ratio, and no camera is widened.
nb::dict choose_camera(const Scene& scene, const std::string& spec, const std::optional<nb::dict>& given,
                       const std::optional<std::pair<uint32_t, uint32_t>>& sides, float aspect_ratio) {
  work::ViewOptions options = read_spec(spec).view;
  if (sides && sides != std::pair(0U, 0U)) options.size = uvec2(sides->first, sides->second);
  return write(with_keywords([&] {
    work::check_pose_options(options.pose, given || options.camera);
    if (given) return pose_exactly(scene, read_camera(*given), options.pose);
    if (sides) return work::make_view(scene, options, work::Messages()).camera;
    const Camera* own = work::find_file_camera(scene, options);
    if (own == nullptr) return work::make_camera(scene, options, aspect_ratio);
    return pose_exactly(scene, *own, options.pose);
  }));
}

/// Returns an explanation if a picture of this size shows nothing of the scene; returns an empty text if it may show
/// something.
std::string describe_empty_picture(const Scene& scene, const nb::dict& camera, uint32_t width, uint32_t height) {
  const Camera one = read_camera(camera);
  return name_keywords(work::describe_empty_pictures(scene, {&one, 1}, uvec2(width, height)));
}

nb::object bounds(const Scene& scene) {
  const Bounds box = bounds_of(scene);
  if (box.is_empty()) return nb::none();
  return nb::make_tuple(nb::make_tuple(box.lo.x, box.lo.y, box.lo.z), nb::make_tuple(box.hi.x, box.hi.y, box.hi.z));
}

nb::list describe_objects(const Scene& scene) {
  nb::list objects;
  for (const Object& object : scene.objects) {
    const bool is_drawn = object.geometry != Object::kNoGeometry;
    objects.append(nb::make_tuple(object.name, is_drawn ? primitive_count(scene, object) : 0U, object.material));
  }
  return objects;
}

void check(const Scene& scene) {
  if (const std::vector<Problem> problems = validate(scene); !problems.empty()) throw InputError(problems);
}

}  // namespace

void bind_scene(nb::module_& module) {
  nb::class_<Scene>(module, "Scene")
      .def(nb::init<>())
      .def_static("load", &load_model, nb::arg("file"), nb::arg("is_strict"), nb::arg("variant"), nb::arg("root"))
      .def("add_mesh", &add_mesh, nb::arg("name"), nb::arg("positions").noconvert(), nb::arg("triangles").noconvert(),
           nb::arg("normals").noconvert().none(), nb::arg("colors").noconvert().none(), nb::arg("material"),
           nb::arg("matrix").noconvert())
      .def("add_shape", &add_shape, nb::arg("name"), nb::arg("kind"), nb::arg("record"), nb::arg("material"),
           nb::arg("matrix").noconvert())
      .def("add_instances", &add_all_instances, nb::arg("object"), nb::arg("matrices").noconvert())
      .def("object_count", [](const Scene& s) { return s.objects.size(); })
      .def("add_material", [](Scene& s, const nb::dict& record) { s.materials.push_back(read_material(record)); })
      .def("add_light", [](Scene& s, const nb::dict& record) { s.lights.push_back(read_light(record)); })
      .def("add_camera", [](Scene& s, const nb::dict& record) { s.cameras.push_back(read_camera(record)); })
      .def("set_materials", [](Scene& s, const nb::list& records) { replace_all(s.materials, records, read_material); })
      .def("set_lights", [](Scene& s, const nb::list& records) { replace_all(s.lights, records, read_light); })
      .def("set_environment", [](Scene& s, const nb::dict& record) { s.environment = read_environment(record); })
      .def("materials", [](const Scene& s) { return write_all(s.materials); })
      .def("lights", [](const Scene& s) { return write_all(s.lights); })
      .def("cameras", [](const Scene& s) { return write_all(s.cameras); })
      .def("environment", [](const Scene& s) { return write(s.environment); })
      .def("objects", &describe_objects)
      .def("warnings", [](const Scene& s) { return s.warnings; })
      .def("variants", [](const Scene& s) { return s.variants; })
      .def("center", [](const Scene& s) { return nb::make_tuple(s.center.x, s.center.y, s.center.z); })
      .def("bounds", &bounds)
      .def("animations", &describe_animations)
      .def("at", &pose, nb::arg("time"), nb::arg("animations"), nb::arg("loops"))
      .def("moved", &move, nb::arg("objects"), nb::arg("matrices").noconvert())
      .def("lit_like", &light_like, nb::arg("lit"))
      .def("validate", &check)
      .def("copy", [](const Scene& s) { return Scene(s); })
      .def("set_center", [](Scene& s, double x, double y, double z) { s.center = dvec3(x, y, z); })
      .def("lit", &light, nb::arg("choice"), nb::arg("integrator"), nb::arg("spec"), nb::arg("panorama").none())
      .def("choose_camera", &choose_camera, nb::arg("spec"), nb::arg("given").none(), nb::arg("sides").none(),
           nb::arg("aspect_ratio"))
      .def("describe_empty_picture", &describe_empty_picture, nb::arg("camera"), nb::arg("width"), nb::arg("height"))
      .def("default_max_depth", [](const Scene& s) { return default_max_depth(s); })
      .def("mixes_unlit", [](const Scene& s) { return mixes_unlit(s); })
      .def(
          "usual_integrator",
          [](const Scene& s, const std::string& choice) {
            const Integrator integrator = work::usual_integrator(s, read_choice(choice));
            return std::string(names_of(integrator)[static_cast<size_t>(integrator)]);
          },
          nb::arg("choice"));
}

}  // namespace promin::python
