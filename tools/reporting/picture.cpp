// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fixed_offset_camera_stage.spv.h"
#include "fixed_offset_mirror_stage.spv.h"
#include "full_boxes_camera_stage.spv.h"
#include "full_boxes_mirror_stage.spv.h"
#include "gpu/device.h"
#include "integer_offset_camera_stage.spv.h"
#include "integer_offset_mirror_stage.spv.h"
#include "render/film.h"
#include "render/ray_kernel.h"
#include "reporting/full_boxes.h"
#include "reporting/provenance.h"
#include "textbook_camera_stage.spv.h"
#include "textbook_mirror_stage.spv.h"

namespace promin::report {

const std::vector<PictureMethod>& picture_methods() {
  static const std::vector<PictureMethod> kMethods = {
      {"promin", "as shipped"},
      {"full boxes",
       "boxes in fp32 instead of bytes",
       {k_full_boxes_camera_stage_spirv, k_full_boxes_mirror_stage_spirv},
       true},
      {"fixed offset",
       "secondary rays start 10⁻⁴ off the surface",
       {k_fixed_offset_camera_stage_spirv, k_fixed_offset_mirror_stage_spirv}},
      {"integer offset",
       "secondary rays start some floats off the surface (Wächter and Binder)",
       {k_integer_offset_camera_stage_spirv, k_integer_offset_mirror_stage_spirv}},
      {"textbook",
       "the textbook's intersections, boxes as they are, offset 10⁻⁴",
       {k_textbook_camera_stage_spirv, k_textbook_mirror_stage_spirv}}};
  return kMethods;
}

const PictureMethod& picture_method(const std::string& name) {
  const auto& all = picture_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const PictureMethod& m) { return m.name == name; });
  assert(found != all.end());
  return *found;
}

struct Picture::Impl {
  Impl(const gpu::Device& device, const PackedScene& packed, FeatureMask the_features, const PictureShaders& shaders)
      : features(the_features),
        numbers(packed.numbers),
        device_bytes(packed.size_bytes()),
        scene_hash(hash_of(packed)),
        pacer(dispatch_target_ms(device), PicturePieces::kMinBlocks),
        film(device, upload_scene(device, packed), features, FilmOptions{.shaders = shaders}) {
    film.warm_up();
  }

  RenderResult render(const View& view) {
    const uint32_t pixel_count = view.size.x * view.size.y;
    if (pixel_count > film.max_capacity()) {
      throw RunError({"the picture is too large for a buffer of the device", "in the report", "take another --device"});
    }
    film.reserve(pixel_count);
    PieceOptions options = film.piece_options();
    RenderResult result = trace(view, options);
    if (has_cut_loops) {
      // As Renderer does, but for the time.
      options.most_paths_a_lane = 1;
      result = trace(view, options);
      if (has_cut_loops) throw make_cut_loops_error("take another --device");
    }
    read(view, pixel_count, result);
    return result;
  }

  RenderResult trace(const View& view, const PieceOptions& options) {
    PicturePieces pieces = film.cut(view, {uvec2(0), view.size}, options);
    film.begin(pieces);
    RenderResult result;
    while (!pieces.is_done()) {
      const PicturePiece piece = pieces.next(pacer.units());
      const double time_ms = film.run({&piece, 1});
      pacer.learn(piece.units, time_ms);
      result.trace_ms += time_ms;
    }
    const FilmCounts counts = film.take_counts();
    has_cut_loops = counts.has_cut_loops;
    result.rays = counts.rays;
    return result;
  }

  void read(const View& view, uint32_t pixel_count, RenderResult& result) {
    std::vector<uvec4> records(size_t{pixel_count} * film.records_per_pixel());
    film.buffer().read(std::as_writable_bytes(std::span(records)), Film::kPixelsOffset);
    result.image.size = view.size;
    result.image.pixels.resize(pixel_count);
    average_samples(records, view.samples_per_pixel, result.image.pixels);
    if ((features & layout::FEATURE_AOVS) == 0) return;
    result.aovs.object.assign(pixel_count, Aovs::kNoId);
    result.aovs.primitive.assign(pixel_count, Aovs::kNoId);
    for (uint32_t i = 0; i < pixel_count; ++i) {
      if (records[i].w == layout::NO_ORDER) continue;
      const PrimitiveId id = primitive_of_order(numbers, records[i].w);
      result.aovs.object[i] = id.object;
      result.aovs.primitive[i] = id.primitive;
    }
  }

  FeatureMask features;
  PrimitiveNumbers numbers;
  uint64_t device_bytes;
  std::string scene_hash;
  Pacer pacer;
  Film film;
  /// Of the last trace.
  bool has_cut_loops = false;
};

Picture::Picture(const gpu::Device& device, const Scene& scene, const PictureMethod& method, const std::string& builder,
                 FeatureMask more_features) {
  PackedScene packed = pack_scene(scene, builder);
  if (method.has_full_boxes) packed = with_full_boxes(std::move(packed));
  gpu::translate_vulkan_errors(
      [&] { impl_ = std::make_unique<Impl>(device, packed, features_of(scene) | more_features, method.shaders); });
}
Picture::~Picture() = default;
Picture::Picture(Picture&&) noexcept = default;

RenderResult Picture::render(const View& view) {
  RenderResult result;
  gpu::translate_vulkan_errors([&] { result = impl_->render(view); });
  return result;
}

uint64_t Picture::device_bytes() const {
  return impl_->device_bytes;
}

std::string Picture::scene_hash() const {
  return impl_->scene_hash;
}

double rmse_of(const Image& a, const Image& b) {
  assert(a.size == b.size);
  double sum = 0.0;
  for (size_t i = 0; i < a.pixels.size(); ++i) {
    const dvec3 difference = dvec3(a.pixels[i]) - dvec3(b.pixels[i]);
    sum += glm::dot(difference, difference);
  }
  return std::sqrt(sum / (3.0 * static_cast<double>(a.pixels.size())));
}

Image enlarge(const Image& image, const uvec2& size) {
  Image result{size, std::vector<vec3>(size_t{size.x} * size.y)};
  for (uint32_t y = 0; y < size.y; ++y) {
    for (uint32_t x = 0; x < size.x; ++x) {
      result.at(x, y) = image.at(x * image.size.x / size.x, y * image.size.y / size.y);
    }
  }
  return result;
}

Image reduce(const Image& image, const uvec2& size) {
  const uvec2 step = image.size / size;
  Image result{size, std::vector<vec3>(size_t{size.x} * size.y)};
  for (uint32_t y = 0; y < image.size.y; ++y) {
    for (uint32_t x = 0; x < image.size.x; ++x) {
      result.at(x / step.x, y / step.y) += image.at(x, y) / static_cast<float>(step.x * step.y);
    }
  }
  return result;
}

}  // namespace promin::report
