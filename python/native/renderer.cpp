// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <memory>

#include "bind.h"
#include "command_line.h"
#include "device.h"
#include "errors.h"
#include "in_process.h"
#include "matrices.h"
#include "picture_arrays.h"
#include "promin/cryptomatte.h"
#include "promin/error.h"
#include "promin/motion_vectors.h"
#include "records.h"
#include "scene.h"
#include "setup_stats.h"
#include "watched.h"

namespace nb = nanobind;

namespace promin::python {
namespace {

constexpr std::string_view kCryptomatte = "cryptomatte";

AovSet read_aovs(const std::vector<std::string>& names) {
  AovSet set;
  for (const std::string& name : names) {
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (name == #FIELD) {                                            \
    set.FIELD = true;                                              \
    continue;                                                      \
  }
#include "promin/kinds/aovs.def"
    if (name == kCryptomatte) {
      set.cryptomatte = true;
      continue;
    }
    std::string all;
    for (const std::string_view one : aov_names()) all += std::string(one) + ", ";
    throw UsageError({"python.name.unknown", "there is no AOV \"" + name + "\"", "",
                      "choose one of: " + all + std::string(kCryptomatte)});
  }
  return set;
}

// Returns the array of an AOV; the overloads differ in the type of a value.
nb::object write_aov(std::vector<float> values, const uvec2& size) {
  return write_array<float>(std::move(values), size);
}
nb::object write_aov(std::vector<uint32_t> values, const uvec2& size) {
  return write_array<uint32_t>(std::move(values), size);
}
template <typename Vector>
nb::object write_aov(std::vector<Vector> values, const uvec2& size) {
  return write_array<float>(std::move(values), size);
}

nb::dict write_aovs(Aovs aovs, const AovSet& choice, const uvec2& size) {
  nb::dict arrays;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  if (choice.FIELD) arrays[#FIELD] = write_aov(std::move(aovs.FIELD), size);
#include "promin/kinds/aovs.def"
  return arrays;
}

/// Returns the channels with the bits of their values.
nb::list write_cryptomatte(Cryptomatte cryptomatte, const uvec2& size) {
  nb::list channels;
  for (Channel& channel : cryptomatte.channels) {
    channels.append(nb::make_tuple(channel.name, write_array<uint32_t>(std::move(channel.values), size)));
  }
  return channels;
}

nb::dict write_metadata(const Metadata& metadata) {
  nb::dict entries;
  for (const auto& [name, value] : metadata) entries[name.c_str()] = to_text(value);
  return entries;
}

nb::object write_error(const std::optional<PictureError>& error) {
  if (!error) return nb::none();
  nb::dict record;
  record["target"] = error->target;
  record["largest_claim"] = error->largest_claim;
  record["unmet_pixels"] = error->unmet_pixels;
  record["samples"] = error->samples;
  return record;
}

nb::dict write_rays(const RayCounts& rays) {
  nb::dict record;
  record["primary"] = rays.primary;
  record["shadow"] = rays.shadow;
  record["reflection"] = rays.reflection;
  record["refraction"] = rays.refraction;
  record["pass_through"] = rays.passed;
  record["primary_hits"] = rays.primary_hits;
  return record;
}

class SharedRenderer {
 public:
  SharedRenderer(std::shared_ptr<OpenDevice> device, const Scene& scene, const std::vector<std::string>& aovs,
                 const std::string& builder, const std::optional<std::filesystem::path>& bvh,
                 const std::string& instances, bool has_error_target, const nb::dict& mode,
                 std::optional<uint64_t> expected_samples, uint64_t texture_bytes, const nb::object& progress)
      : device_(std::move(device)), aovs_(read_aovs(aovs)) {
    named_.objects = scene.objects;
    named_.materials = scene.materials;
    const gpu::Device& open = device_->get();
    std::unique_ptr<Renderer> renderer;
    const RenderMode first_mode = read_mode(mode);
    const auto choice = static_cast<Instancing>(find_name(instancing_names(), instances, "instances"));
    run_watched(progress, [&](const ProgressCallback& tell) {
      RendererOptions options;
      options.builder = builder;
      if (bvh) options.bvh = *bvh;
      options.instances = choice;
      options.aovs = aovs_;
      options.has_error_target = has_error_target;
      options.mode = first_mode;
      if (expected_samples) options.expected_samples = *expected_samples;
      options.texture_bytes = texture_bytes;
      options.progress = tell;
      renderer = std::make_unique<Renderer>(open, scene, options);
    });
    renderer_.emplace(std::move(renderer));
  }

  /// Renders a picture. Only the metadata depend on `display` and the name of the scene's file. With Aovs::motion,
  /// `scene` is the scene of the picture, and `next_scene` and `next_camera` belong to the next frame.
  nb::dict render(const nb::dict& record, const std::optional<double>& limit_s, const nb::dict& display,
                  const std::filesystem::path& scene_file, const Scene& scene, const Scene& next_scene,
                  const nb::dict& next_camera, const nb::object& progress) {
    const View view = read_view(record);
    const Camera next = read_camera(next_camera);
    const DisplayTransform shown = read_display(display);
    const gpu::DeviceInfo info = gpu::info_of(device_->get());
    Renderer& renderer = renderer_->get();
    RenderResult result;
    Metadata metadata;
    Cryptomatte cryptomatte;
    View reached = view;
    run_watched(progress, [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      result = limit_s ? renderer.render_within(view, *limit_s, tell) : renderer.render(view, tell);
      if (aovs_.motion) add_motion(scene, view, next_scene, next, result.aovs);
      if (aovs_.cryptomatte) cryptomatte = make_cryptomatte(named_, result.aovs);
      if (!result.error) {
        reached.error_target.reset();
        reached.samples_per_pixel = result.samples_per_pixel;
      }
      metadata = describe_picture(reached, shown, result.error, info, scene_file.string(), named_, aovs_);
    });
    nb::dict frame;
    const uvec2 size = result.image.size;
    frame["metadata"] = write_metadata(metadata);
    frame["cryptomatte"] = write_cryptomatte(std::move(cryptomatte), size);
    frame["aovs"] = write_aovs(std::move(result.aovs), aovs_, size);
    frame["rgb"] = write_image_array(std::move(result.image));
    frame["error"] = write_error(result.error);
    frame["rays"] = write_rays(result.rays);
    frame["trace_ms"] = result.trace_ms;
    return frame;
  }

  void set_lights(const nb::list& records) {
    std::vector<Light> lights;
    for (const nb::handle record : records) lights.push_back(read_light(nb::cast<nb::dict>(record)));
    change([&](Renderer& renderer) { renderer.set_lights(lights); });
  }

  void set_materials(const nb::list& records) {
    std::vector<Material> materials;
    for (const nb::handle record : records) materials.push_back(read_material(nb::cast<nb::dict>(record)));
    change([&](Renderer& renderer) {
      renderer.set_materials(materials);
      named_.materials = materials;
    });
  }

  void set_environment(const nb::dict& record) {
    const Environment environment = read_environment(record);
    change([&](Renderer& renderer) { renderer.set_environment(environment); });
  }

  void set_pose(const Scene& posed) {
    change([&](Renderer& renderer) {
      renderer.set_pose(posed);
      named_.materials = posed.materials;
    });
  }

  void set_transforms(const std::vector<uint32_t>& objects, const Matrices& matrices) {
    const auto transforms = read_transforms(objects, matrices);
    change([&](Renderer& renderer) { renderer.set_transforms(transforms); });
  }

  nb::dict setup() const { return describe(renderer_->get().setup_stats()); }

 private:
  template <typename Change>
  void change(const Change& make) {
    Renderer& renderer = renderer_->get();
    run_watched(nb::none(), [&](const ProgressCallback& tell) {
      const auto lock = lock_watched(mutex_, tell);
      make(renderer);
    });
  }

  // Declared before the renderer, because the renderer must be destroyed first.
  std::shared_ptr<OpenDevice> device_;
  AovSet aovs_;
  /// A scene with only the objects and materials, whose names Cryptomatte stores.
  Scene named_;
  std::optional<InProcess<std::unique_ptr<Renderer>>> renderer_;
  std::timed_mutex mutex_;
};

/// Returns for each AOV its name, its channel in an EXR, and the letters of its components.
nb::list list_aovs() {
  nb::list rows;
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS, SOURCE) \
  rows.append(nb::make_tuple(#FIELD, CHANNEL, COMPONENTS));
#include "promin/kinds/aovs.def"
  return rows;
}

}  // namespace

void bind_renderer(nb::module_& module) {
  nb::class_<SharedRenderer>(module, "Renderer")
      .def(nb::init<std::shared_ptr<OpenDevice>, const Scene&, const std::vector<std::string>&, const std::string&,
                    const std::optional<std::filesystem::path>&, const std::string&, bool, const nb::dict&,
                    std::optional<uint64_t>, uint64_t, const nb::object&>(),
           nb::arg("device"), nb::arg("scene"), nb::arg("aovs"), nb::arg("builder"), nb::arg("bvh").none(),
           nb::arg("instances"), nb::arg("has_error_target"), nb::arg("mode"), nb::arg("expected_samples").none(),
           nb::arg("texture_bytes"), nb::arg("progress").none())
      .def("render", &SharedRenderer::render, nb::arg("view"), nb::arg("limit_s").none(), nb::arg("display"),
           nb::arg("scene_file"), nb::arg("scene"), nb::arg("next_scene"), nb::arg("next_camera"),
           nb::arg("progress").none())
      .def("set_lights", &SharedRenderer::set_lights)
      .def("set_materials", &SharedRenderer::set_materials)
      .def("set_environment", &SharedRenderer::set_environment)
      .def("set_pose", &SharedRenderer::set_pose, nb::arg("scene"))
      .def("set_transforms", &SharedRenderer::set_transforms, nb::arg("objects"), nb::arg("matrices").noconvert())
      .def("setup", &SharedRenderer::setup);
  module.def("list_aovs", &list_aovs);
  module.def("default_width", [](const std::string& filter) {
    return default_width(static_cast<PixelFilter>(find_name(pixel_filter_names(), filter, "filter")));
  });
}

}  // namespace promin::python
