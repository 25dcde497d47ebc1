// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#include "oracle/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <variant>

#include "oracle/distance.h"
#include "oracle/lobe.h"
#include "oracle/samples.h"
#include "oracle/smooth_lobe.h"

namespace promin::oracle {
namespace {

Vector rgb(const Texel& texel) {
  return Vector(texel);
}

/// A direction in which a texture's first coordinate increases, and the side of the bitangent; 0 if there is none.
struct Tangent {
  Vector direction{0};
  Real side = 1;
};

/// Returns the tangent of a triangle, as baking tools compute it from (u, 1 - v) before the slot's transform.
Tangent tangent_of_triangle(const SurfacePoint& point, const TextureSlot& slot) {
  const TrianglePoint& at = point.on_triangle;
  TextureSlot plain;
  plain.uv_set = slot.uv_set;
  const UvEdges uv = uv_edges(plain, at);
  const glm::uvec3 corners = at.mesh->triangles[static_cast<size_t>(at.triangle)];
  const Vector a(at.mesh->positions[corners.x]);
  const Vector to_b = Vector(at.mesh->positions[corners.y]) - a;
  const Vector to_c = Vector(at.mesh->positions[corners.z]) - a;
  // The first coordinate increases along the combination of the edges for which 1 - v is constant.
  const Real area = -(uv.to_b.x * uv.to_c.y - uv.to_c.x * uv.to_b.y);
  if (area == 0) return {};
  return {(uv.to_b.y * to_c - uv.to_c.y * to_b) / area, area > 0 ? Real(1) : Real(-1)};
}

Tangent tangent_at(const SurfacePoint& point, const TextureSlot& slot) {
  const TrianglePoint& at = point.on_triangle;
  if (at.mesh->tangents.empty()) return tangent_of_triangle(point, slot);
  const glm::uvec3 corners = at.mesh->triangles[static_cast<size_t>(at.triangle)];
  const std::array<Real, 3> weights{1 - at.u - at.v, at.u, at.v};
  Tangent tangent;
  for (int i = 0; i < 3; ++i) {
    tangent.direction += weights[static_cast<size_t>(i)] * Vector(at.mesh->tangents[corners[i]]);
  }
  tangent.side = at.mesh->tangents[corners.x].w;
  return tangent;
}

/// Returns the direction from which a rough surface reflects the environment: the mirrored direction, rotated towards
/// the normal.
Vector off_mirror(const Vector& direction, const Vector& normal, const Vector& geometric_normal, Real roughness) {
  Vector mirrored = glm::reflect(direction, normal);
  // A strongly tilted normal would lead into the surface.
  if (glm::dot(mirrored, geometric_normal) < 0) mirrored = glm::reflect(mirrored, geometric_normal);
  return glm::normalize(mirrored + (normal - mirrored) * std::pow(roughness, Real(4)));
}

Radiance environment_of(const Surroundings& surroundings, const Vector& direction, const Vector& normal,
                        const Vector& geometric_normal, Real roughness) {
  return {surroundings.lobe_mean(off_mirror(direction, normal, geometric_normal, roughness), roughness), 0,
          surroundings.map_error(roughness)};
}

/// Returns the largest error of any of a lobe's angles.
Real angle_error(const ArrivingLight& arriving, const PointError& error, Real apart) {
  const Real to_light = 4 * kRoundoff + error.position / arriving.distance;
  return std::min(error.normal + (error.to_eye + to_light) / std::min(apart, Real(1)), Real(1));
}

/// Returns the lobe's value and its error. The lobe increases if the half vector comes nearer to the normal, if l
/// increases, and if v or V.H decreases, so its largest and smallest values within the angles' errors are at the ends.
/// In addition, fp32 has an error of 64 u + 8 u / alpha.
template <class AnyLobe>
Radiance bound_highlight(const AnyLobe& lobe, const LobeAngles& at, Real error) {
  const auto highlight_at = [&](Real step) {
    return Vector(lobe.highlight({std::clamp(at.theta - step, Real(0), std::numbers::pi_v<Real> / 2), at.v - step,
                                  std::max(at.l + step, Real(0)), std::clamp(at.v_h - step, Real(0), Real(1))}));
  };
  const Vector color(lobe.highlight(at));
  const Vector off = glm::max(highlight_at(error) - color, color - highlight_at(-error));
  const Vector rounding = (64 + 8 / lobe.alpha_of_sources()) * kRoundoff * color;
  const Vector sum = off + rounding;
  return {color, largest(sum)};
}

/// Returns a sheen's value and its error. There is no angle at which all terms of a sheen are at an end of their
/// ranges, so all corners within the errors are tried. In fp32, exponents up to 25 and powers have errors of a few u.
Radiance bound_sheen(const Sheen& sheen, const LobeAngles& at, Real error) {
  const Vector color = sheen.highlight(at);
  Real off = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto step = [&](int bit) { return (corner & bit) != 0 ? error : -error; };
    const LobeAngles near{std::clamp(at.theta + step(1), Real(0), std::numbers::pi_v<Real> / 2), at.v + step(2),
                          std::max(at.l + step(4), Real(1e-9L)), at.v_h};
    const Vector apart = glm::abs(sheen.highlight(near) - color);
    off = std::max({off, apart.x, apart.y, apart.z});
  }
  return {color, off + 512 * kRoundoff * largest(color)};
}

/// Returns the value and error of a stretched highlight. The highlight may have five errors: the frame of eye and light
/// may be tilted along the grain, tilted across it, or rotated, and the eye alone may be tilted in either way. Small
/// errors add up.
Radiance bound_stretched(const Lobe& lobe, const GrainWays& ways, const GrainAlphas& alphas, Real error) {
  const Vector color = lobe.highlight(ways, alphas);
  const auto turn = [](const Vector& way, int axis, Real by) {
    Vector pole(0);
    pole[axis] = 1;
    return glm::normalize(way + by * glm::cross(pole, way));
  };
  const auto off = [&](const GrainWays& other) {
    const Vector apart = glm::abs(lobe.highlight(other, alphas) - color);
    return largest(apart);
  };
  Real sum = (64 + 8 / std::max(alphas.across, Real(0.002L))) * kRoundoff * largest(color);
  for (int axis = 0; axis < 3; ++axis) {
    const auto all = [&](Real by) { return off({turn(ways.to_eye, axis, by), turn(ways.to_light, axis, by)}); };
    const auto eye = [&](Real by) { return off({turn(ways.to_eye, axis, by), ways.to_light}); };
    sum += std::max(all(error), all(-error)) + std::max(eye(error), eye(-error));
  }
  return {color, sum};
}

/// The fractions of light that lobes send to the eye, by ScatteringLobe.
using LobeWeights = std::array<Vector, kLobeCount>;

/// Returns a direction whose density is its cosine to the normal divided by pi.
Vector place_by_cosine(const Vector& normal, const std::array<Real, 2>& u) {
  const auto [x, y] = place_on_disc(u);
  const Vector helper = std::abs(normal.x) < 0.57L ? Vector(1, 0, 0) : Vector(0, 1, 0);
  const Vector across = glm::normalize(glm::cross(normal, helper));
  return x * across + y * glm::cross(normal, across) + std::sqrt(std::max(1 - x * x - y * y, Real(0))) * normal;
}

/// Returns the direction on the outer side of a surface, mirrored at it if necessary.
Vector outward(const Vector& direction, const Vector& geometric_normal) {
  return glm::dot(direction, geometric_normal) < 0 ? glm::reflect(direction, geometric_normal) : direction;
}

/// All data that a material model needs.
struct Glimpse {
  const SurfacePoint& point;
  const SlotTexels& texels;
  const Vector& direction;
  const PointError& error;
  const Surroundings& surroundings;

  Vector to_eye() const { return -direction; }
  Vector emission() const {
    return point.emission_share * Vector(point.material->emissive) * rgb(texels[kEmissionSlot]);
  }
  Vector vertex_color() const { return rgb(point.vertex_color); }
};

/// The response of a material to light at one point, seen from one eye. Each model has these functions.
class PhongSurface {
 public:
  PhongSurface(const Phong& phong, const Glimpse& at)
      : shininess_(phong.shininess),
        at_(at),
        normal_(bend_normal(at.point, kNormalSlot, at.texels[kNormalSlot], 1, at.direction)),
        ambient_(Vector(phong.ambient) * rgb(at.texels[kBaseSlot]) * at.vertex_color()),
        diffuse_(Vector(phong.diffuse) * rgb(at.texels[kBaseSlot]) * at.vertex_color()),
        specular_(Vector(phong.specular) * rgb(at.texels[kMetallicRoughnessSlot])),
        reflection_(Vector(phong.reflection) * rgb(at.texels[kMetallicRoughnessSlot])) {
    const std::optional<Face>& face = at.point.face;
    if (!face) return;
    is_bent_ = !face->is_thin && face->from != face->to;
    refraction_ = refract(at.direction, normal_, at.point.geometric_normal, *face);
    if (phong.fresnel) {
      const Real reflected = fresnel(*face, refraction_);
      reflection_ *= reflected;
      through_ = (1 - reflected) * Vector(phong.transmission);
    } else if (refraction_.is_total) {
      reflection_ += Vector(phong.transmission);
    } else {
      through_ = Vector(phong.transmission);
    }
  }

  Radiance own() const {
    if (at_.surroundings.is_source()) return {at_.emission()};
    return {at_.emission() + ambient_ * at_.surroundings.irradiance(normal_)};
  }
  SkyWays sky_ways() const { return {{}, {}, normal_, 0}; }

  Radiance contribution(const ArrivingLight& arriving) const {
    const Real cosine = glm::dot(normal_, arriving.to_light);
    if (!(cosine > 0)) return {};
    if (arriving.is_environment) return {ambient_ / std::numbers::pi_v<Real> * *arriving.radiance * cosine};
    Vector share = diffuse_ * arriving.diffuse() * cosine;
    const Real highlight = glm::dot(2 * cosine * normal_ - arriving.to_light, at_.to_eye());
    if (shininess_ > 0 && highlight > 0) {
      share += specular_ * arriving.specular() * std::pow(highlight, shininess_);
    }
    return {share};
  }

  LobeWeights lobes() const { return {diffuse_, Vector(0), reflection_, Vector(0), through_}; }
  Scattered scatter(ScatteringLobe lobe, const std::array<Real, 2>& u) const {
    if (lobe == kDiffuseLobe) return {lobe, place_by_cosine(normal_, u), diffuse_};
    if (lobe == kGlassLobe) {
      return {lobe, at_.point.is_after_diffusion ? at_.direction : refraction_.direction, through_, 1};
    }
    return {lobe, outward(glm::reflect(at_.direction, normal_), at_.point.geometric_normal), reflection_, 1};
  }

  Response finish(const Radiance& sent) const {
    return {sent, reflection_, normal_, 0, {}, through_, refraction_, normal_, is_bent_, 0};
  }

 private:
  Real shininess_;
  const Glimpse& at_;
  Vector normal_;
  Vector ambient_;
  Vector diffuse_;
  Vector specular_;
  Vector reflection_;
  Refraction refraction_;
  Vector through_{0};
  bool is_bent_ = false;
};

class UnlitSurface {
 public:
  UnlitSurface(const Unlit& unlit, const Glimpse& at)
      : color_(Vector(unlit.color) * rgb(at.texels[kBaseSlot]) * at.vertex_color() +
               Vector(at.point.material->emissive)) {}

  Radiance own() const { return {color_}; }
  static SkyWays sky_ways() { return {{}, {}, Vector(0, 1, 0), 0}; }
  Radiance contribution(const ArrivingLight&) const { return {}; }
  static LobeWeights lobes() { return {}; }
  static Scattered scatter(ScatteringLobe /*lobe*/, const std::array<Real, 2>& /*u*/) { return {}; }
  Response finish(const Radiance& sent) const {
    return {sent, Vector(0), Vector(0), 0, {}, Vector(0), {}, Vector(0), false, 0};
  }

 private:
  Vector color_;
};

/// Returns the material with the values of its textures, except normals, occlusion and emission. The base colour's
/// texture multiplies the vertices' colours.
MetallicRoughness with_textures(MetallicRoughness material, const SlotTexels& texels) {
  const auto scale = [](float& number, Real factor) { number = static_cast<float>(number * factor); };
  scale(material.roughness, texels[kMetallicRoughnessSlot].g);
  scale(material.metallic, texels[kMetallicRoughnessSlot].b);
  scale(material.clearcoat, texels[kCoatSlot].r);
  scale(material.clearcoat_roughness, texels[kCoatRoughnessSlot].g);
  scale(material.specular, texels[kSpecularSlot].a);
  material.specular_color = vec3(Vector(material.specular_color) * rgb(texels[kSpecularColorSlot]));
  material.sheen_color = vec3(Vector(material.sheen_color) * rgb(texels[kSheenColorSlot]));
  scale(material.sheen_roughness, texels[kSheenRoughnessSlot].a);
  scale(material.transmission, texels[kTransmissionSlot].r);
  scale(material.diffuse_transmission, texels[kDiffuseTransmissionSlot].a);
  material.diffuse_transmission_color =
      vec3(Vector(material.diffuse_transmission_color) * rgb(texels[kDiffuseTransmissionColorSlot]));
  scale(material.iridescence, texels[kIridescenceSlot].r);
  material.iridescence_thickness_maximum =
      static_cast<float>(std::lerp(Real(material.iridescence_thickness_minimum),
                                   Real(material.iridescence_thickness_maximum), texels[kIridescenceThicknessSlot].g));
  scale(material.anisotropy, texels[kAnisotropySlot].b);
  return material;
}

/// Returns the material as rays see it after a diffuse surface.
MetallicRoughness after_diffusion(MetallicRoughness material, const SurfacePoint& point) {
  if (!point.is_after_diffusion) return material;
  const auto least = static_cast<float>(kRoughnessAfterDiffusion);
  material.roughness = std::max(material.roughness, least);
  material.clearcoat_roughness = std::max(material.clearcoat_roughness, least);
  return material;
}

/// Returns the material as its dielectric reflects in a medium other than air: with the quotient of the indices.
MetallicRoughness beside(MetallicRoughness material, const Face& face, bool is_total) {
  if (is_total) {
    // If the reflection is total, the index is set to 0, for which KHR_materials_ior defines that all light is
    // reflected at every angle.
    material.ior = 0.0F;
    material.specular = 1.0F;
    material.specular_color = vec3(1.0F);
  } else if (face.from == face.to) {
    material.specular = 0.0F;
  } else {
    material.ior = static_cast<float>(face.to / face.from);
  }
  return material;
}

/// The grain of an anisotropic surface at a point: the directions along and across it, and the normal at which the sky
/// is mirrored.
struct Grain {
  Vector along{0};
  Vector across{0};
  Vector normal{0};
  GrainAlphas alphas;
  /// The normal at which the environment is mirrored.
  Vector bent_normal{0};

  Vector local(const Vector& way) const { return {glm::dot(way, along), glm::dot(way, across), glm::dot(way, normal)}; }
};

/// Returns the grain (KHR_materials_anisotropy) if texture coordinates give a tangent. `material` is the material at
/// the point.
std::optional<Grain> find_grain(const MetallicRoughness& material, const Glimpse& at, const Vector& normal) {
  const Mesh* mesh = at.point.on_triangle.mesh;
  if (!(material.anisotropy > 0) || mesh == nullptr || mesh->uvs.empty()) return std::nullopt;
  const TextureSlot& slot = at.point.slots[kAnisotropySlot];
  const Tangent tangent = tangent_at(at.point, slot);
  const Vector front = at.point.side * normal;
  const Vector t = tangent.direction - glm::dot(tangent.direction, front) * front;
  if (t == Vector(0)) return std::nullopt;
  const Vector b = tangent.side * glm::cross(front, glm::normalize(t));
  const Texel& texel = at.texels[kAnisotropySlot];
  const Real painted = slot.exists() ? std::atan2(2 * texel.g - 1, 2 * texel.r - 1) : Real(0);
  const Real turn = painted + material.anisotropy_rotation;
  Grain grain;
  grain.along = std::cos(turn) * glm::normalize(t) + std::sin(turn) * b;
  grain.normal = normal;
  grain.across = glm::cross(normal, grain.along);
  grain.alphas = grain_alphas(material.roughness, material.anisotropy);
  const Vector facing = glm::cross(glm::cross(grain.across, at.to_eye()), grain.across);
  const Real bend = std::pow(1 - Real(material.anisotropy) * (1 - Real(material.roughness)), Real(4));
  grain.bent_normal = glm::normalize(glm::mix(facing, normal, bend));
  return grain;
}

class MetallicRoughnessSurface {
 public:
  MetallicRoughnessSurface(const MetallicRoughness& material, const Glimpse& at)
      : material_(after_diffusion(with_textures(material, at.texels), at.point)),
        at_(at),
        normal_(bend_normal(at.point, kNormalSlot, at.texels[kNormalSlot], material.normal_scale, at.direction)),
        coat_normal_(bend_normal(at.point, kCoatNormalSlot, at.texels[kCoatNormalSlot], material.clearcoat_normal_scale,
                                 at.direction)),
        grain_(find_grain(material_, at, normal_)),
        cosine_(meet_face()),
        lobe_(material_, at.vertex_color() * rgb(at.texels[kBaseSlot]),
              look_up_lobe_shares(cosine_, material_.roughness), cosine_),
        sheen_(material_, glm::dot(normal_, at.to_eye())),
        coat_(material_, glm::dot(coat_normal_, at.to_eye())),
        has_coat_(material.clearcoat > 0),
        is_dull_below_(has_coat_ && normal_ != coat_normal_) {
    const Real occlusion = 1 + material.occlusion_strength * (at.texels[kOcclusionSlot].r - 1);
    below_ = reflect_environment(grain_ ? grain_->bent_normal : normal_, material_.roughness, occlusion);
    if (has_coat_) above_ = reflect_environment(coat_normal_, material_.clearcoat_roughness, occlusion);
    body_ = occlusion * ((sheen_.left() * albedo() + sheen_.reflectance()) * at.surroundings.irradiance(normal_) +
                         sheen_.left() * albedo_from_behind() * at.surroundings.irradiance(-normal_));
  }

  /// Lobes choose samples in proportion to the light that they reflect of a uniform environment, without the part of
  /// the mirror ray. The sky chooses at least half of the samples.
  SkyWays sky_ways() const {
    const Real diffuse_here = largest(albedo()) + largest(sheen_.reflectance());
    const Real diffuse_behind = largest(albedo_from_behind());
    const Real of_material = (1 - coat_.weight()) * (1 - sharpness_below()) * largest(reflectance());
    const Real of_coat = coat_.weight() * (1 - coat_.sharpness()) * coat_.reflectance();
    const Real sum = (1 - coat_.weight()) * (diffuse_here + diffuse_behind) + 2 * (of_material + of_coat);
    SkyWays ways;
    ways.normal = normal_;
    if (!(sum > 0)) return ways;
    const Real alpha = grain_ ? std::max({grain_->alphas.along, grain_->alphas.across, 0.002L})
                              : std::max(Real(material_.roughness) * Real(material_.roughness), 0.002L);
    const Real coat_roughness = material_.clearcoat_roughness;
    ways.material = {normal_, alpha, of_material / sum};
    ways.coat = {coat_normal_, std::max(coat_roughness * coat_roughness, 0.002L), has_coat_ ? of_coat / sum : Real(0)};
    if (diffuse_behind > 0) ways.behind = diffuse_behind / (diffuse_here + diffuse_behind);
    return ways;
  }

  Radiance own() const {
    Radiance sum;
    if (at_.surroundings.is_source()) {
      sum.add(Vector(1 - coat_.weight()), {at_.emission()});
      return sum;
    }
    sum.add(Vector(1 - coat_.weight()), {at_.emission() + body_});
    sum.add((1 - coat_.weight()) * (1 - sharpness_below()) * reflectance(), below_);
    sum.add(Vector(coat_.weight() * (1 - coat_.sharpness()) * coat_.reflectance()), above_);
    return sum;
  }

  Radiance contribution(const ArrivingLight& arriving) const {
    // A mirror ray contributes the sharp part of each lobe's reflection of the environment and of other surfaces.
    const Real of_lobe = arriving.radiance ? 1 - sharpness_below() : Real(1);
    const Real of_coat = arriving.radiance ? 1 - coat_.sharpness() : Real(1);
    Radiance coated;
    const Real cosine = glm::dot(normal_, arriving.to_light);
    // If the light comes from behind, as seen from the eye, there is no half vector.
    const Real apart = glm::length(at_.to_eye() + arriving.to_light);
    const bool has_highlight = apart >= 0x1p-12L;
    const Real error = angle_error(arriving, at_.error, apart);
    // Light from the other side is scattered through the surface and has no highlight.
    if (material_.diffuse_transmission > 0 && glm::dot(at_.point.geometric_normal, arriving.to_light) < 0) {
      coated.add(Vector(1 - coat_.weight()), {sheen_.left() * albedo_from_behind() / std::numbers::pi_v<Real> *
                                              arriving.diffuse() * std::max(-cosine, Real(0))});
      return coated;
    }
    if (cosine > 0) {
      Radiance sum{albedo() / std::numbers::pi_v<Real> * arriving.diffuse() * cosine};
      const LobeAngles at = angles(normal_, arriving);
      if (has_highlight) sum.add(of_lobe * arriving.specular(), highlight(at, arriving, error));
      if (has_highlight && sheen_.exists()) {
        Radiance below;
        below.add(Vector(sheen_.left(cosine)), sum);
        below.add(arriving.specular(), bound_sheen(sheen_, at, error));
        sum = below;
      }
      coated.add(Vector(1 - coat_.weight()), sum);
    }
    if (has_coat_ && has_highlight && glm::dot(coat_normal_, arriving.to_light) > 0) {
      coated.add(of_coat * coat_.weight() * arriving.specular(),
                 bound_highlight(coat_, angles(coat_normal_, arriving), error));
    }
    return coated;
  }

  LobeWeights lobes() const {
    const Real below = 1 - coat_.weight();
    return {below * (albedo() + sheen_.reflectance()), below * sheen_.left() * albedo_from_behind(),
            below * reflectance(), Vector(coat_.weight() * coat_.reflectance()), finish({}).through};
  }
  Scattered scatter(ScatteringLobe lobe, const std::array<Real, 2>& u) const {
    if (lobe == kGlassLobe) return scatter_through_glass(u);
    if (lobe == kBehindLobe) return {lobe, place_by_cosine(-normal_, u), lobes()[kBehindLobe]};
    if (lobe == kDiffuseLobe) {
      const Vector direction = place_by_cosine(normal_, u);
      const Real cosine = glm::dot(normal_, direction);
      Vector sum = albedo();
      if (sheen_.exists()) {
        sum = sheen_.left(cosine) * sum +
              sheen_.highlight(angles_of(normal_, at_.to_eye(), direction)) * (std::numbers::pi_v<Real> / cosine);
      }
      return {lobe, direction, (1 - coat_.weight()) * sum};
    }
    const bool is_of_coat = lobe == kCoatLobe;
    const Vector& normal = is_of_coat ? coat_normal_ : normal_;
    const Real roughness = is_of_coat ? material_.clearcoat_roughness : material_.roughness;
    const Real share = is_of_coat ? coat_.sharpness() : sharpness_below();
    if (roughness * roughness <= 0.002L) {
      return {lobe, outward(glm::reflect(at_.direction, normal), at_.point.geometric_normal), lobes()[lobe], share};
    }
    const SmoothLobe facets{normal, at_.to_eye(), roughness * roughness};
    const Vector direction = facets.place(u);
    const Real cosine = glm::dot(normal, direction);
    if (!(cosine > 0)) return {lobe, direction, Vector(0), share};
    const LobeAngles at = angles_of(normal, at_.to_eye(), direction);
    const Vector sent = is_of_coat ? Vector(coat_.weight() * coat_.highlight(at))
                                   : (1 - coat_.weight()) * sheen_.left(cosine) * lobe_.highlight(at);
    return {lobe, outward(direction, at_.point.geometric_normal), sent / facets.density(direction), share};
  }

  Response finish(const Radiance& sent) const {
    Response response;
    response.sent = sent;
    const Vector of_material = (1 - coat_.weight()) * sharpness_below() * reflectance();
    const Vector of_coat(coat_.weight() * coat_.sharpness() * coat_.reflectance());
    response.mirror_weight = of_material + of_coat;
    response.mirror_normal = has_coat_ ? coat_normal_ : normal_;
    response.mirror_roughness = material_.roughness;
    if (has_coat_) {
      response.mirror_roughness =
          is_dull_below_ ? material_.clearcoat_roughness : std::min(material_.roughness, material_.clearcoat_roughness);
    }
    response.instead.add(of_material, below_);
    response.instead.add(of_coat, above_);
    response.beyond = refraction_;
    response.refracting_normal = normal_;
    if (share_ > 0) {
      const Face& face = *at_.point.face;
      const Vector base =
          glm::min(Vector(material_.base_color) * at_.vertex_color() * rgb(at_.texels[kBaseSlot]), Vector(1));
      response.through =
          lobe_.let_in() * share_ * sheen_.left() * (1 - coat_.weight()) * (face.is_thin ? base : glm::sqrt(base));
      const Real glass = glass_of(*at_.point.material).index;
      response.blur = material_.roughness * (face.is_thin ? std::clamp(2 * glass - 2, Real(0), Real(1)) : Real(1));
      response.is_deflected = response.blur > 0 || (!face.is_thin && face.from != face.to);
    }
    return response;
  }

 private:
  Radiance highlight(const LobeAngles& at, const ArrivingLight& arriving, Real error) const {
    if (!grain_) return bound_highlight(lobe_, at, error);
    return bound_stretched(lobe_, {grain_->local(at_.to_eye()), grain_->local(arriving.to_light)}, grain_->alphas,
                           error);
  }
  /// Returns the light through glass: through a facet, if the glass is rough and the facet does not reflect totally.
  Scattered scatter_through_glass(const std::array<Real, 2>& u) const {
    const Response response = finish({});
    Scattered through{kGlassLobe, at_.direction, response.through, 1};
    if (at_.point.is_after_diffusion) return through;
    through.direction = refraction_.direction;
    const Real alpha = response.is_deflected ? response.blur * response.blur : Real(0);
    if (alpha <= 0.002L) return through;
    const Vector facet = SmoothLobe{normal_, at_.to_eye(), alpha}.facet(u);
    Vector direction = glm::reflect(glm::reflect(at_.direction, facet), normal_);
    if (!at_.point.face->is_thin) {
      const Real ratio = at_.point.face->from / at_.point.face->to;
      const Vector along = ratio * (at_.direction - glm::dot(at_.direction, facet) * facet);
      const Real sine2 = glm::dot(along, along);
      if (sine2 >= 1) return through;
      direction = along - std::sqrt(1 - sine2) * facet;
    }
    if (glm::dot(direction, at_.point.geometric_normal) < 0) through.direction = direction;
    return through;
  }
  /// Sets the face. Returns the cosine on its thinner side, which the lobe uses.
  Real meet_face() {
    if (grain_) material_.roughness = static_cast<float>(grain_->alphas.mean_roughness());
    const Real seen = glm::dot(normal_, at_.to_eye());
    if (!at_.point.face) return seen;
    const Face& face = *at_.point.face;
    refraction_ = refract(at_.direction, normal_, at_.point.geometric_normal, face);
    material_ = beside(material_, face, refraction_.is_total);
    if (!refraction_.is_total) share_ = material_.transmission;
    if (face.is_thin || face.from == face.to || at_.point.is_after_diffusion) return seen;
    return face.from <= face.to ? refraction_.cosine : refraction_.cosine_beyond;
  }
  /// The fraction of light that is scattered and not transmitted: albedo() to this side, and the next function for
  /// light from the other side (KHR_materials_diffuse_transmission: mix(diffuse_brdf, diffuse_btdf, factor) in place of
  /// diffuse_brdf).
  Vector albedo() const { return (1 - share_) * (1 - Real(material_.diffuse_transmission)) * lobe_.albedo(); }
  Vector albedo_from_behind() const {
    return (1 - share_) * material_.diffuse_transmission * lobe_.let_in() *
           Vector(material_.diffuse_transmission_color);
  }
  LobeAngles angles(const Vector& normal, const ArrivingLight& arriving) const {
    return angles_of(normal, at_.to_eye(), arriving.to_light);
  }
  /// Returns the fraction of light from all directions that is reflected below coat and sheen.
  Vector reflectance() const { return sheen_.left() * lobe_.reflectance(); }
  Real sharpness_below() const { return is_dull_below_ ? 0 : lobe_.sharpness(); }
  Radiance reflect_environment(const Vector& normal, Real roughness, Real occlusion) const {
    Radiance dimmed;
    dimmed.add(Vector(occlusion),
               environment_of(at_.surroundings, at_.direction, normal, at_.point.geometric_normal, roughness));
    return dimmed;
  }

  MetallicRoughness material_;
  const Glimpse& at_;
  Vector normal_;
  Vector coat_normal_;
  std::optional<Grain> grain_;
  Refraction refraction_;
  /// The fraction of the light in the dielectric that is transmitted.
  Real share_ = 0;
  Real cosine_;
  Lobe lobe_;
  Sheen sheen_;
  ClearCoat coat_;
  bool has_coat_;
  /// True if the material reflects only the environment, because the mirror ray belongs to a coat with another normal.
  bool is_dull_below_;
  /// The light of the environment that material and coat would reflect if they were white, and the light of the
  /// environment that the body scatters.
  Radiance below_;
  Radiance above_;
  Vector body_{0};
};

PhongSurface make_surface(const Phong& model, const Glimpse& at) {
  return {model, at};
}
UnlitSurface make_surface(const Unlit& model, const Glimpse& at) {
  return {model, at};
}
MetallicRoughnessSurface make_surface(const MetallicRoughness& model, const Glimpse& at) {
  return {model, at};
}

struct PlaceSlots {
  Slots slots;

  void operator()(const Phong& model) {
    slots[kBaseSlot] = model.diffuse_texture;
    slots[kMetallicRoughnessSlot] = model.specular_texture;
    slots[kNormalSlot] = model.normal_texture;
  }
  void operator()(const Unlit& model) { slots[kBaseSlot] = model.color_texture; }
  void operator()(const MetallicRoughness& model) {
    slots[kBaseSlot] = model.base_color_texture;
    slots[kMetallicRoughnessSlot] = model.metallic_roughness_texture;
    slots[kNormalSlot] = model.normal_texture;
    slots[kOcclusionSlot] = model.occlusion_texture;
    slots[kCoatSlot] = model.clearcoat_texture;
    slots[kCoatRoughnessSlot] = model.clearcoat_roughness_texture;
    slots[kCoatNormalSlot] = model.clearcoat_normal_texture;
    slots[kSpecularSlot] = model.specular_texture;
    slots[kSpecularColorSlot] = model.specular_color_texture;
    slots[kSheenColorSlot] = model.sheen_color_texture;
    slots[kSheenRoughnessSlot] = model.sheen_roughness_texture;
    slots[kTransmissionSlot] = model.transmission_texture;
    slots[kDiffuseTransmissionSlot] = model.diffuse_transmission_texture;
    slots[kDiffuseTransmissionColorSlot] = model.diffuse_transmission_color_texture;
    slots[kIridescenceSlot] = model.iridescence_texture;
    slots[kIridescenceThicknessSlot] = model.iridescence_thickness_texture;
    slots[kAnisotropySlot] = model.anisotropy_texture;
  }
};

}  // namespace

void Radiance::add(const Vector& weight, const Radiance& other) {
  color += weight * other.color;
  const Real heaviest = largest(weight);
  error += heaviest * other.error;
  map_error += heaviest * other.map_error;
}

Slots slots_of(const Material& material) {
  PlaceSlots place;
  std::visit(place, material.model);
  if (!std::holds_alternative<Unlit>(material.model)) place.slots[kEmissionSlot] = material.emissive_texture;
  return place.slots;
}

Vector bend_normal(const SurfacePoint& point, Slot slot, const Texel& texel, Real scale, const Vector& direction) {
  if (!point.slots[slot].exists()) return point.normal;
  const Tangent tangent = tangent_at(point, point.slots[slot]);
  // The texture's frame belongs to the front. If the back is visible, the frame is rotated with the normal.
  const Vector normal = point.side * point.normal;
  const Vector across = tangent.direction - glm::dot(tangent.direction, normal) * normal;
  if (across == Vector(0)) return point.normal;
  const Vector t = glm::normalize(across);
  const Vector b = tangent.side * glm::cross(normal, t);
  const Vector in_texture = Real(2) * rgb(texel) - Real(1);
  Vector bent = point.side * glm::normalize(scale * (in_texture.x * t + in_texture.y * b) + in_texture.z * normal);
  // A normal that points away from the eye is rotated until the surface is seen edge-on.
  const Real away = glm::dot(bent, direction);
  if (away > 0) bent = glm::normalize(bent - away * direction);
  return bent;
}

SkyWays sky_ways(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 const Surroundings& surroundings) {
  const Glimpse at{point, texels, direction, error, surroundings};
  return std::visit([&](const auto& model) { return make_surface(model, at).sky_ways(); }, point.material->model);
}

Scattered scatter(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                  const Surroundings& surroundings, const std::array<Real, 2>& u) {
  const Glimpse at{point, texels, direction, error, surroundings};
  return std::visit(
      [&](const auto& model) -> Scattered {
        const auto surface = make_surface(model, at);
        const LobeWeights lobes = surface.lobes();
        Real sum = 0;
        for (const Vector& lobe : lobes) sum += largest(lobe);
        Real before = 0;
        for (size_t i = 0; i < kLobeCount; ++i) {
          const Real share = sum > 0 ? largest(lobes[i]) / sum : Real(0);
          if (share > 0 && u[0] < before + share) {
            Scattered scattered = surface.scatter(ScatteringLobe(i), {(u[0] - before) / share, u[1]});
            scattered.weight /= share;
            return scattered;
          }
          before += share;
        }
        return {};
      },
      point.material->model);
}

Response respond(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 std::span<const ArrivingLight> lights, const Surroundings& surroundings) {
  const Glimpse at{point, texels, direction, error, surroundings};
  return std::visit(
      [&](const auto& model) {
        const auto surface = make_surface(model, at);
        Radiance sent = surface.own();
        for (const ArrivingLight& arriving : lights) {
          const Radiance whole = surface.contribution(arriving);
          sent.add(arriving.strength, whole);
          sent.error += arriving.strength_error * largest(whole.color);
        }
        return surface.finish(sent);
      },
      point.material->model);
}

}  // namespace promin::oracle
