// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "promin/image.h"
#include "promin/renderer.h"
#include "render/renderer_impl.h"

namespace promin::report {

/// Ways to make the same picture: promin's own, and those of tools/plain.
struct PictureMethod {
  std::string name;
  std::string what;
  PictureShaders shaders = picture_shaders();
  bool has_full_boxes = false;
};

/// The shipped one first.
const std::vector<PictureMethod>& picture_methods();
const PictureMethod& picture_method(const std::string& name);

/// What makes a Renderer one of this method.
TunedRendererOptions options_for(const PictureMethod& method, const std::string& builder = "sah");

/// Square root of the mean of all channels' squared differences; of pictures of one size.
double rmse_of(const Image& a, const Image& b);

/// A picture's size by repetition of its pixels, to compare pictures of several resolutions.
Image enlarge(const Image& image, const uvec2& size);
/// By averages of its pixels; `size` divides the picture's.
Image reduce(const Image& image, const uvec2& size);

}  // namespace promin::report
