// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "reporting/picture.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "fixed_offset_camera_stage.spv.h"
#include "fixed_offset_follow_paths.spv.h"
#include "fixed_offset_trace_shadow_rays.spv.h"
#include "full_boxes_camera_stage.spv.h"
#include "full_boxes_follow_paths.spv.h"
#include "full_boxes_trace_shadow_rays.spv.h"
#include "integer_offset_camera_stage.spv.h"
#include "integer_offset_follow_paths.spv.h"
#include "integer_offset_trace_shadow_rays.spv.h"
#include "render/renderer_impl.h"
#include "reporting/full_boxes.h"
#include "textbook_camera_stage.spv.h"
#include "textbook_follow_paths.spv.h"
#include "textbook_trace_shadow_rays.spv.h"

namespace promin::report {

const std::vector<PictureMethod>& picture_methods() {
  static const std::vector<PictureMethod> kMethods = {
      {"promin", "as shipped"},
      {"full boxes",
       "boxes in fp32 instead of bytes",
       {k_full_boxes_camera_stage_spirv, k_full_boxes_trace_shadow_rays_spirv, k_full_boxes_follow_paths_spirv},
       true},
      {"fixed offset",
       "secondary rays start 10⁻⁴ off the surface",
       {k_fixed_offset_camera_stage_spirv, k_fixed_offset_trace_shadow_rays_spirv, k_fixed_offset_follow_paths_spirv}},
      {"integer offset",
       "secondary rays start some floats off the surface (Wächter and Binder)",
       {k_integer_offset_camera_stage_spirv, k_integer_offset_trace_shadow_rays_spirv,
        k_integer_offset_follow_paths_spirv}},
      {"textbook",
       "the textbook's intersections, boxes as they are, offset 10⁻⁴",
       {k_textbook_camera_stage_spirv, k_textbook_trace_shadow_rays_spirv, k_textbook_follow_paths_spirv}}};
  return kMethods;
}

const PictureMethod& picture_method(const std::string& name) {
  const auto& all = picture_methods();
  const auto found = std::find_if(all.begin(), all.end(), [&](const PictureMethod& m) { return m.name == name; });
  assert(found != all.end());
  return *found;
}

TunedRendererOptions options_for(const PictureMethod& method, const std::string& builder) {
  TunedRendererOptions options;
  options.builder = builder;
  options.shaders = method.shaders;
  if (method.has_full_boxes) options.repack = with_full_boxes;
  return options;
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
