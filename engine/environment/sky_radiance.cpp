// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "environment/sky_radiance.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "environment/studio.h"
#include "scene/upright.h"

namespace promin {
namespace {

using std::numbers::pi;

/// Returns the direction before the world was rotated by an angle about +Y, from +Z towards +X.
dvec3 turn_back(const dvec3& v, double angle) {
  if (angle == 0.0) return v;
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  return {cosine * v.x - sine * v.z, v.y, sine * v.x + cosine * v.z};
}

/// Returns the radiance of each kind of sky for unit directions in the sky's own space.
struct Radiance {
  dvec3 direction;

  dvec3 operator()(std::monostate) const { return dvec3(0.0); }

  dvec3 operator()(const Studio& studio) const {
    return dvec3(studio_radiance(turn_back(direction, static_cast<double>(studio.front))));
  }

  dvec3 operator()(const GradientSky& sky) const {
    const double elevation = std::asin(std::clamp(direction.y, -1.0, 1.0)) / (0.5 * pi);
    const auto curve = static_cast<double>(elevation < 0.0 ? sky.bottom_curve : sky.top_curve);
    const dvec3 end(elevation < 0.0 ? sky.bottom : sky.top);
    return glm::mix(end, dvec3(sky.horizon), std::pow(1.0 - std::abs(elevation), 1.0 / curve));
  }

  dvec3 operator()(const Panorama& panorama) const {
    const Image& image = *panorama.image;
    const auto width = static_cast<double>(image.size.x);
    const auto height = static_cast<double>(image.size.y);
    const double x = width * (0.5 + std::atan2(direction.x, -direction.z) / (2.0 * pi)) - 0.5;
    const double y = height * std::acos(std::clamp(direction.y, -1.0, 1.0)) / pi - 0.5;
    const double left = std::floor(x);
    const double above = std::floor(y);
    // x lies in -0.5...width - 0.5.
    const uint32_t x0 = left < 0.0 ? image.size.x - 1 : static_cast<uint32_t>(left);
    const uint32_t x1 = x0 + 1 < image.size.x ? x0 + 1 : 0;
    const auto y0 = static_cast<uint32_t>(std::max(above, 0.0));
    const auto y1 = std::min(static_cast<uint32_t>(above + 1.0), image.size.y - 1);
    const double across = x - left;
    const double down = y - above;
    const dvec3 upper = glm::mix(dvec3(image.at(x0, y0)), dvec3(image.at(x1, y0)), across);
    const dvec3 lower = glm::mix(dvec3(image.at(x0, y1)), dvec3(image.at(x1, y1)), across);
    return glm::mix(upper, lower, down);
  }
};

}  // namespace

dvec3 sky_radiance(const Environment& environment, const dvec3& direction) {
  if (!environment.has_sky()) return dvec3(environment.ambient);
  const dvec3 upright = turn_to_y(environment.up, glm::normalize(direction));
  const dvec3 own = turn_back(upright, static_cast<double>(environment.rotation));
  return static_cast<double>(environment.intensity) * std::visit(Radiance{own}, environment.sky);
}

}  // namespace promin
