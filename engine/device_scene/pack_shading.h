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

// Packs the data for shading, except primitives, into the layout of shaders/shared/layout.h. Each kind of data has its
// own function, because each kind changes separately.
namespace promin {

/// Tables to which the records of materials refer.
struct TextureTables {
  std::span<const Texture> textures;
  std::span<const PlacedImage> images;
};

struct PackedMaterials {
  std::vector<layout::MaterialRecord> records;
  /// The texture slots, numbered from 1.
  std::vector<layout::TextureSlotRecord> slots;
  /// Rare properties of materials, numbered from 1.
  std::vector<layout::ExtensionRecord> extensions;
  /// The glasses of materials that transmit light, numbered from 1.
  std::vector<layout::GlassRecord> glasses;
};
PackedMaterials pack_materials(std::span<const Material> materials, const TextureTables& tables = {});

/// The lights that are on.
struct PackedLights {
  std::vector<layout::LightRecord> records;
  /// For each record, the index of its light in Scene::lights.
  std::vector<uint32_t> numbers;
};
PackedLights pack_lights(std::span<const Light> lights);

}  // namespace promin
