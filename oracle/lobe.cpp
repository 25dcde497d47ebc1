// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/lobe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "device_scene/lobe_table.h"
#include "oracle/quadrature.h"

namespace promin::oracle {
namespace {

constexpr Real kRealPi = std::numbers::pi_v<Real>;

/// The smallest cosine to the eye in the visibility term. Vertex normals may point away from the eye.
constexpr Real kLeastLobeCosine = 0x1p-10L;
/// The smallest alpha for highlights. Sources are points, so a smooth surface would otherwise not show them.
constexpr Real kLeastAlphaOfSources = 0.002L;
/// The roughness up to which a mirror ray contributes all reflected light, and the roughness from which it contributes
/// none.
constexpr Real kSharpestBlur = 0.1L;
constexpr Real kRoughestMirror = 0.4L;
/// The mean of (1 - c)^5 over the hemisphere, weighted by the cosine c.
constexpr Real kMeanGrazing = 1.0L / 21;

Real fifth_power(Real x) {
  return x * x * x * x * x;
}

/// Returns D. The sum below is another form of glTF's (N.H)^2 (alpha^2 - 1) + 1, with less rounding.
Real density_of_sine_square(Real sine_square, Real alpha) {
  const Real sum = alpha * alpha * (1 - sine_square) + sine_square;
  return alpha * alpha / (kRealPi * sum * sum);
}

/// Returns the fraction of the reflected light that a mirror ray contributes.
Real sharpness_of(Real roughness) {
  const Real x = std::clamp((roughness - kSharpestBlur) / (kRoughestMirror - kSharpestBlur), Real(0), Real(1));
  return 1 - x * x * (3 - 2 * x);
}

Real alpha_of_sources_of(Real roughness) {
  return std::max(roughness * roughness, kLeastAlphaOfSources);
}

/// Returns the radiance of a source's light that facets with a reflectance of 1 reflect. The source causes an
/// irradiance of 1 perpendicular to its direction.
Real facet_radiance(const LobeAngles& angles, Real alpha) {
  return angles.l * visibility(std::max(angles.v, kLeastLobeCosine), angles.l, alpha) *
         microfacet_density(angles.theta, alpha);
}

LobeShares mix(const LobeShares& a, const LobeShares& b, Real weight) {
  return {(1 - weight) * a.all + weight * b.all, (1 - weight) * a.grazing + weight * b.grazing};
}

/// The numbers of the device's table. They are entries of 16 bits in cells of four.
class LobeTable {
 public:
  explicit LobeTable(std::vector<glm::uvec4> cells)
      : cells_(std::move(cells)), side_(static_cast<size_t>(std::lround(std::sqrt(cells_.size()))) + 1) {}

  /// Returns shares that are interpolated between the entries.
  LobeShares look_up(Real v, Real roughness) const {
    const Real last = static_cast<Real>(side_ - 1);
    const Real x = last * std::sqrt(std::clamp(v, Real(0), Real(1)));
    const Real y = last * roughness;
    const size_t column = std::min(static_cast<size_t>(x), side_ - 2);
    const size_t row = std::min(static_cast<size_t>(y), side_ - 2);
    const LobeShares low = mix(entry(column, row), entry(column + 1, row), x - column);
    const LobeShares high = mix(entry(column, row + 1), entry(column + 1, row + 1), x - column);
    return mix(low, high, y - row);
  }

 private:
  LobeShares entry(size_t column, size_t row) const {
    const size_t x = std::min(column, side_ - 2);
    const size_t y = std::min(row, side_ - 2);
    const uint32_t word = cells_[y * (side_ - 1) + x][static_cast<int>(2 * (row - y) + (column - x))];
    return {(word % 65536) / 65535.0L, (word / 65536) / 65535.0L};
  }

  std::vector<glm::uvec4> cells_;
  size_t side_;
};

/// Returns edges of panels on [a, b]. The sizes of panels grow by a factor of 3, starting from `finest` at a and, if
/// `is_two_sided`, also at b.
std::vector<Real> make_panels(Real a, Real b, Real finest, bool is_two_sided) {
  std::vector<Real> edges = {a};
  const Real reach = is_two_sided ? (b - a) / 2 : b - a;
  for (Real at = finest; at < reach / 2; at *= 3) edges.push_back(a + at);
  const size_t count = edges.size();
  if (is_two_sided) {
    edges.push_back(a + reach);
    for (size_t i = count; i-- > 1;) edges.push_back(b - (edges[i] - a));
  }
  edges.push_back(b);
  return edges;
}

template <typename Function>
void integrate(const std::vector<Real>& panels, const Function& add) {
  for (size_t i = 0; i + 1 < panels.size(); ++i) {
    if (!(panels[i + 1] > panels[i])) continue;
    for (const QuadratureNode& node : gauss_nodes<12>(panels[i], panels[i + 1])) add(node.place, node.weight);
  }
}

}  // namespace

Real microfacet_density(Real theta, Real alpha) {
  const Real sine = std::sin(theta);
  return density_of_sine_square(sine * sine, alpha);
}

Real visibility(Real v, Real l, Real alpha) {
  const Real a2 = alpha * alpha;
  return 1 / (2 * (l * std::sqrt(v * v + a2 * (1 - v * v)) + v * std::sqrt(l * l + a2 * (1 - l * l))));
}

LobeShares look_up_lobe_shares(Real v, Real roughness) {
  static const LobeTable kTable(make_lobe_table());
  return kTable.look_up(v, roughness);
}

Real look_up_sheen_share(Real v, Real roughness) {
  static const LobeTable kTable(make_sheen_table());
  return 2 * kTable.look_up(std::max(v, kLeastLobeCosine), roughness).all;
}

LobeShares integrate_lobe_shares(Real v, Real roughness) {
  if (roughness == 0) return {1, fifth_power(1 - v)};
  const Real alpha = roughness * roughness;
  const Real sine = std::sqrt(1 - v * v);
  const Real tilt = std::acos(v);
  // Directions to the light have polar coordinates around the mirrored direction. Azimuths are counted from the highest
  // point. The eye is at (sine, 0, v), and the normal is (0, 0, 1).
  LobeShares sum{0, 0};
  const auto add_ring = [&](Real angle, Real ring_weight) {
    const Real along = std::cos(angle);
    const Real across = std::sin(angle);
    // Only directions above the horizon count.
    const Real highest_cosine = across * sine > 0 ? -along * v / (across * sine) : -kInfinity;
    const Real last = std::acos(std::clamp(highest_cosine, Real(-1), Real(1)));
    integrate(make_panels(0, last, 1e-3L, true), [&](Real azimuth, Real weight) {
      // Nodes in double are exact enough and much faster.
      const Real forth = across * Real(std::cos(static_cast<double>(azimuth)));
      const Real aside = across * Real(std::sin(static_cast<double>(azimuth)));
      const Vector to_light(-along * sine + forth * v, aside, along * v + forth * sine);
      if (!(to_light.z > 0)) return;
      const Vector sum_of_ways = to_light + Vector(sine, 0, v);
      const Real sine_square =
          (sum_of_ways.x * sum_of_ways.x + sum_of_ways.y * sum_of_ways.y) / glm::dot(sum_of_ways, sum_of_ways);
      // The factor 2 stands for both halves of the ring.
      const Real share = 2 * ring_weight * weight * across * to_light.z * visibility(v, to_light.z, alpha) *
                         density_of_sine_square(sine_square, alpha);
      sum.all += share;
      sum.grazing += share * fifth_power(1 - glm::length(sum_of_ways) / 2);
    });
  };
  // First come the whole rings, then the rings that the horizon cuts.
  const Real whole = kRealPi / 2 - tilt;
  integrate(make_panels(0, whole, alpha / 4, false), add_ring);
  integrate(make_panels(whole, whole + 2 * tilt, std::min(alpha, tilt) / 4, false), add_ring);
  return sum;
}

namespace {

constexpr Real kLeastSheenRoughness = 0.07L;

Real sheen_alpha_of(Real roughness) {
  const Real held = std::max(roughness, kLeastSheenRoughness);
  return held * held;
}

/// Returns the curve L of the extension's text, "Sheen visibility". Its coefficients are interpolated between two sets,
/// depending on alpha.
Real fitted_curve(Real x, Real alpha) {
  const Real smooth = (1 - alpha) * (1 - alpha);
  const auto between = [&](Real at_one, Real at_zero) { return (1 - smooth) * at_one + smooth * at_zero; };
  const Real height = between(21.5473L, 25.3245L);
  const Real width = between(3.82987L, 3.32435L);
  const Real power = between(0.19823L, 0.16801L);
  const Real slope = between(-1.97760L, -1.27393L);
  const Real shift = between(-4.32054L, -4.85967L);
  return height / (1 + width * std::pow(x, power)) + slope * x + shift;
}

Real sheen_lambda(Real cosine, Real alpha) {
  if (cosine < 0.5L) return std::exp(fitted_curve(cosine, alpha));
  return std::exp(2 * fitted_curve(0.5L, alpha) - fitted_curve(1 - cosine, alpha));
}

Real sheen_visibility(Real v, Real l, Real alpha) {
  return std::min(1 / ((1 + sheen_lambda(v, alpha) + sheen_lambda(l, alpha)) * 4 * v * l), Real(1));
}

}  // namespace

Real integrate_sheen_share(Real v, Real roughness) {
  constexpr int kRings = 160;
  constexpr int kAzimuths = 128;
  const Real alpha = sheen_alpha_of(roughness);
  const Real sine = std::sqrt(1 - v * v);
  Real sum = 0;
  for (int ring = 0; ring < kRings; ++ring) {
    // Rings are denser at the horizon, near which visibility changes fastest.
    const Real place = (ring + 0.5L) / kRings;
    const Real l = place * place * place;
    const Real across = std::sqrt(1 - l * l);
    Real density = 0;
    for (int i = 0; i < kAzimuths; ++i) {
      const double azimuth = static_cast<double>(kRealPi) * (i + 0.5) / kAzimuths;
      // The azimuth is counted from the eye's. The computation in double is exact enough and much faster.
      const double forth = static_cast<double>(sine) + static_cast<double>(across) * std::cos(azimuth);
      const double aside = static_cast<double>(across) * std::sin(azimuth);
      const double up = static_cast<double>(v + l);
      const double across2 = forth * forth + aside * aside;
      density += std::pow(across2 / (across2 + up * up), static_cast<double>(1 / (2 * alpha)));
    }
    // The factor 2 stands for both halves of the ring.
    density *= (2 + 1 / alpha) / (2 * kRealPi) * 2 * kRealPi / kAzimuths;
    sum += density * sheen_visibility(v, l, alpha) * l * 3 * place * place / kRings;
  }
  return sum;
}

LobeAngles angles_of(const Vector& normal, const Vector& to_eye, const Vector& to_light) {
  const Vector half = glm::normalize(to_eye + to_light);
  LobeAngles angles;
  angles.theta = std::atan2(glm::length(glm::cross(normal, half)), glm::dot(normal, half));
  angles.v = glm::dot(normal, to_eye);
  angles.l = glm::dot(normal, to_light);
  angles.v_h = glm::dot(to_eye, half);
  return angles;
}

Lobe::Part::Part(const Vector& at_normal, Real at_grazing, const LobeShares& shares) : f0(at_normal), f90(at_grazing) {
  const Vector mean = f0 + (f90 - f0) * kMeanGrazing;
  k = Real(1) / (Real(1) - mean * (1 - shares.all));
}

Vector Lobe::Part::reflectance(const LobeShares& shares) const {
  return k * (f0 * (shares.all - shares.grazing) + f90 * shares.grazing);
}

Vector Lobe::Part::fresnel(Real v_h) const {
  return f0 + (f90 - f0) * fifth_power(1 - v_h);
}

namespace {

/// Returns the reflectance at normal incidence (KHR_materials_ior and KHR_materials_specular). For an index of 0, the
/// quotient is 1.
Vector reflectance_at_normal(const MetallicRoughness& material) {
  const Real quotient = (Real(material.ior) - 1) / (Real(material.ior) + 1);
  return glm::min(quotient * quotient * Vector(material.specular_color), Vector(1)) * Real(material.specular);
}

Vector base_of(const MetallicRoughness& material, const Vector& vertex_color) {
  return glm::min(Vector(material.base_color) * vertex_color, Vector(1));
}

/// Returns the reflectance at normal incidence for which Schlick's formula gives the film's reflectance at this cosine,
/// or at the smallest cosine at which films are seen.
Vector under_film(const MetallicRoughness& material, const Vector& f0, Real f90, Real cosine) {
  const bool is_total = f90 >= 1 && std::min({f0.x, f0.y, f0.z}) >= 1;
  if (material.iridescence == 0 || is_total) return f0;
  const Real seen = std::clamp(cosine, Real(0x1p-6L), Real(1));
  const Real grazing = fifth_power(1 - seen);
  const Vector reflected = film_reflectance(f0, material.iridescence_ior, material.iridescence_thickness_maximum, seen);
  const Vector at_normal = glm::clamp((reflected - f90 * grazing) / (1 - grazing), Vector(0), Vector(1));
  return glm::mix(f0, at_normal, Real(material.iridescence));
}

/// Returns the eye's sensitivity, from section "Spectral sensitivity" of Belcour and Barla's model in the extension's
/// text.
Vector sensitivity(Real path_difference, const Vector& shift) {
  const Real phase = 2 * kRealPi * path_difference * 1e-9L;
  const auto lobe = [&](Real value, Real place, Real variance, Real shifted) {
    return value * std::sqrt(2 * kRealPi * variance) * std::cos(place * phase + shifted) *
           std::exp(-phase * phase * variance) / 1.0685e-7L;
  };
  const Real x = lobe(5.4856e-13L, 1.6810e6L, 4.3278e9L, shift.x) + lobe(9.7470e-14L, 2.2399e6L, 4.5282e9L, shift.x);
  const Real y = lobe(4.4201e-13L, 1.7953e6L, 9.3046e9L, shift.y);
  const Real z = lobe(5.2481e-13L, 2.2084e6L, 6.6121e9L, shift.z);
  return {3.2404542L * x - 1.5371385L * y - 0.4985314L * z, -0.9692660L * x + 1.8760108L * y + 0.0415560L * z,
          0.0556434L * x - 0.2040259L * y + 1.0572252L * z};
}

Real schlick(Real f0, Real cosine) {
  return f0 + (1 - f0) * fifth_power(1 - cosine);
}

}  // namespace

Vector film_reflectance(const Vector& f0, Real ior, Real thickness, Real cosine) {
  const Real step = std::clamp(thickness / 0.03L, Real(0), Real(1));
  const Real film = std::lerp(Real(1), ior, step * step * (3 - 2 * step));
  const Real cosine_inside = std::sqrt(1 - (1 - cosine * cosine) / (film * film));
  const auto square = [](Real x) { return x * x; };
  const Real r12 = schlick(square((film - 1) / (film + 1)), cosine);
  Vector r23;
  Vector shift;
  for (int i = 0; i < 3; ++i) {
    const Real root = std::sqrt(std::clamp(f0[i], Real(0), Real(0.9999L)));
    const Real base = (1 + root) / (1 - root);
    r23[i] = schlick(square((base - film) / (base + film)), cosine_inside);
    shift[i] = base < film ? 2 * kRealPi : kRealPi;
  }
  const Vector round_trip = glm::clamp(r12 * r23, Vector(1e-5L), Vector(0.9999L));
  const Vector body = square(1 - r12) * r23 / (Real(1) - round_trip);
  const Real difference = 2 * film * thickness * cosine_inside;
  Vector sum = r12 + body;
  Vector amplitude = body - (1 - r12);
  for (int wave = 1; wave <= 2; ++wave) {
    amplitude *= glm::sqrt(round_trip);
    sum += Real(2) * amplitude * sensitivity(wave * difference, Real(wave) * shift);
  }
  return glm::clamp(sum, Vector(0), Vector(1));
}

GrainAlphas grain_alphas(Real roughness, Real strength) {
  const Real alpha = roughness * roughness;
  return {std::lerp(alpha, Real(1), strength * strength), alpha};
}

Real GrainAlphas::mean_roughness() const {
  return std::pow((along * along + across * across) / 2, Real(0.25L));
}

Lobe::Lobe(const MetallicRoughness& material, const Vector& vertex_color, const LobeShares& shares, Real cosine_to_eye)
    : metallic_(material.metallic),
      roughness_(material.roughness),
      dielectric_(under_film(material, reflectance_at_normal(material), material.specular, cosine_to_eye),
                  material.specular, shares),
      metal_(under_film(material, base_of(material, vertex_color), 1, cosine_to_eye), 1, shares) {
  const Vector of_dielectric = dielectric_.reflectance(shares);
  reflectance_ = (1 - metallic_) * of_dielectric + metallic_ * metal_.reflectance(shares);
  let_in_ = (1 - metallic_) * (1 - largest(of_dielectric));
  albedo_ = let_in_ * base_of(material, vertex_color);
}

Real Lobe::sharpness() const {
  return sharpness_of(roughness_);
}

Real Lobe::alpha_of_sources() const {
  return alpha_of_sources_of(roughness_);
}

Vector Lobe::highlights_of_all(const LobeShares& shares) const {
  return (1 - metallic_) * dielectric_.reflectance(shares) + metallic_ * metal_.reflectance(shares);
}

Vector Lobe::facets(Real v_h) const {
  return (1 - metallic_) * dielectric_.k * dielectric_.fresnel(v_h) + metallic_ * metal_.k * metal_.fresnel(v_h);
}

Vector Lobe::highlight(const LobeAngles& angles) const {
  return facets(angles.v_h) * facet_radiance(angles, alpha_of_sources());
}

// Returns a highlight, with the extension's D and V written as in its text.
Vector Lobe::highlight(const GrainWays& ways, const GrainAlphas& alphas) const {
  const Real at = std::max(alphas.along, kLeastAlphaOfSources);
  const Real ab = std::max(alphas.across, kLeastAlphaOfSources);
  const Vector half = glm::normalize(ways.to_eye + ways.to_light);
  const Vector f(ab * half.x, at * half.y, at * ab * half.z);
  const Real w2 = at * ab / glm::dot(f, f);
  const Real density = at * ab * w2 * w2 / kRealPi;
  const Real v = std::max(ways.to_eye.z, kLeastLobeCosine);
  const Real l = std::max(ways.to_light.z, Real(0));
  const Real to_eye = l * glm::length(Vector(at * ways.to_eye.x, ab * ways.to_eye.y, v));
  const Real to_light = v * glm::length(Vector(at * ways.to_light.x, ab * ways.to_light.y, l));
  return facets(glm::dot(ways.to_eye, half)) * (l * density / (2 * (to_eye + to_light)));
}

ClearCoat::ClearCoat(const MetallicRoughness& material, Real cosine_to_eye)
    // A vertex normal may point away from the eye, so the cosine is limited.
    : weight_(material.clearcoat * (0.04L + 0.96L * fifth_power(1 - std::max(cosine_to_eye, Real(0))))),
      roughness_(material.clearcoat_roughness),
      reflectance_(look_up_lobe_shares(cosine_to_eye, roughness_).all) {}

Real ClearCoat::sharpness() const {
  return sharpness_of(roughness_);
}

Real ClearCoat::alpha_of_sources() const {
  return alpha_of_sources_of(roughness_);
}

Real ClearCoat::highlight(const LobeAngles& angles) const {
  return facet_radiance(angles, alpha_of_sources());
}

Sheen::Sheen(const MetallicRoughness& material, Real cosine_to_eye)
    : color_(material.sheen_color),
      largest_(largest(color_)),
      roughness_(material.sheen_roughness),
      share_(look_up_sheen_share(cosine_to_eye, roughness_)) {}

Vector Sheen::reflectance() const {
  return std::min(share_, Real(1)) * color_;
}

Real Sheen::left() const {
  return 1 - largest_ * std::min(share_, Real(1));
}

Real Sheen::left(Real cosine_to_light) const {
  return std::min(left(), 1 - largest_ * std::min(look_up_sheen_share(cosine_to_light, roughness_), Real(1)));
}

Vector Sheen::highlight(const LobeAngles& angles) const {
  const Real alpha = sheen_alpha_of(roughness_);
  const Real density = (2 + 1 / alpha) * std::pow(std::sin(angles.theta), 1 / alpha) / (2 * kRealPi);
  const Real sent = density * sheen_visibility(std::max(angles.v, kLeastLobeCosine), angles.l, alpha) * angles.l;
  return color_ * (sent / std::max(share_, Real(1)));
}

}  // namespace promin::oracle
