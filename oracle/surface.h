// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>

#include "oracle/glass.h"
#include "oracle/oracle.h"
#include "oracle/sky.h"
#include "oracle/texture.h"

/// Shading of surfaces: the models of docs/model.md ("Light"), with textures.
namespace promin::oracle {

/// A radiance, and the largest permitted error of a device.
struct Radiance {
  Vector color{0};
  /// The permitted error because highlights may be slightly displaced and textures may be sampled at another position.
  Real error = 0;
  /// The permitted error of the device's sky, which is read from maps.
  Real map_error = 0;

  void add(const Radiance& other) { add(Vector(1), other); }
  void add(const Vector& weight, const Radiance& other);
};

/// The errors of a point, and of directions from it, that rounding on a device may cause. Lengths are in scene units,
/// angles in radians.
struct PointError {
  Real position = 0;
  Real normal = 0;
  Real to_eye = 0;
};

/// The textures of a material, in the same order for every model. Phong has base, specular (in place of metallic and
/// roughness), normals and emission. An unlit material has only the base.
enum Slot : size_t {
  kBaseSlot,
  kMetallicRoughnessSlot,
  kNormalSlot,
  kOcclusionSlot,
  kEmissionSlot,
  kCoatSlot,
  kCoatRoughnessSlot,
  kCoatNormalSlot,
  kSpecularSlot,
  kSpecularColorSlot,
  kSheenColorSlot,
  kSheenRoughnessSlot,
  kTransmissionSlot,
  kDiffuseTransmissionSlot,
  kDiffuseTransmissionColorSlot,
  kIridescenceSlot,
  kIridescenceThicknessSlot,
  kAnisotropySlot,
  kSlotCount
};
using Slots = std::array<TextureSlot, kSlotCount>;
Slots slots_of(const Material& material);

/// The roughness that surfaces have at least after a diffuse one.
constexpr Real kRoughnessAfterDiffusion = static_cast<Real>(0.55F);

/// A hit with the data for shading. All normals are unit vectors and face the ray.
struct SurfacePoint {
  Vector position{0};
  Vector geometric_normal{0};
  /// The shading normal, interpolated if the mesh has vertex normals.
  Vector normal{0};
  /// 1 if the front is visible, -1 if the back is.
  Real side = 1;
  /// The origin of shadow rays before they are lifted off the surface.
  Vector shadow_position{0};
  /// Distance along the geometric normal at which secondary rays start.
  Real lift = 0;
  Texel vertex_color{1};
  /// The fraction of the point's emission that the ray adds. A source contributes the rest.
  Real emission_share = 1;
  /// The face, for glass and for mirrors whose reflectance depends on the angle.
  std::optional<Face> face;
  const Material* material = nullptr;
  /// The point in the form for textures; without a mesh on analytic shapes.
  TrianglePoint on_triangle;
  /// The material's texture slots; empty if no texture is shown.
  Slots slots;
  /// True if a diffuse surface has scattered the ray. The surface is then rough, and its glass does not bend rays.
  bool is_after_diffusion = false;
};

/// The values of all textures at a point; 1 for a missing texture.
using SlotTexels = std::array<Texel, kSlotCount>;

/// The light of a source that arrives at a point.
struct ArrivingLight {
  const Light* light = nullptr;
  Vector to_light{0};
  /// Distance of the source; infinite for a source without a position.
  Real distance = kInfinity;
  /// The light that remains after the source's shape, distance and shadows, and the largest permitted error of a
  /// device.
  Vector strength{1};
  Real strength_error = 0;
  /// The radiance of the source if it is the environment or a surface. Its light has no other power, and mirror rays
  /// show the sharp part of its reflection.
  std::optional<Vector> radiance = std::nullopt;
  bool is_environment = false;

  Vector diffuse() const { return radiance ? *radiance : Vector(light->diffuse); }
  Vector specular() const { return radiance ? *radiance : Vector(light->specular); }
};

/// A lobe from which directions to light are chosen.
struct ChosenLobe {
  Vector normal{0};
  Real alpha = 1;
  /// The share of the samples that choose from this lobe.
  Real share = 0;
};

/// The ways in which samples of the environment's light choose directions at a point.
struct SkyWays {
  ChosenLobe coat;
  ChosenLobe material;
  /// The normal of the point, and the share of all other samples that light its other side.
  Vector normal{0};
  Real behind = 0;
};

/// The response of a surface to light.
struct Response {
  /// The light that the surface emits, plus the light of sources that it reflects.
  Radiance sent;
  /// Data for a mirror ray: whether it may be traced, the weight of its light, the normal about which it is reflected,
  /// and the roughness with which it sees the sky.
  Vector mirror_weight{0};
  Vector mirror_normal{0};
  Real mirror_roughness = 0;
  /// The light that replaces that of a mirror ray which is not traced.
  Radiance instead;
  /// Data for a ray through the surface: the weight of its light, its direction, and its blur. If the ray is neither
  /// refracted nor blurred, it continues behind the surface.
  Vector through{0};
  Refraction beyond;
  Vector refracting_normal{0};
  bool is_deflected = false;
  Real blur = 0;
};

/// The parts of a surface that scatter light to the eye, in the order in which samples choose them.
enum ScatteringLobe : size_t { kDiffuseLobe, kBehindLobe, kMirrorLobe, kCoatLobe, kGlassLobe, kLobeCount };

/// A direction in which a surface scatters a path.
struct Scattered {
  ScatteringLobe lobe = kDiffuseLobe;
  Vector direction{0};
  /// The light that the lobe sends to the eye, divided by the density of the direction and the chance of the lobe.
  Vector weight{0};
  /// The fraction of the environment's light that the path receives. The rest is that of a source.
  Real environment_share = 0;
};

/// Returns the normal that a normal texture's texel describes, seen along `direction`. It rotates the point's normal in
/// the frame of its tangent, if it has one.
Vector bend_normal(const SurfacePoint& point, Slot slot, const Texel& texel, Real scale, const Vector& direction);

SkyWays sky_ways(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 const Surroundings& surroundings);

/// Returns the direction that a point of the unit square chooses.
Scattered scatter(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                  const Surroundings& surroundings, const std::array<Real, 2>& u);

/// Returns the response for a ray along the unit vector `direction`.
Response respond(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 std::span<const ArrivingLight> lights, const Surroundings& surroundings);

}  // namespace promin::oracle
