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

/// What an f says, as it stands there; no number is negative.
struct NffMaterial {
  vec3 color{0.0F};
  /// The weight of diffuse light, Kd.
  float diffuse = 0.0F;
  /// The weight of highlights and of what mirror rays bring, Ks.
  float specular = 0.0F;
  /// Phong's exponent, Shine.
  float shininess = 0.0F;
  /// The weight of what refracted rays bring, T.
  float transmittance = 0.0F;
  /// 0 where there is none to speak of.
  float ior = 0.0F;
};

struct NffLight {
  vec3 position{0.0F};
  /// None: as bright as the number of sources makes it.
  std::optional<vec3> color = {};
};

/// A p or pp.
struct NffPolygon {
  /// Where its corners begin in NffText::corners and its normals, if it has any, in NffText::normals.
  size_t first_corner = 0;
  size_t first_normal = 0;
  uint32_t corner_count = 0;
  bool has_normals = false;
};

using NffShape = std::variant<NffPolygon, Sphere, Cylinder, Cone>;

/// Shapes of one material. Each group has some.
struct NffGroup {
  /// None where no f comes before them.
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

/// Parses an NFF file; all numbers are in the ranges that validate() asks for, but normals, which may be 0. Shapes,
/// lights and views without a place are left out. A word that is no statement, or no number of a shape, ends it,
/// because the next statement could begin anywhere. Problems go to the report with their line.
NffText parse_nff_text(std::string_view text, LoadReport& report);

}  // namespace promin
