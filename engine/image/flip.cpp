// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "image/flip.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <span>

#include "core/parallel.h"

namespace promin {
namespace {

// Sections and equations in the comments refer to the FLIP paper. All computations are in double.

constexpr double kPi = std::numbers::pi;

/// A number for each pixel of a picture.
class Plane {
 public:
  explicit Plane(const uvec2& size) : width_(size.x), height_(size.y), values_(static_cast<size_t>(size.x) * size.y) {}

  size_t width() const { return width_; }
  size_t height() const { return height_; }
  double& at(size_t x, size_t y) { return values_[y * width_ + x]; }
  double at(size_t x, size_t y) const { return values_[y * width_ + x]; }

 private:
  size_t width_;
  size_t height_;
  std::vector<double> values_;
};

void for_each_row(size_t rows, const std::function<void(size_t)>& task) {
  constexpr size_t kRowsOfTask = 16;
  for_each_chunk(rows, kRowsOfTask, 0, [&](size_t begin, size_t end) {
    for (size_t y = begin; y < end; ++y) task(y);
  });
}

/// The weights at the distances -radius...radius.
using Kernel = std::vector<double>;

/// Convolves rows with one kernel and columns with another. Beyond the picture, the border pixels are repeated.
Plane convolve(const Plane& source, const Kernel& along_x, const Kernel& along_y) {
  const uvec2 size(static_cast<uint32_t>(source.width()), static_cast<uint32_t>(source.height()));
  Plane by_row(size);
  Plane result(size);
  const auto sum = [](const Kernel& kernel, size_t place, size_t count, const auto& value_at) {
    const auto radius = static_cast<std::ptrdiff_t>(kernel.size() / 2);
    double total = 0.0;
    for (std::ptrdiff_t i = -radius; i <= radius; ++i) {
      const std::ptrdiff_t last = static_cast<std::ptrdiff_t>(count) - 1;
      const std::ptrdiff_t at = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(place) + i, 0, last);
      total += kernel[static_cast<size_t>(i + radius)] * value_at(static_cast<size_t>(at));
    }
    return total;
  };
  for_each_row(source.height(), [&](size_t y) {
    for (size_t x = 0; x < source.width(); ++x) {
      by_row.at(x, y) = sum(along_x, x, source.width(), [&](size_t i) { return source.at(i, y); });
    }
  });
  for_each_row(source.height(), [&](size_t y) {
    for (size_t x = 0; x < source.width(); ++x) {
      result.at(x, y) = sum(along_y, y, source.height(), [&](size_t i) { return by_row.at(x, i); });
    }
  });
  return result;
}

/// Scales the weights so that the positive weights add up to 1 and the negative weights to -1 (section 4.2). A picture
/// without features then gives 0.
void normalize_signs(Kernel& kernel) {
  double positive = 0.0;
  double negative = 0.0;
  for (const double weight : kernel) (weight > 0.0 ? positive : negative) += weight;
  for (double& weight : kernel) {
    if (weight != 0.0) weight /= weight > 0.0 ? positive : -negative;
  }
}

template <typename Function>
Kernel make_kernel(int radius, const Function& weight_at) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight_at(static_cast<double>(i)));
  normalize_signs(kernel);
  return kernel;
}

// Functions for colours. They convert linear RGB to XYZ (D65), and to the space for whose axes the eye's contrast
// sensitivity is known (equation 2).

using Matrix = glm::dmat3;

// The columns are the XYZ colours of R, G and B (IEC 61966-2-1), in exact fractions.
const Matrix kToXyz = glm::transpose(Matrix(10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0,  //
                                            2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0,    //
                                            1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0));

const dvec3 kWhite = kToXyz * dvec3(1.0);

dvec3 to_opponent(const dvec3& rgb) {
  const dvec3 p = kToXyz * rgb / kWhite;
  return {116.0 * p.y - 16.0, 500.0 * (p.x - p.y), 200.0 * (p.y - p.z)};
}

dvec3 opponent_to_rgb(const dvec3& c) {
  static const Matrix to_rgb = glm::inverse(kToXyz);
  const double y = (c.x + 16.0) / 116.0;
  return to_rgb * (dvec3(y + c.y / 500.0, y, y - c.z / 200.0) * kWhite);
}

/// Converts to CIELAB with a chroma that increases with lightness, as Hunt found (equation 3).
dvec3 to_hunt_lab(const dvec3& rgb) {
  const dvec3 p = kToXyz * rgb / kWhite;
  constexpr double kBend = 6.0 / 29.0;
  const auto f = [](double t) {
    return t > kBend * kBend * kBend ? std::cbrt(t) : t / (3.0 * kBend * kBend) + 4.0 / 29.0;
  };
  const double lightness = 116.0 * f(p.y) - 16.0;
  return {lightness, 0.01 * lightness * 500.0 * (f(p.x) - f(p.y)), 0.01 * lightness * 200.0 * (f(p.y) - f(p.z))};
}

/// Returns the HyAB distance (equation 4).
double hyab(const dvec3& a, const dvec3& b) {
  const dvec3 d = a - b;
  return std::abs(d.x) + std::hypot(d.y, d.z);
}

// The eye's contrast sensitivity as sums of Gaussians (section 4.1.1 and table 1).

struct Gaussian {
  double a;
  double b;
};
constexpr Gaussian kAchromatic = {1.0, 0.0047};
constexpr Gaussian kRedGreen = {1.0, 0.0053};
constexpr Gaussian kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr Gaussian kWidest = kBlueYellow[0];

int sensitivity_radius(double pixels_per_degree) {
  return static_cast<int>(std::ceil(3.0 * std::sqrt(kWidest.b / (2.0 * kPi * kPi)) * pixels_per_degree));
}

double weight_of(const Gaussian& gaussian, double pixels, double pixels_per_degree) {
  const double degrees = pixels / pixels_per_degree;
  return std::exp(-kPi * kPi * degrees * degrees / gaussian.b);
}

/// Filters a channel with a sum of Gaussians. All weights together add up to 1.
Plane filter(const Plane& channel, std::span<const Gaussian> gaussians, double pixels_per_degree) {
  const int radius = sensitivity_radius(pixels_per_degree);
  Plane result(uvec2(channel.width(), channel.height()));
  double total = 0.0;
  for (const Gaussian& gaussian : gaussians) {
    const auto weight_at = [&](double x) { return weight_of(gaussian, x, pixels_per_degree); };
    double sum = 0.0;
    for (int i = -radius; i <= radius; ++i) sum += weight_at(i);
    const double share = gaussian.a * std::sqrt(kPi / gaussian.b) * sum * sum;
    total += share;
    const Kernel kernel = make_kernel(radius, weight_at);
    const Plane part = convolve(channel, kernel, kernel);
    for (size_t y = 0; y < result.height(); ++y) {
      for (size_t x = 0; x < result.width(); ++x) result.at(x, y) += share * part.at(x, y);
    }
  }
  for (size_t y = 0; y < result.height(); ++y) {
    for (size_t x = 0; x < result.width(); ++x) result.at(x, y) /= total;
  }
  return result;
}

// Detectors of edges and points (section 4.2).

constexpr double kFeatureWidthDegrees = 0.082;

struct FeatureKernels {
  Kernel gaussian;
  Kernel edge;
  Kernel point;

  explicit FeatureKernels(double pixels_per_degree) {
    const double deviation = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
    const auto radius = static_cast<int>(std::ceil(3.0 * deviation));
    const auto bell = [=](double x) { return std::exp(-x * x / (2.0 * deviation * deviation)); };
    gaussian = make_kernel(radius, bell);
    edge = make_kernel(radius, [=](double x) { return -x * bell(x); });
    point = make_kernel(radius, [=](double x) { return (x * x / (deviation * deviation) - 1.0) * bell(x); });
  }
};

/// The data of a picture that FLIP compares.
struct Seen {
  /// The picture, filtered like the eye does, in Hunt's Lab: L, a and b.
  std::vector<dvec3> color;
  /// The strength of an edge and of a point at each pixel.
  std::vector<double> edge;
  std::vector<double> point;
};

Seen see(const Image& picture, double pixels_per_degree) {
  const uvec2 size = picture.size;
  Plane channels[3] = {Plane(size), Plane(size), Plane(size)};
  Plane brightness(size);
  for_each_row(size.y, [&](size_t y) {
    for (size_t x = 0; x < size.x; ++x) {
      const vec3& pixel = picture.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
      dvec3 light(0.0);
      for (int i = 0; i < 3; ++i) light[i] = pixel[i] > 0.0F ? std::min(static_cast<double>(pixel[i]), 1.0) : 0.0;
      const dvec3 c = to_opponent(light);
      for (int i = 0; i < 3; ++i) channels[i].at(x, y) = c[i];
      brightness.at(x, y) = (c.x + 16.0) / 116.0;
    }
  });
  const Plane filtered[3] = {filter(channels[0], {&kAchromatic, 1}, pixels_per_degree),
                             filter(channels[1], {&kRedGreen, 1}, pixels_per_degree),
                             filter(channels[2], kBlueYellow, pixels_per_degree)};
  const FeatureKernels kernels(pixels_per_degree);
  const Plane edges[2] = {convolve(brightness, kernels.edge, kernels.gaussian),
                          convolve(brightness, kernels.gaussian, kernels.edge)};
  const Plane points[2] = {convolve(brightness, kernels.point, kernels.gaussian),
                           convolve(brightness, kernels.gaussian, kernels.point)};
  const size_t count = static_cast<size_t>(size.x) * size.y;
  Seen seen{std::vector<dvec3>(count), std::vector<double>(count), std::vector<double>(count)};
  for_each_row(size.y, [&](size_t y) {
    for (size_t x = 0; x < size.x; ++x) {
      const size_t i = y * size.x + x;
      const dvec3 rgb = opponent_to_rgb({filtered[0].at(x, y), filtered[1].at(x, y), filtered[2].at(x, y)});
      seen.color[i] = to_hunt_lab(glm::clamp(rgb, 0.0, 1.0));
      seen.edge[i] = std::hypot(edges[0].at(x, y), edges[1].at(x, y));
      seen.point[i] = std::hypot(points[0].at(x, y), points[1].at(x, y));
    }
  });
  return seen;
}

constexpr double kColorExponent = 0.7;    // The paper's q_c.
constexpr double kFeatureExponent = 0.5;  // The paper's q_f.
constexpr double kColorKnee = 0.4;        // The paper's p_c.
constexpr double kKneeError = 0.95;       // The paper's p_t.

/// Returns the colour error of section 4.1.3: the error relative to the largest possible error, with the exponent
/// applied.
double color_error(const dvec3& a, const dvec3& b) {
  static const double largest =
      std::pow(hyab(to_hunt_lab({0.0, 1.0, 0.0}), to_hunt_lab({0.0, 0.0, 1.0})), kColorExponent);
  const double error = std::pow(hyab(a, b), kColorExponent);
  const double knee = kColorKnee * largest;
  if (error < knee) return kKneeError / knee * error;
  return kKneeError + (error - knee) / (largest - knee) * (1.0 - kKneeError);
}

}  // namespace

std::vector<float> flip_map(const Image& reference, const Image& test, double pixels_per_degree) {
  const Seen a = see(reference, pixels_per_degree);
  const Seen b = see(test, pixels_per_degree);
  std::vector<float> errors(a.color.size());
  for_each_chunk(errors.size(), size_t{1} << 14, 0, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      const double feature = std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i]));
      const double of_features = std::pow(feature / std::numbers::sqrt2, kFeatureExponent);
      // Section 4.3: features amplify differences of colours.
      errors[i] = static_cast<float>(std::pow(color_error(a.color[i], b.color[i]), 1.0 - of_features));
    }
  });
  return errors;
}

}  // namespace promin
