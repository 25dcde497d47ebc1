// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>
#include <vector>

#include "formats/load_report.h"
#include "promin/scene.h"

namespace promin {

/// The numbers of an f statement as written; none is negative.
struct NffMaterial {
  vec3 color{0.0F};
  /// The weight of diffuse light, Kd.
  float diffuse = 0.0F;
  /// The weight of highlights and mirror rays, Ks.
  float specular = 0.0F;
  /// Phong's exponent, Shine.
  float shininess = 0.0F;
  /// The weight of refracted rays, T.
  float transmittance = 0.0F;
  /// Index of refraction; 0 if none is given.
  float ior = 0.0F;
};

struct NffLight {
  vec3 position{0.0F};
  /// Colour of the light. If empty, the brightness depends on the number of lights.
  std::optional<vec3> color = {};
};

/// A polygon: a statement p or pp.
struct NffPolygon {
  /// Index of the polygon's first corner in NffText::corners. If the polygon has normals, it is also the index of its
  /// first normal in NffText::normals.
  size_t first_corner = 0;
  size_t first_normal = 0;
  uint32_t corner_count = 0;
  bool has_normals = false;
};

using NffShape = std::variant<NffPolygon, Sphere, Cylinder, Cone>;

/// Shapes with the same material; at least one.
struct NffGroup {
  /// The material; empty if no f statement precedes the shapes.
  std::optional<NffMaterial> material = {};
  std::vector<NffShape> shapes = {};
};

struct NffText {
  std::optional<vec3> background = {};
  std::vector<Camera> cameras;
  std::vector<NffLight> lights;
  std::vector<NffGroup> groups;
  std::vector<vec3> corners;
  std::vector<vec3> normals;
};

/// Parses an NFF file. All numbers are in the ranges of validate(), except normals, which may be 0. Shapes, lights and
/// views with invalid positions are left out. An unknown statement, or a word in place of a number, ends the parsing
/// with an error, because the next statement could begin anywhere. Problems go to the report with their line.
NffText parse_nff_text(std::string_view text, LoadReport& report);

}  // namespace promin
