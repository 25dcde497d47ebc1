// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "oracle/oracle.h"
#include "promin/renderer.h"

/// Whole pictures by brute force: docs/model.md's "Rays and camera" and "Light" in long double.
namespace promin::oracle {

struct Pixel {
  Ray ray;
  Hit hit;
  /// Linear RGB.
  Vector color{0};
  /// How far a device's colour may be off because of highlights of metallic-roughness materials and textures:
  /// points and normals have errors within their bounds (kB1, allowed_normal_error), and mirrors hand them on. A lobe
  /// of the width alpha changes by about 2 / alpha of itself per radian between normal and half vector, a texture by as
  /// much as its texels differ. Other light changes so little with directions that a picture's bounds hold without.
  Real explained_error = 0;
  /// And because its skies are maps (Surroundings::map_error).
  Real map_error = 0;
  /// Whether the ray passes where a mask begins so near that a device may see either what is there or what is behind.
  bool is_at_cutoff = false;

  /// Distance of the hit from the eye, along the ray; infinite on a miss.
  Real depth() const { return hit.exists() ? hit.t * glm::length(ray.direction) : kInfinity; }
};

/// Row 0 is the top.
struct Picture {
  uvec2 size{0};
  std::vector<Pixel> pixels;

  const Pixel& at(uint32_t x, uint32_t y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
};

/// Through the centre of the pixel, from the fp32 numbers of the camera that the device gets; t counts from the eye in
/// distances of the viewport, and t = near is met.
Ray camera_ray(const Camera& camera, const uvec2& size, uint32_t x, uint32_t y);

/// The whole picture, one sample a pixel whatever the view's crop and samples, on all cores.
Picture render(const world::Scene& scene, const View& view);

}  // namespace promin::oracle
