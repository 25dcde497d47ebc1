// SPDX-FileCopyrightText: The promin developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "layout.h"
#include "promin/lights.h"
#include "promin/scene.h"
#include "textures/pack_images.h"

// What shading needs of a scene beside its primitives, in the layout of shaders/layout.h. Each alone, as they change
// alone.
namespace promin {

/// What textures are, for materials to name.
struct TextureTables {
  std::span<const Texture> textures;
  std::span<const PlacedImage> images;
};

struct PackedMaterials {
  std::vector<layout::MaterialRecord> records;
  /// Of the textures that records name, which number them from 1 on.
  std::vector<layout::TextureSlotRecord> slots;
  /// Of what few materials have, which their records number likewise.
  std::vector<layout::ExtensionRecord> extensions;
  /// Of what lets light through, likewise.
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
