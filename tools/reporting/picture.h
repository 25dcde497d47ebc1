// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <string>

#include "image/image.h"
#include "render/film.h"
#include "render/pack_scene.h"
#include "render/renderer.h"
#include "reporting/session.h"

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

/// As Renderer (render/renderer.h), for any of the methods.
class Picture {
 public:
  /// `features` as of the scene; with FEATURE_AOVS it brings what Renderer's `with_aovs` does. Throws as Renderer does.
  Picture(const gpu::Device& device, const Scene& scene, const PictureMethod& method,
          const std::string& builder = "sah", FeatureMask more_features = 0);
  ~Picture();
  Picture(Picture&&) noexcept;

  /// Throws RunError where the driver cuts loops, or the picture passes the device's buffers.
  RenderResult render(const View& view);

  uint64_t device_bytes() const;
  std::string scene_hash() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Square root of the mean of all channels' squared differences; of pictures of one size.
double rmse_of(const Image& a, const Image& b);

/// A picture's size by repetition of its pixels, to compare pictures of several resolutions.
Image enlarge(const Image& image, const uvec2& size);
/// By averages of its pixels; `size` divides the picture's.
Image reduce(const Image& image, const uvec2& size);

}  // namespace promin::report
