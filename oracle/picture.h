// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "oracle/oracle.h"
#include "promin/renderer.h"

/// Renders whole pictures by brute force in long double, as described in docs/model.md, "Rays and camera" and "Light".
namespace promin::oracle {

struct Pixel {
  Ray ray;
  Hit hit;
  /// The pixel's colour, linear RGB.
  Vector color{0};
  /// The permitted error of a device's colour because of textures and highlights of metallic-roughness materials.
  /// Points and normals have errors within their bounds (kB1, allowed_normal_error), and mirrors pass these errors on.
  /// A lobe of the width alpha changes by about 2 / alpha of its value per radian between normal and half vector; a
  /// texture changes by the difference of its texels. Other light depends so little on directions that a picture's
  /// bounds hold without this.
  Real explained_error = 0;
  /// The permitted error of a device's colour because its skies are maps (Surroundings::map_error).
  Real map_error = 0;
  /// True if the ray passes so close to the edge of a mask that a device may see either the surface or the surface
  /// behind it.
  bool is_at_cutoff = false;

  /// Distance of the hit from the eye, along the ray; infinite on a miss.
  Real depth() const { return hit.exists() ? hit.t * glm::length(ray.direction) : kInfinity; }
};

/// A picture. Row 0 is at the top.
struct Picture {
  uvec2 size{0};
  std::vector<Pixel> pixels;

  const Pixel& at(uint32_t x, uint32_t y) const { return pixels[static_cast<size_t>(y) * size.x + x]; }
};

/// A sample of each pixel.
struct SampleChoice {
  /// Position in the pixel, from its upper left corner.
  std::array<Real, 2> place{0.5L, 0.5L};
  /// The number of the sample.
  uint32_t number = 0;
  /// True for pictures with an error target.
  bool is_refined = false;
};

/// Returns the ray through the centre of the pixel, computed from the fp32 numbers of the camera that the device
/// receives. t is counted from the eye in units of the viewport's distance. A surface at t = near is hit.
Ray camera_ray(const Camera& camera, const uvec2& size, uint32_t x, uint32_t y);

/// Renders the whole picture on all cores, with one sample per pixel. It ignores the view's crop and number of samples.
Picture render(const world::Scene& scene, const View& view);
/// Returns the same for another sample. `place_of` returns the sample of a pixel.
Picture render(const world::Scene& scene, const View& view,
               const std::function<SampleChoice(const uvec2& pixel)>& place_of);

}  // namespace promin::oracle
