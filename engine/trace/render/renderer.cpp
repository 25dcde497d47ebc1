// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "promin/renderer.h"

#include <cmath>

#include "device/device.h"
#include "device_scene/drop_copies.h"
#include "promin/validate.h"
#include "trace/render/picture_tracer.h"
#include "trace/render/renderer_impl.h"

namespace promin {
namespace {

void check(ProblemCode code, bool is_so, const char* what, const char* where, const char* cure) {
  if (!is_so) throw UsageError({code, what, where, cure});
}

void check_view(const View& view) {
  if (const std::vector<Problem> problems = validate(view); !problems.empty()) throw UsageError(problems);
}

}  // namespace

// This struct is hidden, although the class around it is not (promin/export.h).
struct __attribute__((visibility("hidden"))) Renderer::Impl {
  Impl(const gpu::Device& device, const SceneToPack& scene, const TunedRendererOptions& options)
      : tracer(device, scene, options) {}

  PictureTracer tracer;
};

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::Renderer(const gpu::Device& device, const Scene& scene, const RendererOptions& options) {
  throw_if_invalid(scene);
  *this = RendererAccess::make(device, world::flatten(scene, world::Purpose::kPictures, options.instances),
                               TunedRendererOptions{options});
}
Renderer::~Renderer() = default;
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;

Renderer RendererAccess::make(const gpu::Device& device, const SceneToPack& scene,
                              const TunedRendererOptions& options) {
  std::unique_ptr<Renderer::Impl> impl;
  gpu::translate_vulkan_errors([&] { impl = std::make_unique<Renderer::Impl>(device, scene, options); });
  return Renderer(std::move(impl));
}

SceneOnDevice& RendererAccess::scene_of(Renderer& renderer) {
  return renderer.impl_->tracer.scene();
}
const SceneOnDevice& RendererAccess::scene_of(const Renderer& renderer) {
  return renderer.impl_->tracer.scene();
}

RenderResult RendererAccess::render_sample(Renderer& renderer, const View& view, uint32_t sample,
                                           const ProgressCallback& progress) {
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = renderer.impl_->tracer.render_sample(view, sample, progress); });
  return result;
}

const SetupStats& Renderer::setup_stats() const {
  return impl_->tracer.stats();
}

WorkDone Renderer::work_done() const {
  return impl_->tracer.work_done();
}

void Renderer::set_lights(std::span<const Light> lights) {
  throw_if_invalid(lights);
  gpu::translate_vulkan_errors([&] {
    impl_->tracer.scene().set_lights(lights);
    impl_->tracer.take_change();
  });
}

namespace {

/// Throws InputError if copies that are not in the tree would become visible through the primitive that replaces them.
void check_copies(const std::set<uint32_t>& copied, std::span<const Material> materials) {
  for (const uint32_t i : copied) {
    if (hides_copies(materials[i])) continue;
    throw InputError({"scene.copies.opaque",
                      "the material was opaque when the tree was built, so the tree keeps one of more than " +
                          std::to_string(kMostCopies) +
                          " identical primitives, and the others cannot be seen through it",
                      "material " + std::to_string(i) + " of set_materials", "create a renderer of the changed scene"});
  }
}

}  // namespace

void Renderer::set_materials(std::span<const Material> materials) {
  throw_if_invalid(materials);
  if (materials.size() != impl_->tracer.scene().material_count()) {
    throw InputError({"scene.materials.count",
                      "the call gives " + std::to_string(materials.size()) + " materials to a scene that has " +
                          std::to_string(impl_->tracer.scene().material_count()),
                      "set_materials", "give one for each of the scene's materials, in their order"});
  }
  check_copies(impl_->tracer.scene().copied_materials(), materials);
  gpu::translate_vulkan_errors([&] {
    impl_->tracer.scene().set_materials(materials);
    impl_->tracer.take_change();
  });
}

void Renderer::set_environment(const Environment& environment) {
  throw_if_invalid(environment);
  gpu::translate_vulkan_errors([&] {
    impl_->tracer.scene().set_environment(environment);
    impl_->tracer.take_change();
  });
}

void Renderer::set_transforms(std::span<const std::pair<uint32_t, dmat4>> world_from_object) {
  gpu::translate_vulkan_errors([&] { impl_->tracer.set_transforms(world_from_object); });
}

void RendererAccess::set_pose(Renderer& renderer, const world::Scene& posed, TreeOfPose tree) {
  gpu::translate_vulkan_errors([&] { renderer.impl_->tracer.set_pose(posed, tree); });
}

void Renderer::set_pose(const Scene& posed) {
  throw_if_invalid(posed);
  const SceneOnDevice& scene = impl_->tracer.scene();
  check_same_scene(posed, scene.object_materials().size(), scene.material_count());
  RendererAccess::set_pose(*this, world::flatten(posed, world::Purpose::kPictures, impl_->tracer.options().instances),
                           TreeOfPose::kRefitted);
}

Explanation Renderer::explain(const View& view, const uvec2& pixel) {
  check_view(view);
  check("view.pixel.outside", pixel.x < view.size.x && pixel.y < view.size.y,
        "the pixel to explain lies outside the picture", "pixel", "use a pixel inside");
  Explanation explanation;
  gpu::translate_vulkan_errors([&] { explanation = impl_->tracer.explain(view, pixel); });
  return explanation;
}

RenderResult Renderer::render_within(const View& view, double seconds, const ProgressCallback& progress) {
  check_view(view);
  check("view.target.missing", view.error_target.has_value(), "the view has no target error", "view.error_target",
        "set a target error");
  check("argument.range", std::isfinite(seconds), "the time limit is not finite", "seconds",
        "give a finite number of seconds");
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = impl_->tracer.render_within(view, seconds, progress); });
  return result;
}

RenderResult Renderer::render(const View& view, const ProgressCallback& progress) {
  check_view(view);
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = impl_->tracer.render(view, progress); });
  return result;
}

void Renderer::render_progressively(const View& view, double budget_ms,
                                    const std::function<bool(const Image&, const View&)>& on_picture) {
  check_view(view);
  check("view.crop.unsupported", !view.crop, "render_progressively does not support a crop", "view.crop",
        "show the whole picture, or call render for the crop");
  check("argument.range", budget_ms > 0.0 && std::isfinite(budget_ms), "the budget is not positive and finite",
        "budget_ms", "give a positive number of milliseconds");
  check("argument.missing", static_cast<bool>(on_picture), "the function that receives the pictures is empty",
        "on_picture", "give a function");
  gpu::translate_vulkan_errors([&] { impl_->tracer.render_progressively(view, budget_ms, on_picture); });
}

}  // namespace promin
