// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "promin/export.h"
#include "promin/math.h"

namespace promin {

/// Arbitrary output variables: what a picture tells of each pixel beside its colour. They are of the pixel's middle
/// sample, that of index samples / 2; with an odd number of samples it is the pixel's centre, and so with an error
/// target. The values stand row by row as those of the image:
///   - depth: distance from the eye, with an orthographic camera from the plane through it; infinite on a miss
///   - normal: geometric normal as Hit::normal, never flipped to the ray; 0 on a miss
///   - object, primitive: as Hit::object and Hit::primitive; kNoId on a miss
///   - material: index into Scene::materials; kNoId on a miss
///   - albedo: the base colour, linear RGB, with vertex colours and textures: of Phong materials the diffuse factor, of
///     unlit ones the colour; 0 on a miss
///   - samples: how many the pixel has taken
///   - error: by how much each channel may be off (promin/view.h, ErrorTarget); 0 without an error target
struct Aovs {
  /// What object, primitive and material are on a miss.
  static constexpr uint32_t kNoId = 0xFFFFFFFF;

  /// @cond
  // The members, of the table.
#define PROMIN_AOV(FIELD, TYPE, MISS, CHANNEL, COMPONENTS) std::vector<TYPE> FIELD;
#include "promin/kinds/aovs.def"
  /// @endcond

  /// Gives each of them `pixel_count` values, which say that nothing was hit.
  PROMIN_EXPORT void resize(size_t pixel_count);
};

/// Names of the AOVs, in the order of the members of Aovs.
PROMIN_EXPORT std::span<const std::string_view> aov_names();

}  // namespace promin
