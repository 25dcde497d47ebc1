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

/// Light, and the largest permitted error of a device.
struct Radiance {
  Vector color{0};
  /// The error because highlights may be slightly displaced, or textures sampled at another position.
  Real error = 0;
  /// The error because the device's sky comes from maps.
  Real map_error = 0;

  void add(const Radiance& other) { add(Vector(1), other); }
  void add(const Vector& weight, const Radiance& other);
};

/// The errors of the point and of directions from it that rounding on a device may cause: lengths in scene units, and
/// angles.
struct PointError {
  Real position = 0;
  Real normal = 0;
  Real to_eye = 0;
};

/// A material's textures, each model's in this order: Phong has the base, specular in place of metallic and roughness,
/// normals and emission, what is unlit has the base alone.
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

/// A hit as shading sees it. All normals are unit and face the ray.
struct SurfacePoint {
  Vector position{0};
  Vector geometric_normal{0};
  /// Interpolated where the mesh has vertex normals.
  Vector normal{0};
  /// 1 where the front is seen, -1 where the back is.
  Real side = 1;
  /// The origin of shadow rays before the lift.
  Vector shadow_position{0};
  /// How far along the geometric normal secondary rays start.
  Real lift = 0;
  Texel vertex_color{1};
  /// For glass, and for mirrors whose reflectance depends on the angle.
  std::optional<Face> face;
  const Material* material = nullptr;
  /// As textures see it; without a mesh on analytic shapes.
  TrianglePoint on_triangle;
  /// The material's textures; none where nothing is shown.
  Slots slots;
};

/// The value of each texture at a point; 1 without a texture.
using SlotTexels = std::array<Texel, kSlotCount>;

/// The light of a source at a point.
struct ArrivingLight {
  const Light* light = nullptr;
  Vector to_light{0};
  /// Infinite for a source without a position.
  Real distance = kInfinity;
  /// The light that remains after the source's shape, distance and shadows, and the largest permitted error of a
  /// device.
  Vector strength{1};
  Real strength_error = 0;
};

/// The response of a surface to light.
struct Response {
  /// What it sends by itself and of sources.
  Radiance sent;
  /// Whether a mirror ray may be traced, the weight of what it brings, the normal about which it goes, and the
  /// roughness at which it meets the sky.
  Vector mirror_weight{0};
  Vector mirror_normal{0};
  Real mirror_roughness = 0;
  /// The light used in place of a mirror ray's.
  Radiance instead;
  /// The weight of what is seen beyond the surface, the direction of the ray there, and how much it is blurred; where
  /// it is neither bent nor blurred it sees what is behind.
  Vector through{0};
  Refraction beyond;
  Vector refracting_normal{0};
  bool is_deflected = false;
  Real blur = 0;
};

/// The normal of a texture, seen along `direction`: it turns the point's in the plane of its tangent, where it has one.
Vector bend_normal(const SurfacePoint& point, Slot slot, const Texel& texel, Real scale, const Vector& direction);

/// Of a ray along the unit vector `direction`.
Response respond(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 std::span<const ArrivingLight> lights, const Surroundings& surroundings);

}  // namespace promin::oracle
