// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/glass.h"

#include "oracle/surface.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace promin::oracle {
namespace {

struct ReadGlass {
  GlassOf operator()(const Phong& m) const {
    const bool is_clear = m.transmission != vec3(0.0F);
    const bool is_fresnel_mirror = m.fresnel && m.reflection != vec3(0.0F);
    return {is_clear || is_fresnel_mirror, is_clear, false, Real(m.ior)};
  }
  GlassOf operator()(const MetallicRoughness& m) const {
    const bool is_clear = m.transmission > 0 && (m.metallic < 1 || m.metallic_roughness_texture.exists()) && m.ior != 0;
    const Real spread = Real(0.025L) * (Real(m.ior) - 1) * Real(m.dispersion);
    return {is_clear, is_clear, m.thickness == 0, Real(m.ior), std::min(spread, Real(m.ior) - 1)};
  }
  GlassOf operator()(const Unlit&) const { return {}; }
};

/// Returns Fresnel's reflectance from the angles a and b on both sides, which Snell's law relates. It is computed from
/// amplitudes such as sin(a - b).
Real fresnel_of_angles(Real a, Real b) {
  if (a + b == 0) return -1;
  const Real s = std::sin(a - b) / std::sin(a + b);
  const Real p = std::tan(a - b) / std::tan(a + b);
  return (s * s + p * p) / 2;
}

}  // namespace

GlassOf glass_of(const Material& material) {
  GlassOf glass = std::visit(ReadGlass(), material.model);
  // A material that is transparent because of alpha transmits no further light.
  const bool has_alpha = material.alpha < 1 || slots_of(material)[kBaseSlot].exists();
  if (material.alpha_mode == AlphaMode::kBlend && has_alpha) glass.is_clear = false;
  glass.exists = glass.exists && (glass.is_clear || std::holds_alternative<Phong>(material.model));
  return glass;
}

int color_of(const Vector& weight) {
  int color = kGreen;
  int count = 0;
  for (int i = 0; i < 3; ++i) {
    if (!(weight[i] > 0)) continue;
    color = i;
    ++count;
  }
  return count == 1 ? color : kGreen;
}

Real Media::index(int color) const {
  return entered_.empty() ? Real(1) : glass_of(*entered_.back()).index_of(color);
}

Face Media::meet(const Material& material, bool leaves, int color, Media& beyond) const {
  const GlassOf glass = glass_of(material);
  beyond = *this;
  if (!glass.is_clear || glass.is_thin) return {index(color), glass.index_of(color), true};
  if (!leaves) {
    beyond.entered_.push_back(&material);
    // The device stores four media.
    if (beyond.entered_.size() > 4) beyond.entered_.erase(beyond.entered_.begin());
    return {index(color), glass.index_of(color), false};
  }
  const auto last = std::find(entered_.rbegin(), entered_.rend(), &material);
  if (last == entered_.rend()) return {glass.index_of(color), index(color), false};
  beyond.entered_.erase(std::prev(beyond.entered_.end(), 1 + std::distance(entered_.rbegin(), last)));
  // The surface of a solid inside a solid that was entered later does not change the ray.
  if (last != entered_.rbegin()) return {index(color), index(color), false};
  return {glass.index_of(color), beyond.index(color), false};
}

Vector Media::left_after(Real way) const {
  if (entered_.empty()) return Vector(1);
  const auto* material = std::get_if<MetallicRoughness>(&entered_.back()->model);
  if (material == nullptr) return Vector(1);
  Vector left(1);
  for (int i = 0; i < 3; ++i) {
    const Real color = std::max(Real(material->attenuation_color[i]), 0x1p-24L);
    left[i] = std::pow(color, way / Real(material->attenuation_distance));
  }
  return left;
}

Refraction refract(const Vector& direction, const Vector& normal, const Vector& geometric_normal, const Face& face) {
  Refraction result;
  const auto about = [&](const Vector& n) {
    // Snell's law: the ratio of the direction's components along the surface is the ratio of the indices.
    const Real cosine = -glm::dot(direction, n);
    const Vector along = direction + cosine * n;
    const Vector along_beyond = along * (face.from / face.to);
    const Real sine2 = glm::dot(along_beyond, along_beyond);
    result.is_total = sine2 >= 1;
    result.cosine = cosine;
    result.cosine_beyond = std::sqrt(std::max(1 - sine2, Real(0)));
    result.direction = along_beyond - result.cosine_beyond * n;
  };
  const Vector shading = glm::dot(direction, normal) < 0 ? normal : geometric_normal;
  about(shading);
  if (face.is_thin || face.from == face.to) {
    result.direction = direction;
    return result;
  }
  if (!result.is_total && glm::dot(result.direction, geometric_normal) >= 0) {
    const Refraction by_shading = result;
    about(geometric_normal);
    // The reflected light depends on the shading normal in any case.
    result.cosine = by_shading.cosine;
    result.cosine_beyond = by_shading.cosine_beyond;
  }
  return result;
}

Real fresnel(const Face& face, const Refraction& at) {
  if (at.is_total) return 1;
  if (face.from == face.to) return 0;
  const Real a = std::acos(std::min(at.cosine, Real(1)));
  // At normal incidence, the formula in the angles is 0 / 0.
  if (a < 1e-6L) {
    const Real slope = (face.to - face.from) / (face.to + face.from);
    return slope * slope;
  }
  return fresnel_of_angles(a, std::asin(std::min(std::sin(a) * face.from / face.to, Real(1))));
}

Vector straight_share(const Material& material, const Face& face, Real cosine, const Vector& tint, Real transmission,
                      Real metal) {
  const Face from_thinner{std::min(face.from, face.to), std::max(face.from, face.to), face.is_thin};
  if (const auto* phong = std::get_if<Phong>(&material.model)) {
    if (!phong->fresnel) return Vector(phong->transmission);
    Refraction at;
    at.cosine = cosine;
    return Vector(phong->transmission) * (1 - fresnel(from_thinner, at));
  }
  const auto& m = std::get<MetallicRoughness>(material.model);
  const Real through = Real(m.transmission) * transmission;
  const Real slope = (face.to - face.from) / (face.to + face.from);
  const Vector f0 = glm::min(slope * slope * Vector(m.specular_color) * Real(m.specular), Vector(1));
  Vector reflected = f0 + (Real(m.specular) - f0) * std::pow(1 - cosine, Real(5));
  if (face.from == face.to) reflected = Vector(0);
  const Real share = (1 - Real(m.metallic) * metal) * through * (1 - largest(reflected));
  return share * (face.is_thin ? tint : glm::sqrt(tint));
}

}  // namespace promin::oracle
