// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/sky.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <variant>
#include <vector>

#include "oracle/quadrature.h"

namespace promin::oracle {
namespace {

// Skies are integrated over thousands of directions for each pixel, so the computation is in double. Its rounding
// errors are far smaller than the errors of the quadrature.
constexpr double kPi = std::numbers::pi;

double radians(double degrees) {
  return degrees * kPi / 180;
}

double smoothstep(double lo, double hi, double x) {
  const double t = std::clamp((x - lo) / (hi - lo), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double elevation_of(const dvec3& d) {
  return std::atan2(d.y, std::sqrt(d.x * d.x + d.z * d.z));
}

/// A lamp of the studio. Angles are in degrees, to the right as seen by the viewer.
struct Lamp {
  double azimuth;
  double elevation;
  double width;
  double height;
  double radiance;
};
constexpr Lamp kLamps[] = {{-45, 38, 46, 36, 1.7}, {70, 12, 30, 64, 0.8}, {165, 32, 60, 16, 1.8}, {0, 72, 60, 34, 0.7}};

/// Returns the weight for an angle from a lamp's middle: 1 inside, 0 outside, and a smoothstep within 15 % of the half
/// size at its edge.
double within(double angle, double size_deg) {
  const double half = radians(size_deg) / 2;
  return 1 - smoothstep(0.85 * half, 1.15 * half, std::abs(angle));
}

/// A lamp's place in the sky.
struct LampFrame {
  dvec3 middle;
  dvec3 right;
  dvec3 up;

  LampFrame(const Lamp& lamp, double front) {
    const double azimuth = front + radians(lamp.azimuth);
    const double elevation = radians(lamp.elevation);
    middle =
        dvec3(std::sin(azimuth) * std::cos(elevation), std::sin(elevation), std::cos(azimuth) * std::cos(elevation));
    right = dvec3(std::cos(azimuth), 0, -std::sin(azimuth));
    up = glm::cross(middle, right);
  }
};

/// Returns the radiance from a direction of the sky before the sky is rotated: azimuth 0 is +Z, and +X is a quarter to
/// the right for a viewer who stands at +Z and looks at the scene. Each constructor prepares what does not depend on
/// the direction.
struct NoSky {
  dvec3 operator()(const dvec3& /*d*/) const { return dvec3(0); }
};

struct GradientRadiance {
  const GradientSky& sky;

  dvec3 operator()(const dvec3& d) const {
    const double e = std::abs(elevation_of(d)) / (kPi / 2);
    const double curve = static_cast<double>(d.y >= 0 ? sky.top_curve : sky.bottom_curve);
    const double way = 1 - std::pow(std::max(1 - e, 0.0), 1 / curve);
    return glm::mix(dvec3(sky.horizon), dvec3(d.y >= 0 ? sky.top : sky.bottom), way);
  }
};

struct StudioRadiance {
  explicit StudioRadiance(const Studio& studio)
      : front_sine(std::sin(static_cast<double>(studio.front))),
        front_cosine(std::cos(static_cast<double>(studio.front))) {
    for (const Lamp& lamp : kLamps) frames.emplace_back(lamp, static_cast<double>(studio.front));
  }

  dvec3 operator()(const dvec3& d) const {
    // `back` is 0 for the direction to the studio's front, and 1 for the opposite direction.
    const double back = (1 - d.x * front_sine - d.z * front_cosine) / 2;
    const double horizon = 0.20 + 0.16 * back;
    const double end = d.y >= 0 ? 0.16 : 0.05 + 0.19 * back;
    double sum = horizon + (end - horizon) * (d.y >= 0 ? smoothstep(0, 0.6, d.y) : smoothstep(0, 0.2, -d.y));
    for (size_t i = 0; i < frames.size(); ++i) {
      const double ahead = glm::dot(d, frames[i].middle);
      if (ahead <= 0) continue;
      const double across = within(std::atan2(glm::dot(d, frames[i].right), ahead), kLamps[i].width);
      if (across == 0) continue;
      sum += kLamps[i].radiance * across * within(std::atan2(glm::dot(d, frames[i].up), ahead), kLamps[i].height);
    }
    return dvec3(sum);
  }

  double front_sine;
  double front_cosine;
  std::vector<LampFrame> frames;
};

/// A pixel's value is the radiance at its centre. Between the centres the radiance is interpolated.
struct PanoramaRadiance {
  const Panorama& panorama;

  dvec3 operator()(const dvec3& d) const {
    const Image& image = *panorama.image;
    const double column = (0.5 + std::atan2(d.x, -d.z) / (2 * kPi)) * image.size.x - 0.5;
    const double row = (0.5 - elevation_of(d) / kPi) * image.size.y - 0.5;
    const auto pixel = [&](int64_t x, int64_t y) {
      const int64_t width = image.size.x;
      const auto in_row = static_cast<size_t>((x + width) % width);
      const auto in_column = static_cast<size_t>(std::clamp<int64_t>(y, 0, image.size.y - 1));
      return dvec3(image.pixels[in_column * image.size.x + in_row]);
    };
    const auto x = static_cast<int64_t>(std::floor(column));
    const auto y = static_cast<int64_t>(std::floor(row));
    const double part_x = column - static_cast<double>(x);
    const double part_y = row - static_cast<double>(y);
    return glm::mix(glm::mix(pixel(x, y), pixel(x + 1, y), part_x),
                    glm::mix(pixel(x, y + 1), pixel(x + 1, y + 1), part_x), part_y);
  }
};

/// Returns a direction after the rotation that takes the unit vector `up` to +Y by the shortest way (the formula of
/// Rodrigues).
dvec3 stand_up(const dvec3& direction, const dvec3& up) {
  const dvec3 axis = glm::cross(up, dvec3(0, 1, 0));
  const double cosine = up.y;
  if (cosine < -1 + 1e-12) return {-direction.x, -direction.y, direction.z};
  return cosine * direction + glm::cross(axis, direction) + glm::dot(axis, direction) / (1 + cosine) * axis;
}

/// The radiance of an environment's sky by direction.
class SkyRadiance {
 public:
  explicit SkyRadiance(const Environment& environment)
      : sine_(std::sin(static_cast<double>(environment.rotation))),
        cosine_(std::cos(static_cast<double>(environment.rotation))),
        up_(environment.up),
        intensity_(static_cast<double>(environment.intensity)),
        sky_(std::visit([](const auto& sky) { return prepare(sky); }, environment.sky)) {}

  dvec3 operator()(const dvec3& in_world) const {
    const dvec3 direction = stand_up(in_world, up_);
    // The sky is rotated from +Z towards +X, so the direction is rotated by the same angle the other way.
    const dvec3 in_sky(direction.x * cosine_ - direction.z * sine_, direction.y,
                       direction.x * sine_ + direction.z * cosine_);
    return intensity_ * std::visit([&](const auto& sky) { return sky(in_sky); }, sky_);
  }

 private:
  using Prepared = std::variant<NoSky, GradientRadiance, StudioRadiance, PanoramaRadiance>;
  static Prepared prepare(const std::monostate& /*sky*/) { return NoSky(); }
  static Prepared prepare(const GradientSky& sky) { return GradientRadiance{sky}; }
  static Prepared prepare(const Studio& studio) { return StudioRadiance(studio); }
  static Prepared prepare(const Panorama& panorama) { return PanoramaRadiance{panorama}; }

  double sine_;
  double cosine_;
  dvec3 up_;
  double intensity_;
  Prepared sky_;
};

/// Returns the functions of the bands, indexed like the coefficients, with the constants of docs/model.md.
std::array<double, 9> band_functions(const dvec3& n) {
  return {1, n.y, n.z, n.x, n.x * n.y, n.y * n.z, 3 * n.z * n.z - 1, n.z * n.x, n.x * n.x - n.y * n.y};
}
constexpr double kBandFactors[] = {1 / (4 * kPi),   1 / (2 * kPi),  1 / (2 * kPi),   1 / (2 * kPi),  15 / (16 * kPi),
                                   15 / (16 * kPi), 5 / (64 * kPi), 15 / (16 * kPi), 15 / (64 * kPi)};

// The quadrature over a lobe: rings of directions, a node each.
constexpr double kLobePanels[] = {0, 0.17, 0.33, 0.5, 0.65, 0.8, 0.9, 0.98, 1};
constexpr int kLobeNodes = 8;
constexpr int kLobeAzimuths = 64;

/// Returns cosine and sine of the azimuths of all rings. Each ring is rotated relative to the previous one.
std::vector<dvec2> make_circle_of_lobe() {
  std::vector<dvec2> turns;
  const int rings = kLobeNodes * (static_cast<int>(std::size(kLobePanels)) - 1);
  for (int ring = 1; ring <= rings; ++ring) {
    for (int i = 0; i < kLobeAzimuths; ++i) {
      const double azimuth = 2 * kPi * (i + 0.618 * ring) / kLobeAzimuths;
      turns.emplace_back(std::cos(azimuth), std::sin(azimuth));
    }
  }
  return turns;
}

}  // namespace

Surroundings::Surroundings(const Environment& environment, bool is_source)
    : environment_(environment), is_source_(is_source) {
  if (!has_sky()) return;
  std::array<dvec3, 9> sums{};
  double least = std::numeric_limits<double>::infinity();
  double most = 0;
  const SkyRadiance sky(environment_);
  // Panels begin at the horizon, where skies have a crease.
  constexpr int kPanels = 64;
  constexpr int kAzimuths = 1024;
  std::array<dvec2, kAzimuths> circle;
  for (int i = 0; i < kAzimuths; ++i) {
    const double azimuth = 2 * kPi * (i + 0.5) / kAzimuths;
    circle[static_cast<size_t>(i)] = {std::sin(azimuth), std::cos(azimuth)};
  }
  for (int panel = -kPanels; panel < kPanels; ++panel) {
    for (const QuadratureNode& y : gauss_nodes<8>(panel / Real{kPanels}, (panel + 1) / Real{kPanels})) {
      const auto height = static_cast<double>(y.place);
      const double across = std::sqrt(1 - height * height);
      for (const dvec2& turn : circle) {
        const dvec3 direction(across * turn.x, height, across * turn.y);
        const dvec3 radiance = sky(direction);
        const dvec3 light = static_cast<double>(y.weight) * 2 * kPi / kAzimuths * radiance;
        least = std::min({least, radiance.x, radiance.y, radiance.z});
        most = std::max({most, radiance.x, radiance.y, radiance.z});
        const std::array<double, 9> functions = band_functions(direction);
        for (size_t band = 0; band < 9; ++band) sums[band] += functions[band] * light;
      }
    }
  }
  range_ = most - least;
  for (size_t band = 0; band < 9; ++band) bands_[band] = Vector(kBandFactors[band] * sums[band]);
}

Vector Surroundings::radiance(const Vector& direction) const {
  return has_sky() ? Vector(SkyRadiance(environment_)(dvec3(direction))) : Vector(environment_.ambient);
}

Vector Surroundings::irradiance(const Vector& normal) const {
  if (!has_sky()) return Vector(environment_.ambient);
  const std::array<double, 9> functions = band_functions(dvec3(normal));
  Vector sum(0);
  for (size_t band = 0; band < 9; ++band) sum += Real(functions[band]) * bands_[band];
  return glm::max(sum, Vector(0));
}

Vector Surroundings::lobe_mean(const Vector& direction, Real roughness) const {
  if (!has_sky() || roughness <= 0) return radiance(direction);
  const SkyRadiance sky(environment_);
  const double alpha2 = std::pow(static_cast<double>(roughness), 4);
  const dvec3 axis(direction);
  const dvec3 aside =
      glm::normalize(std::abs(axis.y) < 0.9 ? glm::cross(axis, dvec3(0, 1, 0)) : glm::cross(axis, dvec3(1, 0, 0)));
  const dvec3 other = glm::cross(axis, aside);
  // With V = N, the angle tau of the light is twice that of the half vector. s = sin^2(tau / 2) runs from 0 to 1/2, and
  // dw = 2 ds d(azimuth). D is alpha^2 / (pi (alpha^2 + (1 - alpha^2) s)^2), so its integral q over s, as a fraction of
  // the whole, is a quotient, and each node in q stands for the same fraction of D.
  const double end = alpha2 + (1 - alpha2) / 2;
  static const std::vector<dvec2> circle = make_circle_of_lobe();
  dvec3 sum(0);
  double weights = 0;
  size_t place_in_circle = 0;
  for (size_t panel = 0; panel + 1 < std::size(kLobePanels); ++panel) {
    for (const QuadratureNode& q : gauss_nodes<kLobeNodes>(kLobePanels[panel], kLobePanels[panel + 1])) {
      const auto place = static_cast<double>(q.place);
      const double s = alpha2 * place / (2 * (end - (1 - alpha2) / 2 * place));
      const double cosine = 1 - 2 * s;
      const double sine = std::sqrt(1 - cosine * cosine);
      dvec3 of_ring(0);
      for (int i = 0; i < kLobeAzimuths; ++i) {
        const dvec2& turn = circle[place_in_circle++];
        of_ring += sky(cosine * axis + sine * (turn.x * aside + turn.y * other));
      }
      const double weight = static_cast<double>(q.weight) * cosine;
      sum += weight / kLobeAzimuths * of_ring;
      weights += weight;
    }
  }
  return Vector(sum / weights);
}

Real Surroundings::map_error(Real roughness) const {
  // The errors that tests/gpu/oracle_picture_test.cpp measures, rounded up.
  if (std::holds_alternative<Studio>(environment_.sky)) {
    return range_ * (roughness < 0.1L ? 0.13L : 0.065L);
  }
  return range_ * (std::holds_alternative<GradientSky>(environment_.sky) ? 0.02L : 0.035L);
}

}  // namespace promin::oracle
