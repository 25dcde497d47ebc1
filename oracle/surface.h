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

/// A material's textures, in this order for every model. Phong has base, specular (in place of metallic and roughness),
/// normals and emission; an unlit material has only the base.
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
  /// Interpolated if the mesh has vertex normals.
  Vector normal{0};
  /// 1 if the front is visible, -1 if the back is.
  Real side = 1;
  /// The origin of shadow rays before the lift.
  Vector shadow_position{0};
  /// How far along the geometric normal secondary rays start.
  Real lift = 0;
  Texel vertex_color{1};
  /// For glass, and for mirrors whose reflectance depends on the angle.
  std::optional<Face> face;
  const Material* material = nullptr;
  /// The point for textures; without a mesh on analytic shapes.
  TrianglePoint on_triangle;
  /// The material's textures; empty if nothing is displayed.
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
  /// The light that the surface emits, and that it reflects from sources.
  Radiance sent;
  /// For a mirror ray: whether it may be traced, the weight of its light, the normal about which it is reflected, and
  /// the roughness with which it sees the sky.
  Vector mirror_weight{0};
  Vector mirror_normal{0};
  Real mirror_roughness = 0;
  /// The light used in place of a mirror ray's.
  Radiance instead;
  /// For a ray through the surface: the weight of its light, its direction, and its blur. A ray that is neither
  /// refracted nor blurred sees what lies behind.
  Vector through{0};
  Refraction beyond;
  Vector refracting_normal{0};
  bool is_deflected = false;
  Real blur = 0;
};

/// Returns the normal from a normal map, seen along `direction`. It rotates the point's normal in the frame of its
/// tangent, if it has one.
Vector bend_normal(const SurfacePoint& point, Slot slot, const Texel& texel, Real scale, const Vector& direction);

/// Returns the response for a ray along the unit vector `direction`.
Response respond(const SurfacePoint& point, const SlotTexels& texels, const Vector& direction, const PointError& error,
                 std::span<const ArrivingLight> lights, const Surroundings& surroundings);

}  // namespace promin::oracle
