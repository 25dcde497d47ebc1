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
  /// The permitted error of a device's colour because of textures and of highlights of metallic-roughness materials:
  /// points and normals have errors within their bounds (kB1, allowed_normal_error), and mirrors pass them on. A lobe
  /// of the width alpha changes by about 2 / alpha of itself per radian between normal and half vector, a texture by as
  /// much as its texels differ. Other light depends so little on directions that a picture's bounds hold without this.
  Real explained_error = 0;
  /// And because its skies are maps (Surroundings::map_error).
  Real map_error = 0;
  /// Whether the ray passes so close to the edge of a mask that a device may see either the surface or what is behind
  /// it.
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
