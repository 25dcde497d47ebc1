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

/// How surfaces answer light: the models of docs/model.md ("Light"), with textures.
namespace promin::oracle {

/// Light, and how far a device may be off it.
struct Radiance {
  Vector color{0};
  /// Because its highlights lie a little aside, or textures show another place of theirs.
  Real error = 0;
  /// Because its sky comes from maps.
  Real map_error = 0;

  void add(const Radiance& other) { add(Vector(1), other); }
  void add(const Vector& weight, const Radiance& other);
};

/// How far a device may have the point and the directions from it, because it rounds: lengths in scene units, and
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
  /// Where shadow rays start from, but for the lift.
  Vector shadow_position{0};
  /// How far along the geometric normal secondary rays start.
  Real lift = 0;
  Texel vertex_color{1};
  /// Of glass, and of mirrors that hang on the angle.
  std::optional<Face> face;
  const Material* material = nullptr;
  /// As textures see it; without a mesh on analytic shapes.
  TrianglePoint on_triangle;
  /// The material's textures; none where nothing is shown.
  Slots slots;
};

/// What each of them shows at a point: 1 where there is no texture.
using SlotTexels = std::array<Texel, kSlotCount>;

/// A source as it arrives at a point.
struct ArrivingLight {
  const Light* light = nullptr;
  Vector to_light{0};
  /// Infinite for a source without a place.
  Real distance = kInfinity;
  /// What shape, distance and shadows leave of its power, and how far a device may be off that.
  Vector strength{1};
  Real strength_error = 0;
};

/// What a surface does with light.
struct Response {
  /// What it sends by itself and of sources.
  Radiance sent;
  /// Whether a mirror ray may be traced, the weight of what it brings, the normal about which it goes, and the
  /// roughness at which it meets the sky.
  Vector mirror_weight{0};
  Vector mirror_normal{0};
  Real mirror_roughness = 0;
  /// What is seen in place of what a mirror ray would bring.
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
