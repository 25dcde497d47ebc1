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

/// Returns whether lights have the power that Phong's model expects (docs/model.md, "Light").
bool has_phong_alone(std::span<const Material> materials);

/// The lights that are on, and behind them the other sources of Integrator::kDirect.
struct PackedLights {
  std::vector<layout::LightRecord> records;
  /// For each record, the index of its light in Scene::lights, or a constant of ExplainedSource.
  std::vector<uint32_t> numbers;
  uint32_t light_count = 0;
  /// The first source of Integrator::kDirect.
  uint32_t first_direct = 0;
  /// The tables of sources (shaders/shade/emitters.glsl).
  std::vector<glm::uvec4> tables;
};
PackedLights pack_lights(std::span<const Light> lights);

}  // namespace promin
