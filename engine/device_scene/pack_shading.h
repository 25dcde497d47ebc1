// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "promin/lights.h"
#include "promin/scene.h"
#include "shared/layout.h"
#include "textures/pack_images.h"

// Packs the data for shading other than primitives into the layout of shaders/shared/layout.h. Each kind is packed
// separately, because each changes separately.
namespace promin {

/// Tables of textures, which materials refer to.
struct TextureTables {
  std::span<const Texture> textures;
  std::span<const PlacedImage> images;
};

struct PackedMaterials {
  std::vector<layout::MaterialRecord> records;
  /// The textures that records refer to, numbered from 1.
  std::vector<layout::TextureSlotRecord> slots;
  /// Rare properties of materials, numbered likewise.
  std::vector<layout::ExtensionRecord> extensions;
  /// Materials that transmit light, numbered likewise.
  std::vector<layout::GlassRecord> glasses;
};
PackedMaterials pack_materials(std::span<const Material> materials, const TextureTables& tables = {});

/// The lights that are on.
struct PackedLights {
  std::vector<layout::LightRecord> records;
  /// The index in Scene::lights of each record's light.
  std::vector<uint32_t> numbers;
};
PackedLights pack_lights(std::span<const Light> lights);

}  // namespace promin
