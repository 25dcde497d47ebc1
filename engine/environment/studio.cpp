// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/studio.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace promin {
namespace {

// What the lamps add up to (docs/model.md, "Studio") makes a white wall that faces the viewer shine with .93: .53 from
// the lamps and .40 from the light that casts shadows.
constexpr double kHorizon = 0.36;
constexpr double kRise = 0.04;
constexpr double kFloor = 0.20;
/// -y from which on the floor is all that there is.
constexpr double kFloorDepth = 0.35;
/// The part of a lamp's half size within which its edge falls from all to nothing, to both sides of it.
constexpr double kEdge = 0.15;

/// A soft rectangle in the sky, in degrees. The azimuth is counted from the viewer to the right; the size as seen from
/// the scene.
struct Lamp {
  double azimuth_deg;
  double elevation_deg;
  double width_deg;
  double height_deg;
  double radiance;
};
constexpr Lamp kKey = {-45.0, 35.0, 44.0, 34.0, 2.0};
constexpr Lamp kStrip = {65.0, 15.0, 14.0, 60.0, 2.4};
constexpr Lamp kRim = {165.0, 30.0, 60.0, 18.0, 2.0};

double smoothstep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

dvec3 direction_of(double azimuth, double elevation) {
  return {std::cos(elevation) * std::sin(azimuth), std::sin(elevation), std::cos(elevation) * std::cos(azimuth)};
}

/// A lamp as directions are held against it.
class HungLamp {
 public:
  explicit HungLamp(const Lamp& lamp)
      : middle_(direction_of(glm::radians(lamp.azimuth_deg), glm::radians(lamp.elevation_deg))),
        right_(std::cos(glm::radians(lamp.azimuth_deg)), 0.0, -std::sin(glm::radians(lamp.azimuth_deg))),
        up_(glm::cross(middle_, right_)),
        half_width_(0.5 * glm::radians(lamp.width_deg)),
        half_height_(0.5 * glm::radians(lamp.height_deg)),
        least_cosine_(std::cos(1.5 * std::max(half_width_, half_height_))),
        radiance_(lamp.radiance) {}

  double radiance(const dvec3& direction) const {
    const double cosine = glm::dot(direction, middle_);
    // Beyond its corners, without angles.
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
  static const std::array<HungLamp, 3> kLamps = {HungLamp(kKey), HungLamp(kStrip), HungLamp(kRim)};
  double sum = direction.y >= 0.0 ? kHorizon + kRise * direction.y
                                  : kHorizon + (kFloor - kHorizon) * smoothstep(0.0, kFloorDepth, -direction.y);
  for (const HungLamp& lamp : kLamps) sum += lamp.radiance(direction);
  return sum;
}

}  // namespace promin
