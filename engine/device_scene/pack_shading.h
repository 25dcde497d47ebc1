// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "layout.h"
#include "promin/lights.h"
#include "promin/scene.h"

// What shading needs of a scene beside its primitives, in the layout of shaders/layout.h. Each alone, as they change
// alone.
namespace promin {

std::vector<layout::MaterialRecord> pack_materials(std::span<const Material> materials);

/// The lights that are on.
struct PackedLights {
  std::vector<layout::LightRecord> records;
  /// The index in Scene::lights of each record's light.
  std::vector<uint32_t> numbers;
};
PackedLights pack_lights(std::span<const Light> lights);

}  // namespace promin
