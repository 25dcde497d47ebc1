// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/studio.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace promin {
namespace {

// A white surface that faces the viewer is displayed as 0.79 (sRGB): its radiance is .36 from the surroundings and .27
// from the light that casts shadows (docs/model.md, "Studio"). In front of the viewer the floor is dark, so that its
// reflection shows the curvature of metals. Behind the scene the floor is as bright as the backdrop, which is visible
// through glass.
struct Ends {
  double front;
  double back;
};
constexpr Ends kHorizon = {0.20, 0.36};
constexpr Ends kFloor = {0.05, 0.24};
constexpr double kCeiling = 0.16;
/// At -y >= kFloorDepth a direction shows only the floor, and at y >= kCeilingHeight only the ceiling.
constexpr double kFloorDepth = 0.2;
constexpr double kCeilingHeight = 0.6;
/// The width of a lamp's edge, relative to its half size. The radiance decreases from full at 1 minus this width to 0
/// at 1 plus this width.
constexpr double kEdge = 0.15;

/// A soft rectangle in the sky. Angles are in degrees: the azimuth is counted from the viewer to the right, and the
/// size is as seen from the scene.
struct Lamp {
  double azimuth_deg;
  double elevation_deg;
  double width_deg;
  double height_deg;
  double radiance;
};
constexpr Lamp kKey = {-45.0, 38.0, 46.0, 36.0, 1.7};
constexpr Lamp kFill = {70.0, 12.0, 30.0, 64.0, 0.8};
constexpr Lamp kRim = {165.0, 32.0, 60.0, 16.0, 1.8};
constexpr Lamp kTop = {0.0, 72.0, 60.0, 34.0, 0.7};

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

dvec3 direction_at(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

/// A lamp in a form in which directions can be tested quickly.
class HungLamp {
 public:
  explicit HungLamp(const Lamp& lamp)
      : middle_(direction_at(glm::radians(lamp.azimuth_deg), glm::radians(lamp.elevation_deg))),
        right_(std::cos(glm::radians(lamp.azimuth_deg)), 0.0, -std::sin(glm::radians(lamp.azimuth_deg))),
        up_(glm::cross(middle_, right_)),
        half_width_(0.5 * glm::radians(lamp.width_deg)),
        half_height_(0.5 * glm::radians(lamp.height_deg)),
        least_cosine_(std::cos(1.5 * std::max(half_width_, half_height_))),
        radiance_(lamp.radiance) {}

  double radiance(const dvec3& direction) const {
    const double cosine = glm::dot(direction, middle_);
    // The direction lies beyond the lamp's corners; no angles are needed.
    if (cosine < least_cosine_) return 0.0;
    return radiance_ * share(std::atan2(glm::dot(direction, right_), cosine), half_width_) *
           share(std::atan2(glm::dot(direction, up_), cosine), half_height_);
  }

 private:
  static double share(double angle, double half) {
    return 1.0 - smoothstep((1.0 - kEdge) * half, (1.0 + kEdge) * half, std::abs(angle));
  }

  dvec3 middle_;
  dvec3 right_;
  dvec3 up_;
  double half_width_;
  double half_height_;
  double least_cosine_;
  double radiance_;
};

}  // namespace

double studio_radiance(const dvec3& direction) {
  static const std::array<HungLamp, 4> kLamps = {HungLamp(kKey), HungLamp(kFill), HungLamp(kRim), HungLamp(kTop)};
  // Runs from 0 at the front to 1 at the back.
  const double way = 0.5 - 0.5 * direction.z;
  const double horizon = std::lerp(kHorizon.front, kHorizon.back, way);
  const double floor = std::lerp(kFloor.front, kFloor.back, way);
  double sum = direction.y >= 0.0 ? std::lerp(horizon, kCeiling, smoothstep(0.0, kCeilingHeight, direction.y))
                                  : std::lerp(horizon, floor, smoothstep(0.0, kFloorDepth, -direction.y));
  for (const HungLamp& lamp : kLamps) sum += lamp.radiance(direction);
  return sum;
}

}  // namespace promin
